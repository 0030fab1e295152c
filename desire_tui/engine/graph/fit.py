"""How far the curves of a graph reach, and the window that holds all of them.

Everything is in frame units: the program's own scale is the square 0 … 1 by 0 … 1.
"""

from __future__ import annotations

from math import inf, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.graph.ticks import log_limits, rounded_limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Curve, Frame
    from desire_tui.engine.graph.model import Graph

    Floats = NDArray[np.float64]

HAIR = 1e-3
"""A curve may leave the frame by so much, less than a dot: a sample near the limit is inside."""
_POINTS = "points"


class View(NamedTuple):
    """A part of a graph in frame units."""

    left: float = 0.0
    right: float = 1.0
    bottom: float = 0.0
    top: float = 1.0


WHOLE = View()


class Extent:
    """The least and largest finite samples of a graph's curves; each call of `update` reads new ones only."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._start()

    def _start(self) -> None:
        self.outside: dict[Curve | str, None] = {}
        """Curves that have left the program's scale."""
        self.inside: dict[Curve | str, None] = {}
        """Curves with a sample inside it."""
        self._low_x = self._low_y = inf
        self._high_x = self._high_y = -inf
        self._read: dict[Curve | str, int] = {}
        self._erased = self.graph.erased

    def update(self) -> bool:
        """Take new samples into account; returns whether anything that is asked for changed."""
        before = self._state
        if self.graph.erased != self._erased:
            self._start()
        for curve in list(self.graph.curves):
            count, read = curve.count, self._read.get(curve, 0)
            if count > read:
                self._take(curve, curve.frame, *curve.samples(read, count))
                self._read[curve] = count
        points, read = self.graph.points, self._read.get(_POINTS, 0)
        if self.graph.frame.kind == "plot" and points.count > read:
            x, y, _ = points.so_far()
            self._take(_POINTS, self.graph.frame, x[read:], y[read:])
            self._read[_POINTS] = len(x)
        return before != self._state

    @property
    def _state(self) -> tuple[float, ...]:
        reach = self._low_x, self._high_x, self._low_y, self._high_y
        return (*reach, len(self.outside), len(self.inside))

    def _take(self, curve: Curve | str, frame: Frame, x: Floats, y: Floats) -> None:
        axes = self.graph.axes
        if axes.is_log:
            frame, (x, y) = axes.frame(frame), axes.values(x, y)
        with np.errstate(all="ignore"):
            total = float(x.sum() + y.sum())  # costs a tenth of looking at each number
        if not isfinite(total):
            good = np.isfinite(x) & np.isfinite(y)
            x, y = x[good], y[good]
            if not len(x):
                return
        with np.errstate(all="ignore"):
            low_x, high_x = _unit(frame.left, frame.right, float(x.min()), float(x.max()))
            low_y, high_y = _unit(frame.bottom, frame.top, float(y.min()), float(y.max()))
        self._low_x, self._high_x = min(self._low_x, low_x), max(self._high_x, high_x)
        self._low_y, self._high_y = min(self._low_y, low_y), max(self._high_y, high_y)
        if min(low_x, low_y) < -HAIR or max(high_x, high_y) > 1 + HAIR:
            self.outside[curve] = None
        if high_x >= 0 and low_x <= 1 and high_y >= 0 and low_y <= 1:
            self.inside[curve] = None

    @property
    def is_fitted(self) -> bool:
        """Whether the graph asks to be fitted to its curves as far as they have come; log axes do."""
        if self.graph.axes.is_log:
            return True
        return self.graph.fit == "asked" or (self.graph.fit == "unset" and bool(self.outside))

    def view(self) -> View:
        """Return the window that holds all curves, at round numbers; time stays as the program sets it."""
        frame, axes = self.graph.axes.frame(self.graph.frame), self.graph.axes
        if frame.kind == "picture" or not self._low_y <= self._high_y:
            return WHOLE
        bottom, top = _fitted(frame.bottom, frame.top, self._low_y, self._high_y, is_log=axes.log_y)
        left, right = 0.0, 1.0
        if frame.kind != "dispt" or axes.log_x:
            left, right = _fitted(frame.left, frame.right, self._low_x, self._high_x, is_log=axes.log_x)
        view = View(left, right, bottom, top)
        return view if all(map(isfinite, view)) and left < right and bottom < top else WHOLE


def fitted_view(graph: Graph) -> View:
    """Return what of a finished graph is shown: the program's scale, or what it asks to be fitted."""
    if graph.fit == "no" and not graph.axes.is_log:
        return WHOLE
    extent = Extent(graph)
    extent.update()
    return extent.view() if extent.is_fitted else WHOLE


def notice(extent: Extent, remedy: str) -> str:
    """Return what is said of curves that leave the program's scale."""
    count = len(extent.outside)
    if not count:
        return ""
    what = "points" if _POINTS in extent.outside else f"{count} curve{'s' if count > 1 else ''}"
    return f"{what} outside · {remedy}"


def limits(graph: Graph, window: tuple[float, float, float, float]) -> View:
    """Return left, right, bottom, top of a window (frame units) in program units, or their logarithms."""
    frame = graph.axes.frame(graph.frame)
    width, height = frame.right - frame.left, frame.top - frame.bottom
    left, right, bottom, top = window
    return View(
        frame.left + left * width, frame.left + right * width,
        frame.bottom + bottom * height, frame.bottom + top * height,
    )  # fmt: skip


def _unit(start: float, end: float, *values: float) -> tuple[float, ...]:
    width = (end - start) or 1.0
    return tuple((value - start) / width for value in values)


def _fitted(start: float, end: float, low: float, high: float, *, is_log: bool) -> tuple[float, float]:
    width = (end - start) or 1.0
    low, high = start + low * width, start + high * width
    if is_log:
        return _unit(start, end, *log_limits(low, high))  # type: ignore[return-value]  # two of two
    # rounding must not make a difference of a start at 0, or of a constant
    tiny = 1e-12 * max(abs(low), abs(high), abs(width))
    low, high = (0.0 if abs(value) < tiny else value for value in (low, high))
    if high - low < tiny:
        low = high
    return _unit(start, end, *rounded_limits(low, high))  # type: ignore[return-value]  # two of two
