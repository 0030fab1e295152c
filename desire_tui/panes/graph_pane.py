"""The graph pane: the newest graph, drawn while its runs go on; keys, read-out, pages."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.message import Message

from desire_tui.panes.graph_key_row import KeyRow, KeyRowContent
from desire_tui.panes.graph_readout import Readout
from desire_tui.panes.mouse_gestures import MouseGestures
from desire_tui.panes.reading_table import ReadingTable
from desire_tui.panes.sliders import Sliders
from desire_tui.panes.work_row import WorkRow
from desire_tui.panes.zoom_window import Window

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.app import ComposeResult

    from desire_tui.engine.graph.model import Graph
    from desire_tui.panes.graph_cursor import Reading


class GraphPane(MouseGestures, can_focus=True):
    """Shows one page of the session's graphs."""

    DEFAULT_CSS = """
    GraphPane { layout: horizontal; overflow: hidden; background: #0b0d11; color: #b8bec9; }
    GraphPane:light { background: #ffffff; color: #202020; }
    GraphPane:focus { border-left: solid $primary; }
    GraphPane #below { dock: bottom; height: auto; width: 100%; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("plus,equals_sign", "app.do('graph.zoom_in')", show=False),
        Binding("minus", "app.do('graph.zoom_out')", show=False),
        Binding("a", "app.do('graph.fit')", show=False),
        Binding("l", "app.do('graph.log')", show=False),
        Binding("e", "app.do('graph.equal')", show=False),
        Binding("0,escape", "app.do('graph.reset')", show=False),
        Binding("r", "app.do('graph.read')", show=False),
        Binding("k", "app.do('graph.legend')", show=False),
        Binding("s", "app.do('graph.snapshot')", show=False),
        Binding("o", "app.do('graph.overlay')", show=False),
        Binding("p", "app.do('graph.picture')", show=False),
        Binding("f", "app.do('graph.full')", show=False),
        Binding("pageup", "page(-1)", show=False),
        Binding("pagedown", "page(1)", show=False),
        Binding("left", "arrow(-1, 0)", show=False),
        Binding("right", "arrow(1, 0)", show=False),
        Binding("up", "arrow(0, 1)", show=False),
        Binding("down", "arrow(0, -1)", show=False),
        Binding("shift+left", "arrow(-10, 0)", show=False),
        Binding("shift+right", "arrow(10, 0)", show=False),
    ]

    def __init__(self, pages: Callable[[], list[Graph]]) -> None:
        super().__init__(pages, id="graph")
        self.keys_shown = True
        self.readout = Readout()
        self.sliders = Sliders()
        self.work_row = WorkRow()
        self._keys: tuple[object, ...] = ()

    class TurnRequested(Message):
        """Another graph is to be shown: the older (-1) or newer (1) one."""

        def __init__(self, step: int) -> None:
            super().__init__()
            self.step = step

    def compose(self) -> ComposeResult:
        """Tiles for half of the screen, which is what the graph mostly has; more come with the size."""
        self.sheet.ground = self.paper[0]
        yield from self._tiles.grow(self.app.size.width // 2 + 1)
        with self._below:
            yield ReadingTable(self._key_row_content)
            yield KeyRow(self._key_row_content)
            yield self.sliders
            yield self.work_row

    def _key_row_content(self) -> KeyRowContent:
        keys = self.paging.keys if self.keys_shown else ()
        readout = self.readout
        color = readout.picked.color if readout.picked is not None else 0
        return KeyRowContent(*self.paper, keys, readout.reading, readout.told, color)

    @property
    def reading(self) -> Reading | None:
        """What the cursor reads."""
        return self.readout.reading

    def follow_newest(self, graph: Graph | None) -> None:
        """Show a graph that was just begun; the window stays if the same variables are drawn again."""
        if graph is None:
            return
        self._is_earlier = False
        if graph is self.page:
            if self.paging.behind:
                self._drawn = ()
            self.show_keys()
        elif self.paging.follow(graph):
            self.window, self.fit.wanted = Window(), None

    def show_failed(self, program: str) -> None:
        """Say that a program made no graph: another program's leaves the screen, its own is marked."""
        page = self.page
        if page is not None and page.program == program:
            self._is_earlier = True
        else:
            older = " · Alt+PgUp: graph before" if page is not None else ""
            self._failed = f"{program} made no graph{older}"
            self.paging.show_none()
        self.tick()

    def show_keys(self) -> None:
        """Have the colour keys drawn if they are others than before."""
        keys = (self.paging.keys, self.paper)
        if keys != self._keys:
            self._keys = keys
            self.query_one(KeyRow).refresh()

    # ---------------------------------------------------------------------------------------------- read-out

    @property
    def cursor_column(self) -> int | None:
        """Column of the canvas where the cursor line stands."""
        if self.reading is None or self.canvas is None or not 0.0 <= self.reading.x <= 1.0:
            return None
        return min(int(self.reading.x * self.canvas.columns), self.canvas.columns - 1)

    def toggle_readout(self) -> bool:
        """Show or hide the cursor; returns whether it is shown."""
        readout = self.readout
        if readout.cursor is None:
            readout.cursor = 0.5
        else:
            readout.clear()
        readout.read(self.page, self.window)
        self._show_reading()
        return readout.cursor is not None

    def action_arrow(self, x: int, y: int) -> None:
        """Move the cursor if it is shown, or to another curve; else move the window."""
        if self.readout.cursor is None or self.page is None:
            self.pan(0.05 * x, 0.1 * y)
        elif x:
            columns = self.canvas.columns if self.canvas is not None else 100
            self.set_cursor(min(max(self.readout.cursor + x / (2 * columns), 0.0), 1.0))
        else:
            self.readout.step(self.page, -y)
            self._read()

    def action_page(self, step: int) -> None:
        """Turn the pages of the read-out, or of the graphs where it has none."""
        table = self.query_one(ReadingTable)
        if table.display:
            table.turn(step)
        else:
            self.post_message(self.TurnRequested(step))

    def read_again(self) -> None:
        """Bring the read-out up to date with what was just drawn."""
        if self.readout.cursor is not None or self.readout.picked is not None:
            self._read()

    def _read(self) -> None:
        if self.readout.read(self.page, self.view) or self._picked_changed():
            self._show_reading()

    def _picked_changed(self) -> bool:
        changed = self.readout.draw(self.page, self.view, self.canvas)
        self.sheet.above = self.readout.above
        return changed

    def _show_reading(self) -> None:
        """Show the read-out as it is: below the graph, and in it cursor line and picked curve."""
        self._picked_changed()
        table = self.query_one(ReadingTable)
        table.fit((self.size.height - 1) // 3)
        table.show_picked(self.readout.number(self.page))
        self.query_one(KeyRow).refresh()
        self.mark_cells()

    def set_cursor(self, x: float) -> None:
        """Move the cursor, if it is shown, to x (part of the window)."""
        if self.readout.cursor is not None:
            self.readout.cursor = x
            self._read()

    def hover(self, x: float, y: float) -> None:
        """Pick the curve at a place of the window."""
        canvas = self.canvas
        if canvas is not None and self.readout.hover(
            self.page, self.view, (x, y), (canvas.columns, canvas.rows)
        ):
            self._show_reading()

    def on_leave(self) -> None:
        """Forget the curve under the mouse, unless that has only come to another tile."""
        over = self.app.mouse_over
        if (over is None or self not in over.ancestors_with_self) and self.readout.leave():
            self._show_reading()

    def reset_window(self) -> None:
        """Back to the program's scale; the cursor goes."""
        self.readout.clear()
        self.look_at(Window())
        self._show_reading()

    @on(Sliders.Left)
    def _sliders_left(self, event: Sliders.Left) -> None:
        event.stop()
        self.focus()

    def toggle_keys(self) -> None:
        """Show or hide the colour keys."""
        self.keys_shown = not self.keys_shown
        self.query_one(KeyRow).refresh()

    # ------------------------------------------------------------------------------------------------- pages

    def turn(self, step: int) -> bool:
        """Show an older (-1) or newer (1) page; False if there is none."""
        if not self.paging.turn(self._pages(), step):
            return False
        self.window, self.fit.wanted = Window(), None
        self.tick()
        return True

    def overlay(self, number: int | None) -> bool:
        """Lay a page under the one shown (`GraphPaging.lay_under`); False if there is none."""
        done = self.paging.lay_under(self._pages(), number)
        self.tick()
        return done
