"""The graph pane: draws the newest graph while its runs go on; zoom, pan, read-out, pages."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, ClassVar

from rich.style import Style
from textual.binding import Binding, BindingType
from textual.geometry import Region

from desire_tui.panes import graph_cursor
from desire_tui.panes.graph_fit import CurveFit
from desire_tui.panes.graph_key_row import KeyRow, KeyRowContent
from desire_tui.panes.graph_paging import GraphPaging
from desire_tui.panes.graph_sheet import TILE_COLUMNS, GraphSheet, SheetStyles
from desire_tui.panes.graph_styles import WHITE_STYLE, net_style
from desire_tui.panes.graph_tiles import SheetTile
from desire_tui.panes.mouse_gestures import MouseGestures
from desire_tui.panes.zoom_window import Window

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from textual.app import ComposeResult

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.incremental_drawing import Painter
    from desire_tui.engine.outputs.text_frame import TextFrame

NOTICE_COLUMNS_MIN = 30


class GraphPane(MouseGestures, can_focus=True):
    """Shows one page of the session's graphs."""

    DEFAULT_CSS = """
    GraphPane { layout: horizontal; overflow: hidden; background: #0b0d11; color: #b8bec9; }
    GraphPane:light { background: #ffffff; color: #202020; }
    GraphPane:focus { border-left: solid $primary; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("plus,equals_sign", "app.do('graph.zoom_in')", show=False),
        Binding("minus", "app.do('graph.zoom_out')", show=False),
        Binding("a", "app.do('graph.fit')", show=False),
        Binding("0,escape", "app.do('graph.reset')", show=False),
        Binding("r", "app.do('graph.read')", show=False),
        Binding("k", "app.do('graph.legend')", show=False),
        Binding("s", "app.do('graph.snapshot')", show=False),
        Binding("o", "app.do('graph.overlay')", show=False),
        Binding("p", "app.do('graph.picture')", show=False),
        Binding("f", "app.do('graph.full')", show=False),
        Binding("pageup", "app.do('graph.older')", show=False),
        Binding("pagedown", "app.do('graph.newer')", show=False),
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
        self.fit = CurveFit()
        self._marks: tuple[object, ...] = ()
        self._failed = ""
        """What is said in place of a graph after a start that failed."""
        self._is_earlier = False
        """Whether the page is of a run before a start that failed."""
        self.keys_shown = True
        self.reading: graph_cursor.Reading | None = None
        self._cursor: float | None = None
        self._painter: Painter | None = None
        self._drawn: tuple[object, ...] = ()
        self.sheet = GraphSheet()
        self._keys: tuple[object, ...] = ()
        self._tiles: list[SheetTile] = []
        self._ground: tuple[tuple[str, bool], tuple[Style, bool]] | None = None

    def compose(self) -> ComposeResult:
        """Tiles for half of the screen, which is what the graph mostly has; more come with the size."""
        self._tiles = [
            SheetTile(self.sheet, number) for number in range(self.app.size.width // 2 // TILE_COLUMNS + 1)
        ]
        self.sheet.ground = self.paper[0]
        yield from self._tiles
        yield KeyRow(self._key_row_content)

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
        return KeyRowContent(*self.paper, keys, self.reading)

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
            if self.paging.under:
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
        if self._cursor is not None:
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
            return self.paper, self.size, self._failed
        under = tuple(len(graph.curves) for graph in self.paging.under)
        curves = len(page.curves) if under else 0
        title = page.title(fitted=self.fit.is_on)
        look = (
            page.frame,
            title,
            self._is_earlier,
            page.label,
            page.net,
            self.paper,
            self.window,
            self.size,
        )
        return page, look, under, curves

    def _begin_page(self, state: tuple[object, ...]) -> None:
        self._drawn = state
        ground, white = self.paper
        columns, rows = self.size.width, max(self.size.height - 1, 1)
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
        from desire_tui.engine.outputs.text_frame import text_frame

        before, canvas = self.frame, self.canvas
        mark = self.page_mark
        frame = self.frame = text_frame(
            page, columns, rows, self.window, fitted=self.fit.is_on, reserved=len(mark)
        )
        place = (frame.left, frame.columns, frame.rows)
        if before is None or canvas is None or place != (before.left, before.columns, before.rows):
            canvas = self.canvas = Canvas(max(frame.columns, 1), max(frame.rows, 1), frame.left)
        self._show_keys()
        self._painter = Painter(canvas, self.paging.with_all_under(page), self.window)
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
        columns, rows = self.size.width, max(self.size.height - 1, 1)
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
        self.look_at(self.window.zoomed(factor, x, y))

    def pan(self, x: float, y: float) -> None:
        """Move the window by parts of itself."""
        self.look_at(self.window.panned(x, y))

    def reset_window(self) -> None:
        """Back to the program's scale; the cursor goes."""
        self._cursor, self.reading = None, None
        self.look_at(Window())
        self.mark_cells()
        self.query_one(KeyRow).refresh()

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
        self._cursor = 0.5 if self._cursor is None else None
        self._read()
        self.mark_cells()
        return self._cursor is not None

    def action_arrow(self, x: int, y: int) -> None:
        """Move the cursor if it is shown, else the window."""
        if self._cursor is None or not x:
            self.pan(0.05 * x, 0.1 * y)
            return
        columns = self.canvas.columns if self.canvas is not None else 100
        self._cursor = min(max(self._cursor + x / (2 * columns), 0.0), 1.0)
        self._read()

    def _read(self) -> None:
        before, self.reading = self.reading, None
        if self._cursor is not None and self.page is not None:
            self.reading = graph_cursor.read(self.page, self.window, self._cursor)
        if self.reading != before:
            self.query_one(KeyRow).refresh()
            self.mark_cells()

    def set_cursor(self, x: float) -> None:
        """Move the cursor, if it is shown, to x (part of the window)."""
        if self._cursor is not None:
            self._cursor = x
            self._read()

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
