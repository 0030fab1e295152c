"""The desktop's screen: which panes there are, where they stand, which are shown.

┌ editor ───┬ graph ──────┐
│           │             │
├ command ──┼ side ───────┤    side: quantities, problems or help
└ status ───┴─────────────┘
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.screen import Screen
from textual.widgets import ContentSwitcher, Label

from desire_tui.commands import BY_ID
from desire_tui.editor.pane import EditorPane
from desire_tui.editor.popup import CompletionPopup
from desire_tui.panes.command import CommandPane
from desire_tui.panes.graph import GraphPane
from desire_tui.panes.help import HelpPane
from desire_tui.panes.keynames import key_name
from desire_tui.panes.problems import ProblemsPane
from desire_tui.panes.quantities import QuantitiesPane
from desire_tui.panes.status import StatusBar

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget

    from desire_tui.panes.history import History

Side = Literal["quantities", "problems", "help"]
SMALLEST = (40, 10)
NARROW_BELOW, LOW_BELOW = 100, 28
SHOWN_KEYS = {
    "run.start": "run",
    "run.accept": "OK",
    "run.pause": "pause",
    "view.palette": "palette",
    "help.word": "help",
    "view.next_pane": "next pane",
    "view.maximize": "zoom",
    "graph.full": "graph",
    "edit.next_problem": "problem",
    "file.save": "save",
    "file.quit": "quit",
}
"""Keys of the status row, the most wanted first, with a word for each."""


class Desk(Screen[None]):
    """All panes."""

    AUTO_FOCUS = "#prompt"
    """What is typed while the desktop still opens is not lost."""

    class Ready(Message):
        """All panes are there."""

    DEFAULT_CSS = """
    Desk { layers: base popup cover; }
    Desk #desk { height: 1fr; }
    Desk #left { width: 1fr; }
    Desk #right { width: 1fr; }
    Desk #editor { height: 2fr; }
    Desk #command { height: 1fr; min-height: 4; border-top: solid $secondary;
            border-title-color: $foreground 70%; }
    Desk #command:focus-within { border-top: solid $primary; border-title-color: $accent; }
    Desk #graph { height: 2fr; border-left: solid $secondary; }
    Desk #side { height: 1fr; min-height: 6; display: none; border-top: solid $secondary;
            border-left: solid $secondary;
                 border-title-color: $foreground 70%; background: $surface; }
    Desk #side:focus-within { border-top: solid $primary; border-title-color: $accent; }
    Desk #side.-shown { display: block; }
    Desk.-narrow #side.-shown { height: 2fr; }
    Desk #too-small { layer: cover; width: 100%; height: 100%; display: none; content-align: center middle;
                      background: $background; }
    Desk.-small #too-small { display: block; }
    """

    def __init__(self, history: History, keys: dict[str, str]) -> None:
        super().__init__()
        self._history = history
        self._keys = keys
        self._alone: Widget | None = None

    def compose(self) -> ComposeResult:
        """Lay out the panes."""
        with Horizontal(id="desk"):
            with Vertical(id="left"):
                yield EditorPane()
                yield CommandPane(self._history)
            with Vertical(id="right"):
                yield GraphPane()
                with ContentSwitcher(id="side", initial="problems"):
                    yield QuantitiesPane()
                    yield ProblemsPane()
                    yield HelpPane()
        yield StatusBar([(self._key(command), title) for command, title in SHOWN_KEYS.items()])
        yield CompletionPopup()
        yield Label(
            f"Desire needs a terminal of at least\n{SMALLEST[0]} × {SMALLEST[1]} characters.", id="too-small"
        )

    def _key(self, command_id: str) -> str:
        keys = self._keys.get(command_id) or BY_ID[command_id].keys
        return key_name(keys.split(",")[0]).replace("Ctrl+", "^")

    def on_mount(self) -> None:
        """Give the help pane the configured keys; all panes are there now."""
        self.query_one(HelpPane).keys = self._keys
        self.post_message(self.Ready())

    def on_resize(self) -> None:
        """Follow the terminal's size."""
        width, height = self.app.size
        self.set_class(width < SMALLEST[0] or height < SMALLEST[1], "-small")
        self.set_class(width < NARROW_BELOW, "-narrow")
        self.set_class(height < LOW_BELOW, "-low")

    # -------------------------------------------------------------------------------------------- side pane

    @property
    def side(self) -> Side | None:
        """Which side pane is shown."""
        switcher = self.query_one("#side", ContentSwitcher)
        return switcher.current if switcher.has_class("-shown") else None  # type: ignore[return-value]

    def open_side(self, name: Side, *, toggle: bool = False) -> bool:
        """Show a side pane; with `toggle`, hide it if it is shown. Returns whether it is shown now."""
        switcher = self.query_one("#side", ContentSwitcher)
        if toggle and self.side == name:
            self.close_side()
            return False
        if self._alone is not None:
            self.show_alone(None)
        switcher.current = name
        switcher.border_title = name.capitalize()
        switcher.add_class("-shown")
        return True

    def close_side(self) -> bool:
        """Hide the side pane; returns whether it had the focus."""
        switcher = self.query_one("#side", ContentSwitcher)
        had_focus = self.focused is not None and switcher in self.focused.ancestors_with_self
        switcher.remove_class("-shown")
        return had_focus

    # --------------------------------------------------------------------------------------------- maximize

    @property
    def alone(self) -> Widget | None:
        """The pane that is shown alone."""
        return self._alone

    def pane_of(self, widget: Widget | None) -> Widget:
        """Return the pane a widget belongs to; the editor for none."""
        panes: list[Widget] = [self.query_one(f"#{name}") for name in ("editor", "command", "graph", "side")]
        inside = widget.ancestors_with_self if widget is not None else []
        return next((pane for pane in panes if pane in inside), panes[0])

    def show_alone(self, pane: Widget | None) -> None:
        """Show one pane alone; None: all panes."""
        self._alone = pane
        left, right = self.query_one("#left"), self.query_one("#right")
        for column in (left, right):
            column.display = pane is None or pane in column.children
            for child in column.children:
                child.display = pane is None or child is pane
        switcher = self.query_one("#side")
        if pane is None:
            switcher.styles.clear_rule("display")
        self.query_one("#graph").set_class(pane is not None, "-alone")
