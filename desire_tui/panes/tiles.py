"""The pieces of the graph on screen.

The frame behind, tiles of 8 columns with the curves, the row of colour keys.

A widget's partial refresh sends a row again from the widget's left edge: tiles keep a frame at a few
kilobytes.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from desire_tui.panes.graph import GraphPane

TILE_COLUMNS, NO_COLOR = 8, 255
"""As in `engine.outputs.canvas`, which brings NumPy; a test holds them together."""
WHITE_STYLE = Style(color="#202020", bgcolor="#ffffff")


@lru_cache(maxsize=256)
def curve_style(color: int, *, white: bool) -> Style:
    """Return the style of a colour number on a black or white background."""
    from desire_tui.engine.graph import rgb

    return Style(color=Color.from_rgb(*rgb(color, white=white)))


class GraphPiece(Widget):
    """Anything drawn inside a graph pane."""

    can_focus = False

    _pane: GraphPane | None = None

    @property
    def pane(self) -> GraphPane:
        """The graph pane."""
        return self._pane or self._find_pane()

    def _find_pane(self) -> GraphPane:
        from desire_tui.panes.graph import GraphPane

        pane = next(ancestor for ancestor in self.ancestors if isinstance(ancestor, GraphPane))
        assert isinstance(pane, GraphPane)
        return pane

    def on_mount(self) -> None:
        """Look the pane up once: rows are drawn hundreds of times a second."""
        self._pane = self._find_pane()


class FrameLayer(GraphPiece):
    """Axes, ticks, labels, title and caption."""

    DEFAULT_CSS = "FrameLayer { width: 1fr; height: 1fr; layer: frame; }"

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        pane = self.pane
        ground, white = pane.paper
        frame, page = pane.frame, pane.page
        width = self.size.width
        if frame is None or page is None:
            text = "No graph yet · F5 runs the program" if y == self.size.height // 2 and width > 30 else ""
            return Strip([Segment(text.center(width), ground + Style(dim=True))], width)
        line = frame.lines[y] if y < len(frame.lines) else ""
        net = ground if page.net is None else ground + curve_style(page.net, white=white)
        style = net if frame.top - 1 <= y <= frame.top + frame.rows else ground
        head = ""
        if y == 0:
            style, head = ground + Style(bold=True), pane.page_mark
            line = line[: width - len(head)] if head else line
        return Strip([Segment(line + head, style)], len(line) + len(head)).adjust_cell_length(width, ground)


class CanvasTile(GraphPiece):
    """Columns `number * 8 …` of the canvas."""

    DEFAULT_CSS = "CanvasTile { layer: curves; position: absolute; width: 0; height: 0; }"

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number

    def render_line(self, y: int) -> Strip:
        """Draw a row of cells."""
        pane = self.pane
        ground, white = pane.paper
        canvas = pane.canvas
        start = self.number * TILE_COLUMNS
        stop = start + self.size.width
        if canvas is None or y >= canvas.rows or stop > canvas.columns:
            return Strip.blank(self.size.width, ground)
        segments = [
            Segment(text, ground if color == NO_COLOR else ground + curve_style(color, white=white))
            for text, color in canvas.runs(y, start, stop)
        ]
        strip = Strip(segments, stop - start)
        if (column := pane.cursor_column) is not None and start <= column < stop:
            at = column - start
            cell = strip.crop(at, at + 1)
            mark = cell.text if cell.text.strip() else "│"
            line = Strip([Segment(mark, ground + Style(color=pane.cursor_colour, bold=True))], 1)
            strip = Strip.join([strip.crop(0, at), line, strip.crop(at + 1)])
        if (box := pane.rubber) is not None and box.y <= y < box.bottom:
            first, last = max(box.x, start) - start, min(box.right, stop) - start
            if first < last:
                chosen = strip.crop(first, last).apply_style(Style(bgcolor="#4a5a70"))
                strip = Strip.join([strip.crop(0, first), chosen, strip.crop(last)])
        return strip


class KeyRow(GraphPiece):
    """Colour keys, or what the cursor reads."""

    DEFAULT_CSS = "KeyRow { height: 1; width: 1fr; layer: frame; dock: bottom; }"

    def render_line(self, y: int) -> Strip:
        """Draw the row."""
        del y
        pane = self.pane
        ground, white = pane.paper
        width = self.size.width
        reading = pane.reading
        segments: list[Segment] = []
        if reading is not None:
            segments.append(Segment(f" {reading.head} ", ground + Style(bold=True)))
            for name, color, value in reading.values:
                segments.append(
                    Segment(f" {name} = {value}", ground + curve_style(color, white=white))
                )
        elif pane.page is not None and pane.keys_shown:
            for name, color in pane.page.keys:
                segments.append(Segment(" ■ ", ground + curve_style(color, white=white)))
                segments.append(Segment(name, ground))
        used = sum(segment.cell_length for segment in segments)
        pad = max((width - used) // 2, 0) if reading is None else 0
        strip = Strip([Segment(" " * pad, ground), *segments])
        if strip.cell_length > width:
            strip = Strip.join([strip.crop(0, width - 1), Strip([Segment("…", ground)], 1)])
        return strip.adjust_cell_length(width, ground)
