"""Keeps a canvas up to date with a graph: each call draws only the samples since the last call."""

from __future__ import annotations

from operator import is_
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.fit import WHOLE
from desire_tui.engine.graph.model import FEW_POINTS, SQUARE_MOST
from desire_tui.engine.graph.polylines import thin_columns, through
from desire_tui.engine.outputs.backdrop import Backdrop
from desire_tui.engine.outputs.clip_marks import ClipMarks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.braille_canvas import Canvas

    Floats = NDArray[np.float64]
    Window = tuple[float, float, float, float]

CROSS = 3
"""The thickness that makes crosses of points."""
MEASURED_LEAST = 2
"""The thickness of measured points that are many."""
SAMPLES_MOST = 200_000
"""Samples of a curve that one call draws at most, so that ten million of them do not block the screen."""


class Painter:
    """Draws one graph on one canvas through a window (left, right, bottom, top) in frame units.

    Its first curves, so many as `behind` says, may be complete on an earlier painter's `backdrop`.
    """

    def __init__(
        self,
        canvas: Canvas,
        graph: Graph,
        window: Window = WHOLE,
        behind: int = 0,
        backdrop: Backdrop | None = None,
    ) -> None:
        self.canvas, self.graph, self.window = canvas, graph, window
        self._drawn: dict[Curve, int] = {}
        self._along: dict[Curve, int] = {}  # dots of dashed curves
        self._points = 0
        self._pictures: list[Floats | None] = []
        self._few = graph.has_few_points
        self._erased = graph.erased
        self.clipped = ClipMarks(canvas.columns, canvas.rows)
        canvas.clear()
        self._behind = 0 if graph.shown else behind
        self.backdrop: Backdrop | None = None
        """The curves behind, once they are drawn."""
        if backdrop is not None and backdrop.fits(canvas, graph.curves[: self._behind], self._look):
            backdrop.put(canvas)
            self._drawn.update(backdrop.curves)
            self.clipped, self.backdrop = backdrop.clipped.copy(), backdrop

    @property
    def _look(self) -> tuple[object, ...]:
        return self.window, self.graph.axes, self._few

    def update(self) -> bool:
        """Draw what is new; returns whether there may be more at once (a long curve seen first)."""
        if self.graph.erased != self._erased:
            self._erased = self.graph.erased
            self.clipped = ClipMarks(self.canvas.columns, self.canvas.rows)
            self._begin_anew()
        if self._few != self.graph.has_few_points:
            self._few = self.graph.has_few_points
            self._begin_anew()
        self._picture()
        more = False
        for number, curve in enumerate(list(self.graph.curves)):
            more |= self._curve(curve)
            if (
                number + 1 == self._behind
                and self.backdrop is None
                and len(self._drawn) == self._behind
                and not more
            ):
                self.backdrop = Backdrop.taken(self.canvas, self._drawn, self._look, self.clipped)
        self._plot_points()
        return more

    def _begin_anew(self) -> None:
        self.backdrop = None
        self._drawn.clear()
        self._along.clear()
        self._points, self._pictures = 0, []
        self.canvas.clear()

    def _curve(self, curve: Curve) -> bool:
        count = curve.count
        drawn = self._drawn.get(curve, 0)
        if count == drawn:
            return False
        stop = min(count, drawn + SAMPLES_MOST)
        # the last sample drawn is the first end of the next line
        x, y = curve.samples(max(drawn - 1, 0) if curve.joined else drawn, stop)
        x, y = through(self.window, *self.graph.axes.to_unit(curve.frame, x, y))
        self.clipped.add(x, y)
        if curve.joined:
            if curve.frame.kind == "dispt":
                x, y = thin_columns(x, y, self.canvas.width)
            self._along[curve] = self.canvas.line(
                x, y, curve.color, curve.thickness, curve.dash, self._along.get(curve, 0)
            )
        else:
            self.canvas.dots(x, y, curve.color, self._marker(curve))
        self._drawn[curve] = stop
        return stop < count

    def _plot_points(self) -> None:
        points = self.graph.points
        if points.count == self._points or self.graph.frame.kind != "plot":
            return
        x, y, colors = points.so_far()
        x, y, colors = x[self._points :], y[self._points :], colors[self._points :]
        self._points += len(x)
        x, y = through(self.window, *self.graph.axes.to_unit(self.graph.frame, x, y))
        self.clipped.add(x, y)
        for color in np.unique(colors):
            chosen = colors == color
            self.canvas.dots(x[chosen], y[chosen], int(color), self._thickness(self.graph.thickness))

    def _marker(self, curve: Curve) -> int:
        """Return the thickness of a curve's points; measured ones stand out whatever else is drawn."""
        if curve.measured:
            return CROSS if curve.count <= FEW_POINTS else MEASURED_LEAST
        return self._thickness(curve.thickness)

    def _thickness(self, asked: int) -> int:
        """Return the thickness of points: few are drawn as crosses, which are seen."""
        return CROSS if self._few else asked

    def _picture(self) -> None:
        """SHOW: side by side, sign by colour; large values are dense dots (dithering) or large squares."""
        shown = self.graph.shown
        newest = [array.newest() for array in shown]
        if len(newest) == len(self._pictures) and all(map(is_, newest, self._pictures)):
            return
        self._begin_anew()  # curves are drawn over it, again with each new picture
        self._pictures = newest
        for number, array in enumerate(shown):
            values = array.latest()
            if values is None:
                continue
            parts = array.sides(values) if array.by_size else values / (array.scale or 1.0)
            self._cells(parts, number / len(shown), (number + 1) / len(shown), by_size=array.by_size)

    def _cells(self, values: Floats, left: float, right: float, *, by_size: bool) -> None:
        """Light the dots of one picture: each looks at the element it lies on."""
        canvas = self.canvas
        first = round(left * canvas.width)
        wide, high = max(round(right * canvas.width) - 1 - first, 1), canvas.height
        down = (np.arange(high) + 0.5) * values.shape[0] / high
        across = (np.arange(wide) + 0.5) * values.shape[1] / wide
        seen = values[np.ix_(down.astype(np.intp), across.astype(np.intp))]
        if by_size:
            limit = np.maximum.outer(
                _from_center(down, high / values.shape[0]), _from_center(across, wide / values.shape[1])
            )
        else:
            limit = (_BAYER[np.arange(high)[:, None] % 4, np.arange(wide)[None, :] % 4] + 0.5) / 16
        for color, lit in ((_POSITIVE, seen > limit), (_NEGATIVE, -seen > limit)):
            row, column = np.nonzero(lit)
            canvas.dots((column + first + 0.5) / canvas.width, 1.0 - (row + 0.5) / canvas.height, color)


_BAYER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])
_POSITIVE, _NEGATIVE = 14, 9


def _from_center(places: Floats, dots: float) -> Floats:
    """Return the side of the square that reaches each place, 0 at the centre; a cell has so many `dots`."""
    off = np.abs(places % 1.0 - 0.5)
    return np.where(off * dots < _HALF_A_DOT, 0.0, 2 * off / SQUARE_MOST)


_HALF_A_DOT = 0.501
