"""The desktop's screen: its panes, and how they follow the terminal's size, the keys and the user's wishes.

┌ editor ───┬ graph ──────┐
│           │             │
├ command ──┼ side ───────┤    side: quantities, problems or help
└ status ───┴─────────────┘
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Label

from desire_tui.commands import BY_ID
from desire_tui.common.key_names import key_name
from desire_tui.desktop.deferred_screen import DeferredScreen
from desire_tui.desktop.layout_rules import SMALLEST, Arrangement, Pane, arrange
from desire_tui.editor.completion_popup import CompletionPopup
from desire_tui.editor.editor_pane import EditorPane
from desire_tui.panes.command_pane import CommandPane
from desire_tui.panes.graph_pane import GraphPane
from desire_tui.panes.help_pane import HelpPane
from desire_tui.panes.side_pane import Side, SidePane
from desire_tui.panes.status_bar import KeyHint, StatusBar

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget

    from desire_tui.panes.command_history import CommandHistory

PANES: tuple[Pane, ...] = ("editor", "command", "graph", "side")
SHOWN_KEYS = {
    "run.start": "run",
    "run.accept": "OK",
    "run.pause": "pause",
    "view.palette": "palette",
    "help.word": "help",
    "view.next_pane": "next pane",
    "view.quantities": "quantities",
    "graph.full": "graph",
    "view.maximize": "zoom",
    "edit.next_problem": "problem",
    "file.save": "save",
    "file.quit": "quit",
}
"""Keys of the status row, the most wanted first, with a word for each."""


class MainScreen(DeferredScreen):
    """All panes."""

    AUTO_FOCUS = "#prompt"
    """What is typed while the desktop still opens is not lost."""

    class Ready(Message):
        """All panes are there."""

    DEFAULT_CSS = """
    MainScreen { layers: base popup cover; }
    MainScreen #desk { height: 1fr; }
    MainScreen #left { width: 1fr; }
    MainScreen #right { width: 1fr; }
    MainScreen #editor { height: 2fr; }
    MainScreen #command { height: 1fr; min-height: 4; border-top: solid $secondary;
            border-title-color: $foreground; }
    MainScreen #command:focus-within { border-top: solid $primary; border-title-color: $accent; }
    MainScreen #graph { height: 2fr; border-left: solid $secondary; }
    MainScreen #side { height: 1fr; min-height: 6; border-left: solid $secondary; }
    MainScreen.-low #side { height: 2fr; }

    MainScreen.-rows #desk { layout: vertical; }
    MainScreen.-rows #left, MainScreen.-rows #right { width: 100%; height: 1fr; }
    MainScreen.-rows #graph { border-left: none; border-top: solid $secondary; }
    MainScreen.-rows #graph:focus { border-top: solid $primary; }
    MainScreen.-rows #side { border-left: none; }
    MainScreen.-few #left { dock: bottom; height: 34%; min-height: 4; }
    MainScreen.-few #graph, MainScreen.-few #graph:focus { border-top: none; }
    MainScreen.-one #graph, MainScreen.-one #side { border-left: none; min-height: 1; }
    MainScreen.-one #command, MainScreen.-one #command:focus-within { border-top: none; min-height: 1; }

    MainScreen #too-small { layer: cover; width: 100%; height: 100%; display: none;
                      content-align: center middle;
                      background: $background; overflow: hidden; }
    MainScreen.-small #too-small { display: block; }
    """

    def __init__(self, history: CommandHistory, keys: dict[str, str]) -> None:
        super().__init__()
        self._history = history
        self._keys = keys
        self._alone: Pane | None = None
        self._side: bool | None = None
        self._with_keys: Pane = "command"
        self._now: Arrangement | None = None

    def compose(self) -> ComposeResult:
        """Lay out the panes."""
        with Horizontal(id="desk"):
            with Vertical(id="left"):
                yield EditorPane()
                yield CommandPane(self._history)
            with Vertical(id="right"):
                yield GraphPane()
                yield SidePane()
        yield StatusBar(
            [KeyHint(self._key(command), title, command) for command, title in SHOWN_KEYS.items()]
        )
        yield CompletionPopup()
        yield Label(f"at least {SMALLEST[0]} × {SMALLEST[1]} characters, please", id="too-small")

    def _key(self, command_id: str) -> str:
        keys = self._keys.get(command_id) or BY_ID[command_id].keys
        return key_name(keys.split(",")[0]).replace("Ctrl+", "^")

    def on_mount(self) -> None:
        """Give the help pane the configured keys; all panes are there now."""
        self.query_one(HelpPane).keys = self._keys
        self.follow_size()
        self.post_message(self.Ready())

    # -------------------------------------------------------------------------------------- arrangement

    def on_resize(self) -> None:
        """Follow the terminal's size."""
        self.follow_size()

    def on_descendant_focus(self) -> None:
        """Where there is room for one pane only, show the one that has the keys."""
        self._with_keys = self.pane_of(self.focused)
        self.follow_size()

    def follow_size(self) -> None:
        """Show the panes that belong on the screen now."""
        width, height = self.app.size
        now = arrange(width, height, keys=self._with_keys, alone=self._alone, side=self._side)
        self.set_class(height < 28, "-low")
        if now == self._now:
            return
        self._now = now
        self.set_class(now.too_small, "-small")
        self.set_class(now.order == "rows", "-rows")
        self.set_class(now.order == "one", "-one")
        self.set_class(now.order == "rows" and "editor" not in now.panes, "-few")
        for name in PANES:
            self.query_one(f"#{name}").display = name in now.panes
        for column in ("#left", "#right"):
            self.query_one(column).display = any(pane.display for pane in self.query_one(column).children)

    @property
    def shown(self) -> frozenset[Pane]:
        """The panes that are on the screen."""
        return self._now.panes if self._now is not None else frozenset()

    def pane_of(self, widget: Widget | None) -> Pane:
        """Return the pane a widget belongs to; for none, the one that had the keys last."""
        inside = {ancestor.id for ancestor in widget.ancestors_with_self} if widget is not None else set()
        return next((name for name in PANES if name in inside), self._with_keys)

    def make_way(self, widget: Widget) -> None:
        """See to it that a widget that gets the keys can be seen."""
        self._with_keys = self.pane_of(widget)
        if self._alone is not None:
            self._alone = self._with_keys
        self.follow_size()

    # -------------------------------------------------------------------------------------------- side pane

    @property
    def side(self) -> Side | None:
        """Which page of the side pane is shown."""
        return self.query_one(SidePane).current if "side" in self.shown else None

    def open_side(self, name: Side) -> None:
        """Show a page of the side pane."""
        self.query_one(SidePane).choose(name)
        self._side, self._with_keys = True, "side"
        if self._alone is not None:
            self._alone = None
        self.follow_size()

    def close_side(self) -> bool:
        """Hide the side pane; returns whether it had the keys."""
        had_keys = self._with_keys == "side"
        self._side = False
        if had_keys:
            self._with_keys = "command"
        if self._alone == "side":
            self._alone = None
        self.follow_size()
        return had_keys

    # --------------------------------------------------------------------------------------------- maximize

    @property
    def alone(self) -> Pane | None:
        """The pane that was maximized."""
        return self._alone

    def show_alone(self, pane: Pane | None) -> None:
        """Show one pane alone; None: all panes."""
        self._alone = pane
        self.follow_size()
