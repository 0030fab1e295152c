"""The pieces of the graph on screen: tiles of 8 columns with frame and curves, and the row of colour keys.

A widget's partial refresh sends a row again from the widget's left edge: tiles keep a frame at a few
kilobytes. They stand where the pane's size puts them, whatever the frame: a new graph lays nothing out anew.
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
    from textual.geometry import Region

    from desire_tui.panes.graph_pane import GraphPane

TILE_COLUMNS, NO_COLOR = 8, 255
"""As in `engine.outputs.braille_canvas`, which brings NumPy; a test holds them together."""
WHITE_STYLE = Style(color="#202020", bgcolor="#ffffff")


@lru_cache(maxsize=256)
def curve_style(color: int, *, white: bool) -> Style:
    """Return the style of a curve's colour number on a black or white background."""
    from desire_tui.engine.graph.colors import curve_rgb

    return Style(color=Color.from_rgb(*curve_rgb(color, white=white)))


def net_style(color: int, *, white: bool) -> Style:
    """Return the style of the net: one of the paper's own colour is not seen."""
    from desire_tui.engine.graph.colors import rgb

    return Style(color=Color.from_rgb(*rgb(color, white=white)))


class GraphPiece(Widget):
    """Anything drawn inside a graph pane."""

    can_focus = False
    ALLOW_SELECT = False

    _pane: GraphPane | None = None

    @property
    def pane(self) -> GraphPane:
        """The graph pane."""
        return self._pane or self._find_pane()

    def _find_pane(self) -> GraphPane:
        from desire_tui.panes.graph_pane import GraphPane

        pane = next(ancestor for ancestor in self.ancestors if isinstance(ancestor, GraphPane))
        assert isinstance(pane, GraphPane)
        return pane

    def on_mount(self) -> None:
        """Look the pane up once: rows are drawn hundreds of times a second."""
        self._pane = self._find_pane()


class SheetTile(GraphPiece):
    """Columns `number * 8 …` of the sheet."""

    DEFAULT_CSS = "SheetTile { width: 8; height: 1fr; }"

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number

    def render_line(self, y: int) -> Strip:
        """Draw a row of cells."""
        return self.pane.sheet.piece(self.number, y)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Draw rows.

        Widget's own way deals with padding, border, opacity and links in each row. Tiles have none, and
        it took most of the time from a run's start to its first dots.
        """
        piece = self.pane.sheet.piece
        strips = [piece(self.number, y) for y in crop.line_range]
        filters = self.get_line_filters()
        if filters:
            background = self.background_colors[1]
            for line_filter in filters:
                strips = [strip.apply_filter(line_filter, background) for strip in strips]
        if crop.column_span != (0, TILE_COLUMNS):
            strips = [strip.crop(*crop.column_span) for strip in strips]
        return strips


class KeyRow(GraphPiece):
    """Colour keys, or what the cursor reads."""

    DEFAULT_CSS = "KeyRow { height: 1; width: 1fr; dock: bottom; }"

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
                segments.append(Segment(" ■", ground + curve_style(color, white=white)))
                segments.append(Segment(f" {name} = {value}", ground))
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
