"""The graph pane: draws the newest graph while its runs go on; zoom, pan, read-out, pages."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, ClassVar

from rich.style import Style
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.geometry import Region
from textual.message import Message

from desire_tui.panes.graph_fit import CurveFit
from desire_tui.panes.graph_key_row import KeyRow, KeyRowContent
from desire_tui.panes.graph_paging import GraphPaging
from desire_tui.panes.graph_readout import Readout
from desire_tui.panes.graph_sheet import TILE_COLUMNS, GraphSheet, SheetStyles
from desire_tui.panes.graph_styles import WHITE_STYLE, net_style
from desire_tui.panes.graph_tiles import SheetTile
from desire_tui.panes.mouse_gestures import MouseGestures
from desire_tui.panes.reading_table import ReadingTable
from desire_tui.panes.sliders import Sliders
from desire_tui.panes.zoom_window import Window

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from textual.app import ComposeResult

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.incremental_drawing import Painter
    from desire_tui.engine.outputs.text_frame import TextFrame
    from desire_tui.panes.graph_cursor import Reading

NOTICE_COLUMNS_MIN = 30


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
        super().__init__(id="graph")
        self._pages = pages
        """All graphs of the session."""
        self.paging = GraphPaging()
        self.canvas: Canvas | None = None
        self.frame: TextFrame | None = None
        self.window = Window()
        """What is to be shown at least: `view` is larger where the axes have equal scales."""
        self.view = Window()
        self.fit = CurveFit()
        self._marks: tuple[object, ...] = ()
        self._failed = ""
        """What is said in place of a graph after a start that failed."""
        self._is_earlier = False
        """Whether the page is of a run before a start that failed."""
        self.keys_shown = True
        self.readout = Readout()
        self.sliders = Sliders()
        self._below = Vertical(id="below")
        self._painter: Painter | None = None
        self._drawn: tuple[object, ...] = ()
        self.sheet = GraphSheet()
        self._keys: tuple[object, ...] = ()
        self._tiles: list[SheetTile] = []
        self._ground: tuple[tuple[str, bool], tuple[Style, bool]] | None = None

    class TurnRequested(Message):
        """Another graph is to be shown: the older (-1) or newer (1) one."""

        def __init__(self, step: int) -> None:
            super().__init__()
            self.step = step

    def compose(self) -> ComposeResult:
        """Tiles for half of the screen, which is what the graph mostly has; more come with the size."""
        self._tiles = [
            SheetTile(self.sheet, number) for number in range(self.app.size.width // 2 // TILE_COLUMNS + 1)
        ]
        self.sheet.ground = self.paper[0]
        yield from self._tiles
        with self._below:
            yield ReadingTable(self._key_row_content)
            yield KeyRow(self._key_row_content)
            yield self.sliders

    # ---------------------------------------------------------------------------------------------- drawing

    @property
    def page(self) -> Graph | None:
        """The graph that is shown."""
        return self.paging.page

    @property
    def is_white(self) -> bool:
        """Whether the paper is white: the program asks for it, or the theme is light."""
        return (self.page is not None and self.page.white) or not self.app.current_theme.dark

    @property
    def paper(self) -> tuple[Style, bool]:
        """Colours of paper and ink, and whether the paper is white; kept while page and theme stay."""
        key = (self.app.theme, self.page is not None and self.page.white)
        if self._ground is None or self._ground[0] != key:
            white = self.is_white
            self._ground = (key, (WHITE_STYLE if white else self.rich_style, white))
        return self._ground[1]

    def _key_row_content(self) -> KeyRowContent:
        keys = self.page.keys if self.page is not None and self.keys_shown else ()
        readout = self.readout
        color = readout.picked.color if readout.picked is not None else 0
        return KeyRowContent(*self.paper, keys, readout.reading, readout.told, color)

    @property
    def reading(self) -> Reading | None:
        """What the cursor reads."""
        return self.readout.reading

    @property
    def room(self) -> tuple[int, int]:
        """Columns and rows for frame and curves."""
        return self.size.width, max(self.size.height - max(self._below.size.height, 1), 1)

    @property
    def page_mark(self) -> str:
        """Which page is shown, if it is not the newest, and whether it is magnified."""
        zoomed = not self.fit.is_on and not self.window.is_whole
        earlier = "earlier run" if self._is_earlier else ""
        marks = [self.paging.place(self._pages()) or earlier, "zoom" if zoomed else ""]
        told = " · ".join(mark for mark in marks if mark)
        return f" {told} " if told else ""

    @property
    def cursor_column(self) -> int | None:
        """Column of the canvas where the cursor line stands."""
        if self.reading is None or self.canvas is None or not 0.0 <= self.reading.x <= 1.0:
            return None
        return min(int(self.reading.x * self.canvas.columns), self.canvas.columns - 1)

    def follow_newest(self, graph: Graph | None) -> None:
        """Show a graph that was just begun; the window stays if the same variables are drawn again."""
        if graph is None:
            return
        self._is_earlier = False
        if graph is self.page:
            if self.paging.behind:
                self._drawn = ()
            self._show_keys()
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

    def tick(self) -> bool:
        """Draw what is new; returns whether anything was.

        Called as often as frames are wanted; costs nothing when nothing changed.
        """
        if not self.size.width or not self.is_on_screen:
            return False
        self.window = self.fit.window(self.paging, self.window)
        state = self._state()
        begins = state != self._drawn
        if begins:
            self._begin_page(state)
        if self._painter is None or self.canvas is None or self.frame is None:
            return begins
        self._painter.update()
        dirty, top = self.canvas.take_dirty(), self.frame.top
        self._refresh_cells((row + top, tile) for row, tile in dirty)
        if self._marks != (marks := self._marks_now()):
            self._marks = marks
            self._refresh_cells(self._lay())
        if self.readout.cursor is not None or self.readout.picked is not None:
            self._read()
        return begins or bool(dirty)

    def _marks_now(self) -> tuple[object, ...]:
        painter = self._painter
        if painter is None or not self.window.is_whole:
            return ()
        return (*painter.clipped.counts(), self.fit.notice)

    def _state(self) -> tuple[object, ...]:
        page = self.page
        if page is None:
            return self.paper, self.room, self._failed
        under = tuple((graph, len(graph.curves)) for graph in self.paging.behind)
        curves = len(page.curves) if under else 0
        title = page.title(fitted=self.fit.is_on)
        look = (
            page.frame,
            title,
            self._is_earlier,
            page.label,
            page.net,
            page.axes,
            self.paper,
            self.window,
            self.room,
        )
        return page, look, under, curves

    def _begin_page(self, state: tuple[object, ...]) -> None:
        self._drawn = state
        ground, white = self.paper
        columns, rows = self.room
        page = self.page
        if page is None:
            notice = self._failed or "No graph yet · F5 runs the program"
            notice = notice if columns > max(NOTICE_COLUMNS_MIN, len(notice)) else notice[:columns]
            lines = [""] * (rows // 2) + [notice.center(columns)]
            self.sheet.lay(columns, rows, SheetStyles(ground, ground + Style(dim=True), ground, white), lines)
            self._refresh_cells(self.sheet.cells)
            return
        from desire_tui.engine.outputs.braille_canvas import Canvas
        from desire_tui.engine.outputs.incremental_drawing import Painter
        from desire_tui.engine.outputs.text_frame import equal_view, text_frame

        before, canvas = self.frame, self.canvas
        mark = self.page_mark
        self.view = Window(*equal_view(page, columns, rows, self.window, reserved=len(mark)))
        frame = self.frame = text_frame(
            page, columns, rows, self.view, fitted=self.fit.is_on, reserved=len(mark)
        )
        place = (frame.left, frame.columns, frame.rows)
        if before is None or canvas is None or place != (before.left, before.columns, before.rows):
            canvas = self.canvas = Canvas(max(frame.columns, 1), max(frame.rows, 1), frame.left)
        self._show_keys()
        self._painter = Painter(canvas, self.paging.with_all_under(page), self.view)
        self._painter.update()  # first: a piece is sent with what stands in it
        canvas.take_dirty()
        self._marks = self._marks_now()
        self._lay()
        self.mark_cells()

    def _lay(self) -> list[tuple[int, int]]:
        """Give the sheet the frame's lines, with what is written into them; return the cells that changed."""
        page, frame, painter = self.page, self.frame, self._painter
        if page is None or frame is None or painter is None:
            return []
        ground, white = self.paper
        columns, rows = self.room
        lines = list(painter.clipped.lines(frame, self.fit.notice) if self._marks else frame.lines)
        mark = self.page_mark
        lines[0] = lines[0][: columns - len(mark)].ljust(columns - len(mark)) + mark
        net = ground if page.net is None else ground + net_style(page.net, white=white)
        look = SheetStyles(ground, ground + Style(bold=True), net, white)
        return self.sheet.lay(columns, rows, look, lines, frame, self.canvas)

    def _show_keys(self) -> None:
        """Have the colour keys drawn if they are others than before."""
        keys = (self.page.keys if self.page is not None else (), self.paper)
        if keys != self._keys:
            self._keys = keys
            self.query_one(KeyRow).refresh()

    def on_resize(self) -> None:
        """Follow the pane's size."""
        wanted = -(-self.size.width // TILE_COLUMNS)
        if wanted > len(self._tiles):
            new = [SheetTile(self.sheet, number) for number in range(len(self._tiles), wanted)]
            self._tiles += new
            self.mount(*new)
        self.tick()

    def _refresh_cells(self, cells: Iterable[tuple[int, int]]) -> None:
        """Have those cells (row, tile) sent that look different from before."""
        changed = sorted((tile, row) for row, tile in self.sheet.changed(cells))
        for number, of_tile in groupby(changed, key=lambda cell: cell[0]):
            if number >= len(self._tiles):
                continue
            rows = [row for _, row in of_tile]
            regions, first = [], rows[0]
            for row, following in zip(rows, [*rows[1:], -1], strict=True):
                if following != row + 1:
                    regions.append(Region(0, first, TILE_COLUMNS, row - first + 1))
                    first = following
            self._tiles[number].refresh(*regions)

    def mark_cells(self) -> None:
        """Have the cursor line and the rectangle being marked drawn."""
        frame, column = self.frame, self.cursor_column
        if frame is None:
            return
        colour = Style(color="#000000" if self.is_white else "#ffffff", bold=True)
        self.sheet.cursor = (frame.left + column, colour) if column is not None else None
        self.sheet.box = self.rubber.translate((frame.left, frame.top)) if self.rubber is not None else None
        self._refresh_cells(self.sheet.cells)

    # ------------------------------------------------------------------------------------------- the window

    def zoom(self, factor: float, x: float = 0.5, y: float = 0.5) -> None:
        """Make the window `factor` times as large, around a point given in parts of it."""
        self.look_at(self.view.zoomed(factor, x, y))

    def pan(self, x: float, y: float) -> None:
        """Move the window by parts of itself."""
        self.look_at(self.view.panned(x, y))

    def change_axes(self, word: str) -> None:
        """Lay the values out in another way (`display` words)."""
        if self.page is not None and self.page.frame.kind != "picture":
            self.page.set_axes(self.page.axes.changed(word))
            self.window, self.fit.wanted = Window(), None
            self.tick()

    def reset_window(self) -> None:
        """Back to the program's scale; the cursor goes."""
        self.readout.clear()
        self.look_at(Window())
        self._show_reading()

    def look_at(self, window: Window) -> None:
        """Show another part of the page; a picture has no parts."""
        if self.page is not None and self.page.frame.kind != "picture":
            self.window, self.fit.wanted = window, False
            self.tick()

    def fit_curves(self) -> None:
        """Show the window that holds all curves, and follow them while they grow."""
        self.fit.wanted = True
        self.tick()

    # ---------------------------------------------------------------------------------------------- read-out

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
