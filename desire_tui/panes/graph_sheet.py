"""The sheet a graph is drawn on, cut into strips for the tiles.

Equal pieces are one object. A strip keeps what Textual made of it — cut, filtered, written as escape codes —
so the many blank ones are worked on once, and a piece that is the same object as before is not sent again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from desire_tui.engine.data_classes import dataclass
from desire_tui.panes.graph_styles import NO_COLOR, curve_style

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    from numpy.typing import NDArray
    from textual.geometry import Region

    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.text_frame import TextFrame

    Dots = NDArray[np.uint8]

TILE_COLUMNS = 8
"""As in `engine.outputs.braille_canvas`, which brings NumPy; a test holds them together."""
PIECES_MOST = 8000
_CHOSEN = Style(bgcolor="#4a5a70")


@dataclass(frozen=True, slots=True)
class SheetStyles:
    """Styles of paper, title (or notice, where there is no frame) and net, and whether the paper is white."""

    ground: Style
    head: Style
    net: Style
    white: bool


class GraphSheet:
    """Frame and canvas as one grid of cells; tile `n` is its columns `8 n … 8 n + 7`."""

    def __init__(self) -> None:
        self.cursor: tuple[int, Style] | None = None
        """Column of the cursor line, and its style."""
        self.box: Region | None = None
        """Rectangle that is being marked."""
        self.above: Canvas | None = None
        """What is drawn above the curves, on a canvas of the same size."""
        self.ground = Style()
        """Paper before anything was laid."""
        self._look: SheetStyles | None = None
        self._lines: list[str] = []
        self._frame: TextFrame | None = None
        self._canvas: Canvas | None = None
        self._made: dict[tuple[object, ...], Strip] = {}
        self._sent: dict[tuple[int, int], Strip] = {}

    def lay(
        self, columns: int, rows: int, look: SheetStyles, lines: Iterable[str],
        frame: TextFrame | None = None, canvas: Canvas | None = None,
    ) -> list[tuple[int, int]]:  # fmt: skip
        """Take a frame of so many cells, and the canvas in it; return the cells with another text."""
        if look != self._look:
            self._made.clear()
        self._look, self._frame, self._canvas = look, frame, canvas
        width = -(-columns // TILE_COLUMNS) * TILE_COLUMNS
        before = self._lines
        self._lines = [line[:columns].ljust(width) for line in lines][:rows]
        self._lines += [" " * width] * (rows - len(self._lines))
        if [len(line) for line in before] != [len(line) for line in self._lines]:
            return self.cells
        return [
            (row, at // TILE_COLUMNS)
            for row, (old, new) in enumerate(zip(before, self._lines, strict=True))
            if old != new
            for at in range(0, width, TILE_COLUMNS)
            if old[at : at + TILE_COLUMNS] != new[at : at + TILE_COLUMNS]
        ]

    @property
    def cells(self) -> list[tuple[int, int]]:
        """Row and tile of all pieces."""
        tiles = len(self._lines[0]) // TILE_COLUMNS if self._lines else 0
        return [(row, tile) for row in range(len(self._lines)) for tile in range(tiles)]

    def changed(self, cells: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
        """Return those cells (row, tile) that look different from when they were asked for last."""
        changed = []
        for row, tile in cells:
            piece = self.piece(tile, row)
            if self._sent.get((row, tile)) is not piece:
                self._sent[row, tile] = piece
                changed.append((row, tile))
        return changed

    def piece(self, tile: int, y: int) -> Strip:
        """Return a tile's row."""
        look = self._look
        if look is None or y >= len(self._lines):
            return Strip.blank(TILE_COLUMNS, look.ground if look is not None else self.ground)
        start = tile * TILE_COLUMNS
        text = self._lines[y][start : start + TILE_COLUMNS]
        style = look.ground
        dots: tuple[int, bytes, bytes] | None = None
        frame = self._frame
        if frame is None:
            style = look.head if text.strip() else look.ground
        else:
            if y == 0:
                style = look.head
            elif frame.top - 1 <= y <= frame.top + frame.rows:
                style = look.net
            dots = self._dots(frame, start, y)
        at = self.cursor[0] - start if self.cursor is not None and dots is not None else -1
        span = _span(self.box, start, y) if self.box is not None else None
        key = (text, style, dots, at if 0 <= at < TILE_COLUMNS else None, span)
        known = self._made.get(key)
        if known is None:
            if len(self._made) > PIECES_MOST:
                self._made.clear()
                self._sent.clear()
            known = self._made[key] = self._make(start, y, text, style, dots is not None, at, span)
        return known

    def _dots(self, frame: TextFrame, start: int, y: int) -> tuple[int, bytes, bytes] | None:
        """Return what of the canvas lies in a piece: the first column there, patterns and colours."""
        canvas, row = self._canvas, y - frame.top
        if canvas is None or not 0 <= row < canvas.rows:
            return None
        first = max(start - frame.left, 0)
        last = min(start + TILE_COLUMNS - frame.left, canvas.columns)
        if first >= last:
            return None
        patterns, colors = self._drawn(canvas, row, first, last)
        return first + frame.left - start, patterns.tobytes(), colors.tobytes()

    def _drawn(self, canvas: Canvas, row: int, first: int, last: int) -> tuple[Dots, Dots]:
        """Return patterns and colours of some cells, with what stands above them."""
        patterns, colors = canvas.patterns[row, first:last], canvas.colors[row, first:last]
        above = self.above
        if above is None or above.patterns.shape != canvas.patterns.shape:
            return patterns, colors
        on_top = above.patterns[row, first:last]
        if not on_top.any():
            return patterns, colors
        colors = colors.copy()
        colors[on_top != 0] = above.colors[row, first:last][on_top != 0]
        return patterns | on_top, colors

    def _make(
        self, start: int, y: int, text: str, style: Style, dotted: bool, at: int, span: tuple[int, int] | None
    ) -> Strip:
        look, frame, canvas = self._look, self._frame, self._canvas
        assert look is not None
        segments = [Segment(text, style)]
        if dotted and frame is not None and canvas is not None:
            first = max(start - frame.left, 0)
            last = min(start + TILE_COLUMNS - frame.left, canvas.columns)
            before, after = first + frame.left - start, last + frame.left - start
            from desire_tui.engine.outputs.braille_canvas import color_runs

            curves = [
                Segment(
                    dots,
                    look.ground if color == NO_COLOR else look.ground + curve_style(color, white=look.white),
                )
                for dots, color in color_runs(*self._drawn(canvas, y - frame.top, first, last))
            ]
            ends = Segment(text[:before], style), Segment(text[after:], style)
            segments = [piece for piece in (ends[0], *curves, ends[1]) if piece.text]
        strip = Strip(segments, TILE_COLUMNS)
        if 0 <= at < TILE_COLUMNS and self.cursor is not None:
            cell = strip.crop(at, at + 1)
            mark = Strip([Segment(cell.text if cell.text.strip() else "│", look.ground + self.cursor[1])], 1)
            strip = Strip.join([strip.crop(0, at), mark, strip.crop(at + 1)])
        if span is not None:
            chosen = strip.crop(*span).apply_style(_CHOSEN)
            strip = Strip.join([strip.crop(0, span[0]), chosen, strip.crop(span[1])])
        return strip


def _span(box: Region, start: int, y: int) -> tuple[int, int] | None:
    """Return which cells of a piece lie in a rectangle."""
    if not box.y <= y < box.bottom:
        return None
    first, last = max(box.x - start, 0), min(box.right - start, TILE_COLUMNS)
    return (first, last) if first < last else None
