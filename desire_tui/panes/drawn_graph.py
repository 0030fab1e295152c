"""A graph drawn as tiles of text: what of it is looked at, and what changed since the last frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.style import Style
from textual.containers import Container, Vertical

from desire_tui.panes.graph_fit import CurveFit
from desire_tui.panes.graph_paging import GraphPaging
from desire_tui.panes.graph_sheet import GraphSheet, SheetStyles
from desire_tui.panes.graph_styles import WHITE_STYLE, net_style
from desire_tui.panes.graph_tiles import Tiles
from desire_tui.panes.zoom_window import Window

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.geometry import Region

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.backdrop import Backdrop
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.incremental_drawing import Painter
    from desire_tui.engine.outputs.text_frame import TextFrame

NOTICE_COLUMNS_MIN = 30


class DrawnGraph(Container):
    """The part of a graph pane that draws one page through a window."""

    def __init__(self, pages: Callable[[], list[Graph]], *, id: str) -> None:  # noqa: A002 - Textual's name
        super().__init__(id=id)
        self._pages = pages
        """All graphs of the session."""
        self.paging = GraphPaging()
        self.canvas: Canvas | None = None
        self.frame: TextFrame | None = None
        self.window = Window()
        """What is to be shown at least: `view` is larger where the axes have equal scales."""
        self.view = Window()
        self.fit = CurveFit()
        self.rubber: Region | None = None
        """The rectangle being marked with the mouse."""
        self._marks: tuple[object, ...] = ()
        self._failed = ""
        """What is said in place of a graph after a start that failed."""
        self._is_earlier = False
        """Whether the page is of a run before a start that failed."""
        self._below = Vertical(id="below")
        self._painter: Painter | None = None
        self._backdrop: Backdrop | None = None
        self._drawn: tuple[object, ...] = ()
        self.sheet = GraphSheet()
        self._tiles = Tiles(self.sheet)
        self._ground: tuple[tuple[str, bool], tuple[Style, bool]] | None = None

    @property
    def cursor_column(self) -> int | None:
        """Column of the canvas where the cursor line stands."""
        raise NotImplementedError

    def show_keys(self) -> None:
        """Have the colour keys drawn if they are others than before."""
        raise NotImplementedError

    def read_again(self) -> None:
        """Bring the read-out up to date with what was just drawn."""
        raise NotImplementedError

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
        self._tiles.refresh((row + top, tile) for row, tile in dirty)
        if self._marks != (marks := self._marks_now()):
            self._marks = marks
            self._tiles.refresh(self._lay())
        self.read_again()
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
            self._tiles.refresh(self.sheet.cells)
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
        self.show_keys()
        self._painter = painter = Painter(
            canvas, self.paging.with_all_under(page), self.view, self.paging.curves_behind, self._backdrop
        )
        painter.update()  # first: a piece is sent with what stands in it
        self._backdrop = painter.backdrop
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
        room, title = columns - len(mark), lines[0].rstrip()
        if len(title) > room:  # it stands over the middle of the curves: there is room for it further left
            title = title.strip().rjust(room)[:room]
        lines[0] = title.ljust(room) + mark
        net = ground if page.net is None else ground + net_style(page.net, white=white)
        look = SheetStyles(ground, ground + Style(bold=True), net, white)
        return self.sheet.lay(columns, rows, look, lines, frame, self.canvas)

    def on_resize(self) -> None:
        """Follow the pane's size."""
        if new := self._tiles.grow(self.size.width):
            self.mount(*new)
        self.tick()

    def mark_cells(self) -> None:
        """Have the cursor line and the rectangle being marked drawn."""
        frame, column = self.frame, self.cursor_column
        if frame is None:
            return
        colour = Style(color="#000000" if self.is_white else "#ffffff", bold=True)
        self.sheet.cursor = (frame.left + column, colour) if column is not None else None
        self.sheet.box = self.rubber.translate((frame.left, frame.top)) if self.rubber is not None else None
        self._tiles.refresh(self.sheet.cells)

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

    def look_at(self, window: Window) -> None:
        """Show another part of the page; a picture has no parts."""
        if self.page is not None and self.page.frame.kind != "picture":
            self.window, self.fit.wanted = window, False
            self.tick()

    def fit_curves(self) -> None:
        """Show the window that holds all curves, and follow them while they grow."""
        self.fit.wanted = True
        self.tick()
