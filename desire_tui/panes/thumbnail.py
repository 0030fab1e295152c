"""A graph that stands still, as large as the place it gets: in the examples browser."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from desire_tui.engine.visible_text import visible
from desire_tui.panes.graph_key_row import key_segments
from desire_tui.panes.graph_styles import NO_COLOR, WHITE_STYLE, curve_style, net_style

if TYPE_CHECKING:
    from desire_tui.engine.graph.model import Graph


class Thumbnail(Widget):
    """Frame, curves and colour keys of a graph; or, for a program without one, what it prints."""

    DEFAULT_CSS = """
    Thumbnail { background: #0b0d11; color: #b8bec9; height: 1fr; }
    Thumbnail:light { background: #ffffff; color: #202020; }
    """
    can_focus = False

    def __init__(self) -> None:
        super().__init__()
        self._graph: Graph | None = None
        self._message = ""
        self.text = ""
        self._rows: list[Strip] = []
        self._drawn: tuple[object, ...] = ()

    @property
    def graph(self) -> Graph | None:
        """The graph shown."""
        return self._graph

    def show(self, graph: Graph | None, message: str = "") -> None:
        """Show a graph, or a sentence in its place."""
        self._graph, self._message, self.text = graph, message, ""
        self._drawn = ()
        self.refresh()

    def show_text(self, text: str) -> None:
        """Show what a program printed."""
        self.show(None)
        self.text = text

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        state = (self.size, self.app.theme)
        if state != self._drawn:
            self._drawn = state
            self._rows = self._draw()
        ground = self.rich_style
        return self._rows[y] if y < len(self._rows) else Strip.blank(self.size.width, ground)

    def _draw(self) -> list[Strip]:
        width, height = self.size
        graph = self._graph
        if self.text:
            ground = self.rich_style
            lines = visible(self.text).expandtabs(8).split("\n")[:height]
            return [Strip([Segment(f" {line}", ground)]).adjust_cell_length(width, ground) for line in lines]
        if graph is None:
            ground = self.rich_style + Style(dim=True)
            blank = [Strip.blank(width, ground)] * (height // 2)
            return [*blank, Strip([Segment(self._message[:width].center(width), ground)], width)]
        from desire_tui.engine.graph.fit import WHOLE, fitted_view
        from desire_tui.engine.outputs.braille_canvas import Canvas
        from desire_tui.engine.outputs.incremental_drawing import Painter
        from desire_tui.engine.outputs.text_frame import equal_view, text_frame

        white = graph.white or not self.app.current_theme.dark
        ground = WHITE_STYLE if white else self.rich_style
        fitted = fitted_view(graph)
        window = equal_view(graph, width, height - 1, fitted)
        frame = text_frame(graph, width, height - 1, window, fitted=fitted != WHOLE)
        canvas = Canvas(max(frame.columns, 1), max(frame.rows, 1))
        painter = Painter(canvas, graph, window)
        while painter.update():
            pass
        net = ground if graph.net is None else ground + net_style(graph.net, white=white)
        rows = []
        for number, line in enumerate(painter.clipped.lines(frame, "")):
            at = number - frame.top
            style = net if -1 <= at <= frame.rows else ground
            if not 0 <= at < frame.rows:
                segments = [Segment(line, style)]
            else:
                inside = [
                    Segment(text, ground if color == NO_COLOR else ground + curve_style(color, white=white))
                    for text, color in canvas.runs(at)
                ]
                right = line[frame.left + frame.columns :]
                segments = [Segment(line[: frame.left], style), *inside, Segment(right, style)]
            rows.append(Strip(segments).adjust_cell_length(width, ground))
        return [*rows[: height - 1], self._keys(graph, ground, white=white)]

    def _keys(self, graph: Graph, ground: Style, *, white: bool) -> Strip:
        width = self.size.width
        strip = Strip(key_segments(graph.keys, ground, width, white=white))
        if strip.cell_length > width:
            strip = Strip.join([strip.crop(0, width - 1), Strip([Segment("…", ground)], 1)])
        pad = Strip.blank((width - strip.cell_length) // 2, ground)
        return Strip.join([pad, strip]).adjust_cell_length(width, ground)
