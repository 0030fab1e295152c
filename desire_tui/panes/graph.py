"""The graph pane: draws the newest graph while its runs go on; zoom, pan, read-out, pages."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.geometry import Region
from textual.message import Message

from desire_tui.panes import readout
from desire_tui.panes.tiles import TILE_COLUMNS, WHITE_STYLE, CanvasTile, FrameLayer, KeyRow
from desire_tui.panes.window import Window

if TYPE_CHECKING:
    from rich.style import Style
    from textual import events
    from textual.app import ComposeResult

    from desire_tui.engine.graph import Graph
    from desire_tui.engine.outputs.canvas import Canvas
    from desire_tui.engine.outputs.frame import TextFrame
    from desire_tui.engine.outputs.painter import Painter

DRAG_CELLS_MIN = 2
OVERLAYS_MAX = 12


class GraphPane(Container, can_focus=True):
    """Shows one page of the session's graphs."""

    DEFAULT_CSS = """
    GraphPane { layers: frame curves; background: #0b0d11; color: #b8bec9; }
    GraphPane:light { background: #ffffff; color: #202020; }
    GraphPane:focus { border-left: solid $primary; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("plus,equals_sign", "app.do('graph.zoom_in')", show=False),
        Binding("minus", "app.do('graph.zoom_out')", show=False),
        Binding("0,escape", "app.do('graph.reset')", show=False),
        Binding("r", "app.do('graph.read')", show=False),
        Binding("k", "app.do('graph.legend')", show=False),
        Binding("s", "app.do('graph.snapshot')", show=False),
        Binding("o", "app.do('graph.overlay')", show=False),
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

    class PauseWanted(Message):
        """The graph was clicked twice."""

    def __init__(self) -> None:
        super().__init__(id="graph")
        self.page: Graph | None = None
        self.canvas: Canvas | None = None
        self.frame: TextFrame | None = None
        self.window = Window()
        self.keys_shown = True
        self.rubber: Region | None = None
        self.reading: readout.Reading | None = None
        self.overlay_next = False
        self._cursor: float | None = None
        self._painter: Painter | None = None
        self._drawn: tuple[object, ...] = ()
        self._drag: tuple[int, int] | None = None
        self._under: list[Graph] = []
        self._sheet: tuple[object, ...] = ()
        self._ground: tuple[tuple[str, bool], tuple[Style, bool]] | None = None

    def compose(self) -> ComposeResult:
        """Frame behind; tiles come with the size."""
        yield FrameLayer()
        yield KeyRow()

    # ---------------------------------------------------------------------------------------------- drawing

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

    @property
    def page_mark(self) -> str:
        """Tells which page is shown, if it is not the newest, and whether it is magnified."""
        marks = []
        pages = self._pages()
        if self.page is not None and pages and self.page is not pages[-1]:
            marks.append(
                f"page {pages.index(self.page) + 1}/{len(pages)}" if self.page in pages else "old page"
            )
        if not self.window.is_whole:
            marks.append("zoom")
        return f" {' · '.join(marks)} " if marks else ""

    @property
    def cursor_column(self) -> int | None:
        """Column of the canvas where the cursor line stands."""
        if self.reading is None or self.canvas is None or not 0.0 <= self.reading.x <= 1.0:
            return None
        return min(int(self.reading.x * self.canvas.columns), self.canvas.columns - 1)

    @property
    def cursor_colour(self) -> str:
        """Colour of the cursor line."""
        return "#000000" if self.is_white else "#ffffff"

    def follow_newest(self, graph: Graph | None) -> None:
        """Show a graph that was just begun; the window stays if the same variables are drawn again."""
        if graph is None:
            return
        if graph is not self.page:
            before = self.page
            if before is None or (before.caption, before.frame.kind) != (graph.caption, graph.frame.kind):
                self.window = Window()
                self._under.clear()
            if self.overlay_next and before is not None:
                self._under = [*self._under, before][-OVERLAYS_MAX:]
            elif not self.overlay_next:
                self._under.clear()
            self.overlay_next = False
            self.page = graph
        self._drawn = ()

    def tick(self) -> None:
        """Draw what is new. Called as often as frames are wanted; costs nothing when nothing changed."""
        if self.page is None or not self.size.width or not self.is_on_screen:
            return
        state = self._state()
        if state != self._drawn:
            self._begin_page(state)
        assert self._painter is not None
        assert self.canvas is not None
        self._painter.update()
        self._refresh_tiles(self.canvas.take_dirty())
        if self._cursor is not None:
            self._read()

    def _state(self) -> tuple[object, ...]:
        page = self.page
        assert page is not None
        under = tuple(len(graph.curves) for graph in self._under)
        curves = len(page.curves) if under else 0
        look = (page.frame, page.caption, page.net, self.is_white, self.window, self.size)
        return id(page), look, under, curves

    def _begin_page(self, state: tuple[object, ...]) -> None:
        from desire_tui.engine.outputs.canvas import Canvas
        from desire_tui.engine.outputs.frame import text_frame
        from desire_tui.engine.outputs.painter import Painter

        page = self.page
        assert page is not None
        self._drawn = state
        frame = text_frame(page, self.size.width, max(self.size.height - 1, 1), self.window)
        resized = self.frame is None or self.canvas is None or (
            (frame.left, frame.top, frame.columns, frame.rows)
            != (self.frame.left, self.frame.top, self.frame.columns, self.frame.rows)
        )  # fmt: skip
        self.frame = frame
        if resized:
            self.canvas = Canvas(max(frame.columns, 1), max(frame.rows, 1))
            self._place_tiles()
        assert self.canvas is not None
        if self._under:
            page = replace(page, curves=[curve for graph in (*self._under, page) for curve in graph.curves])
        self._painter = Painter(self.canvas, page, self.window)
        sheet = (frame.lines, self.is_white, page.net, page.keys, self.page_mark)
        if sheet != self._sheet:
            self._sheet = sheet
            self.query_one(FrameLayer).refresh()
            self.query_one(KeyRow).refresh()

    def on_resize(self) -> None:
        """Have tiles at hand before the first graph: making them takes longer than drawing it."""
        if self.canvas is None:
            self._have_tiles(self.size.width // TILE_COLUMNS)

    def _have_tiles(self, wanted: int) -> list[CanvasTile]:
        tiles = list(self.query(CanvasTile))
        for tile in tiles[wanted:]:
            tile.remove()
        if wanted > len(tiles):
            new = [CanvasTile(number) for number in range(len(tiles), wanted)]
            self.mount(*new)
            tiles += new
        return tiles

    def _place_tiles(self) -> None:
        assert self.frame is not None
        assert self.canvas is not None
        wanted = self.canvas.tiles
        tiles = self._have_tiles(wanted)
        for number, tile in enumerate(tiles[:wanted]):
            tile.styles.offset = (self.frame.left + number * TILE_COLUMNS, self.frame.top)
            tile.styles.width = min(TILE_COLUMNS, self.canvas.columns - number * TILE_COLUMNS)
            tile.styles.height = self.canvas.rows

    def _refresh_tiles(self, dirty: set[tuple[int, int]]) -> None:
        if not dirty:
            return
        by_number = {tile.number: tile for tile in self.query(CanvasTile)}
        for number, cells in groupby(sorted(dirty, key=lambda at: (at[1], at[0])), key=lambda at: at[1]):
            tile = by_number.get(number)
            if tile is None:
                continue
            rows = [row for row, _ in cells]
            regions, first = [], rows[0]
            for row, following in zip(rows, [*rows[1:], -1], strict=True):
                if following != row + 1:
                    regions.append(Region(0, first, tile.size.width, row - first + 1))
                    first = following
            tile.refresh(*regions)

    def _redraw_tiles(self) -> None:
        for tile in self.query(CanvasTile):
            tile.refresh()

    # ------------------------------------------------------------------------------------------- the window

    def zoom(self, factor: float, x: float = 0.5, y: float = 0.5) -> None:
        """Make the window `factor` times as large, around a point given in parts of it."""
        self._look(self.window.zoomed(factor, x, y))

    def pan(self, x: float, y: float) -> None:
        """Move the window by parts of itself."""
        self._look(self.window.panned(x, y))

    def reset_window(self) -> None:
        """Back to the program's scale; the cursor goes."""
        self._cursor, self.reading = None, None
        self._look(Window())
        self._redraw_tiles()
        self.query_one(KeyRow).refresh()

    def _look(self, window: Window) -> None:
        if self.page is not None and self.page.frame.kind != "picture":
            self.window = window
            self.tick()

    # ---------------------------------------------------------------------------------------------- read-out

    def toggle_readout(self) -> None:
        """Show or hide the cursor."""
        self._cursor = 0.5 if self._cursor is None else None
        self._read()
        self._redraw_tiles()

    def action_arrow(self, x: int, y: int) -> None:
        """Move the cursor if it is shown, else the window."""
        if self._cursor is None or not x:
            self.pan(0.05 * x, 0.1 * y)
            return
        columns = self.canvas.columns if self.canvas is not None else 100
        self._cursor = min(max(self._cursor + x / (2 * columns), 0.0), 1.0)
        self._read()

    def _read(self) -> None:
        before, column = self.reading, self.cursor_column
        self.reading = None
        if self._cursor is not None and self.page is not None:
            self.reading = readout.read(self.page, self.window, self._cursor)
        if self.reading != before:
            self.query_one(KeyRow).refresh()
            for at in (column, self.cursor_column):
                for tile in self.query(CanvasTile):
                    if at is not None and tile.number == at // TILE_COLUMNS:
                        tile.refresh()

    def toggle_keys(self) -> None:
        """Show or hide the colour keys."""
        self.keys_shown = not self.keys_shown
        self.query_one(KeyRow).refresh()

    # ------------------------------------------------------------------------------------------------- pages

    def _pages(self) -> list[Graph]:
        return list(self.app.session.graphs)  # type: ignore[attr-defined]

    def turn(self, step: int) -> bool:
        """Show an older (-1) or newer (1) page; False if there is none."""
        pages = self._pages()
        at = pages.index(self.page) if self.page in pages else len(pages)
        if not 0 <= at + step < len(pages):
            return False
        self.page = pages[at + step]
        self.window = Window()
        self._under.clear()
        self.tick()
        return True

    def overlay(self, number: int | None) -> bool:
        """Lay page `number` (from 1.

        Default: the one before) under the one shown; again: take overlays away.
        """
        if self._under and number is None:
            self._under.clear()
            self.tick()
            return True
        pages = self._pages()
        at = (
            (pages.index(self.page) - 1 if self.page in pages else len(pages) - 1)
            if number is None
            else number - 1
        )
        if self.page is None or not 0 <= at < len(pages) or pages[at] is self.page:
            return False
        self._under.append(pages[at])
        self.tick()
        return True

    # ------------------------------------------------------------------------------------------------- mouse

    def _cell(self, event: events.MouseEvent) -> tuple[int, int] | None:
        """Cell of the canvas under the mouse."""
        if self.frame is None or self.canvas is None:
            return None
        origin = self.content_region
        x = int(event.screen_x) - origin.x - self.frame.left
        y = int(event.screen_y) - origin.y - self.frame.top
        return min(max(x, 0), self.canvas.columns - 1), min(max(y, 0), self.canvas.rows - 1)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Begin a rectangle to zoom into."""
        if event.button == 1 and (cell := self._cell(event)) is not None:
            self._drag = cell
            self.capture_mouse()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Show the rectangle."""
        if self._drag is None or (cell := self._cell(event)) is None:
            return
        (x1, x2), (y1, y2) = sorted((self._drag[0], cell[0])), sorted((self._drag[1], cell[1]))
        self.rubber = Region(x1, y1, x2 - x1 + 1, y2 - y1 + 1)
        self._redraw_tiles()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Zoom into the rectangle; a mere click puts the cursor there."""
        self.release_mouse()
        box, self.rubber = self.rubber, None
        drag, self._drag = self._drag, None
        if self.canvas is None or drag is None:
            return
        if box is not None and box.width > DRAG_CELLS_MIN and box.height > 1:
            columns, rows = self.canvas.columns, self.canvas.rows
            self._look(
                self.window.part(
                    box.x / columns, box.right / columns, 1 - box.bottom / rows, 1 - box.y / rows
                )
            )
        elif (cell := self._cell(event)) is not None and self._cursor is not None:
            self._cursor = (cell[0] + 0.5) / self.canvas.columns
            self._read()
        self._redraw_tiles()

    def on_click(self, event: events.Click) -> None:
        """Two clicks pause the run."""
        if event.chain == 2:
            self.post_message(self.PauseWanted())

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Zoom in at the mouse."""
        self._wheel(event, 0.8)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Zoom out at the mouse."""
        self._wheel(event, 1.25)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        event.stop()
        if (cell := self._cell(event)) is not None and self.canvas is not None:
            self.zoom(factor, (cell[0] + 0.5) / self.canvas.columns, 1 - (cell[1] + 0.5) / self.canvas.rows)
