"""The desktop's screen: its panes, and how they follow the terminal's size, the focus and the user's wishes.

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

from desire_tui.common.frame_top import FrameTop
from desire_tui.desktop.deferred_screen import DeferredScreen
from desire_tui.desktop.key_hints import key_hints
from desire_tui.desktop.layout_rules import SMALLEST, Arrangement, Pane, arrange
from desire_tui.desktop.splits import Splits
from desire_tui.editor.editor_pane import EditorPane
from desire_tui.panes.command_pane import CommandPane
from desire_tui.panes.graph_pane import GraphPane
from desire_tui.panes.side_pane import Side, SidePane
from desire_tui.panes.status_bar import StatusBar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from textual import events
    from textual.app import ComposeResult
    from textual.widget import Widget

    from desire_tui.desktop.completer import Completer
    from desire_tui.engine.graph.model import Graph
    from desire_tui.panes.command_history import CommandHistory

LOW_BELOW = 28
"""Rows below which the side pane gets more of them."""
PANES: tuple[Pane, ...] = ("editor", "command", "graph", "side")


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
    MainScreen #command { height: 1fr; min-height: 4; border-top: solid $frame;
            border-title-color: $foreground; }
    MainScreen #command:focus-within { border-top: solid $primary; border-title-color: $accent;
            border-title-style: bold; }
    MainScreen #graph { height: 2fr; border-left: solid $frame; border-title-color: $foreground; }
    MainScreen #graph:focus { border-title-color: $accent; border-title-style: bold; }
    MainScreen #side { height: 1fr; min-height: 6; border-left: solid $frame; }
    MainScreen #editor, MainScreen #command { background: $surface; }
    MainScreen.-low #side { height: 2fr; }

    MainScreen.-rows #desk { layout: vertical; }
    MainScreen.-rows #left, MainScreen.-rows #right { width: 100%; height: 1fr; }
    MainScreen.-rows #graph { border-left: none; border-top: solid $frame; }
    MainScreen.-rows #graph:focus { border-top: solid $primary; }
    MainScreen.-rows #side { border-left: none; }
    MainScreen.-few #left { dock: bottom; height: 34%; min-height: 4; }
    MainScreen.-few #graph, MainScreen.-few #graph:focus { border-top: none; }
    MainScreen.-one #graph, MainScreen.-one #side { border-left: none; min-height: 1; }
    MainScreen.-one #command, MainScreen.-one #command:focus-within { border-top: none; min-height: 1; }

    MainScreen.-framed #command, MainScreen.-framed #graph { border: round $frame; }
    MainScreen.-framed #command:focus-within, MainScreen.-framed #graph:focus { border: round $primary; }
    MainScreen.-framed #editor-body, MainScreen.-framed #side-body { border: round $frame; border-top: none; }
    MainScreen.-framed #editor:focus-within #editor-body, MainScreen.-framed #side:focus-within #side-body {
            border: round $primary; border-top: none; }
    MainScreen.-framed #side { border-left: none; }

    MainScreen #too-small { layer: cover; width: 100%; height: 100%; display: none;
                      content-align: center middle;
                      background: $background; overflow: hidden; }
    MainScreen.-small #too-small { display: block; }
    """

    def __init__(
        self,
        history: CommandHistory,
        keys: dict[str, str],
        completer: Completer,
        graphs: Callable[[], list[Graph]],
    ) -> None:
        super().__init__()
        self._completer = completer
        self.editor = EditorPane(completer)
        self.command = CommandPane(history, completer)
        self.graph = GraphPane(graphs)
        self.graph.border_title = "Graph"
        self.side_pane = SidePane(keys)
        self.status_bar = StatusBar(key_hints(keys))
        self._only_pane: Pane | None = None
        self._side: bool | None = None
        self._focused_pane: Pane = "command"
        self._arrangement: Arrangement | None = None
        self.splits = Splits(self)

    def compose(self) -> ComposeResult:
        """Lay out the panes."""
        for name in self._changed_classes(self._wanted()):  # before there are widgets whose styles it changes
            self.add_class(name, update=False)
        with Horizontal(id="desk"):
            with Vertical(id="left"):
                yield self.editor
                yield self.command
            with Vertical(id="right"):
                yield self.graph
                yield self.side_pane
        yield self.status_bar
        yield self._completer.popup
        yield Label(f"at least {SMALLEST[0]} × {SMALLEST[1]} characters, please", id="too-small")

    def on_mount(self) -> None:
        """All panes are there now."""
        self.update_layout()
        self.post_message(self.Ready())

    def _forward_event(self, event: events.Event) -> None:
        """Pass an event on to the widget it is for; lines between panes are dragged here."""
        if not self.splits.takes(event):
            super()._forward_event(event)

    # -------------------------------------------------------------------------------------- arrangement

    def on_resize(self) -> None:
        """Follow the terminal's size."""
        self.update_layout()

    def on_descendant_focus(self) -> None:
        """Where there is room for one pane only, show the one that has the focus."""
        self._focused_pane = self.pane_of(self.focused)
        for top in self._frame_tops():
            top.lit = top in self.query_one(f"#{self._focused_pane}").children
        self.update_layout()

    def update_layout(self) -> None:
        """Show the panes that belong on the screen now."""
        now = self._wanted()
        if changed := self._changed_classes(now):
            self.toggle_class(*changed)  # at once: each change looks for the styles of every widget
        if now == self._arrangement:
            return
        self._arrangement = now
        for top in self._frame_tops():
            top.framed = now.framed
        for name in PANES:
            self.query_one(f"#{name}").display = name in now.panes
        for column in ("#left", "#right"):
            self.query_one(column).display = any(pane.display for pane in self.query_one(column).children)
        self.splits.lay(now.column_split)

    def _wanted(self) -> Arrangement:
        width, height = self.app.size
        return arrange(width, height, focused=self._focused_pane, maximized=self._only_pane, side=self._side)

    def _changed_classes(self, now: Arrangement) -> list[str]:
        """Return the classes that an arrangement has and the screen has not, or no more."""
        wanted = {
            "-low": self.app.size.height < LOW_BELOW, "-small": now.too_small, "-rows": now.order == "rows",
            "-one": now.order == "one", "-framed": now.framed,
            "-few": now.order == "rows" and "editor" not in now.panes,
        }  # fmt: skip
        return [name for name, has in wanted.items() if has != self.has_class(name)]

    def _frame_tops(self) -> Iterable[FrameTop]:
        return self.query("TabStrip, SideTabs").results(FrameTop)

    @property
    def shown(self) -> frozenset[Pane]:
        """The panes that are on the screen."""
        return self._arrangement.panes if self._arrangement is not None else frozenset()

    def pane_of(self, widget: Widget | None) -> Pane:
        """Return the pane a widget belongs to; for none, the one that had the focus last."""
        inside = {ancestor.id for ancestor in widget.ancestors_with_self} if widget is not None else set()
        return next((name for name in PANES if name in inside), self._focused_pane)

    def make_visible(self, widget: Widget) -> None:
        """Make sure that a widget that gets the focus can be seen."""
        self._focused_pane = self.pane_of(widget)
        if self._only_pane is not None:
            self._only_pane = self._focused_pane
        self.update_layout()

    # -------------------------------------------------------------------------------------------- side pane

    @property
    def side(self) -> Side | None:
        """Which page of the side pane is shown."""
        return self.side_pane.current if "side" in self.shown else None

    def open_side(self, name: Side) -> None:
        """Show a page of the side pane."""
        self.side_pane.choose(name)
        self._side, self._focused_pane = True, "side"
        if self._only_pane is not None:
            self._only_pane = None
        self.update_layout()

    def close_side(self) -> bool:
        """Hide the side pane; returns whether it had the focus."""
        had_keys = self._focused_pane == "side"
        self._side = False
        if had_keys:
            self._focused_pane = "command"
        if self._only_pane == "side":
            self._only_pane = None
        self.update_layout()
        return had_keys

    # --------------------------------------------------------------------------------------------- maximize

    @property
    def only_pane(self) -> Pane | None:
        """The pane that was maximized."""
        return self._only_pane

    def show_only(self, pane: Pane | None) -> None:
        """Show one pane alone; None: all panes."""
        self._only_pane = pane
        self.update_layout()
