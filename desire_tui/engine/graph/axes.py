"""How values are laid out along the axes of a graph: linear or logarithmic, with equal scales or not.

A logarithmic axis shows the logarithms: frames, windows and limits are those of the logarithms then.
"""

from __future__ import annotations

from math import log10
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.graph.polylines import to_unit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Frame

    Floats = NDArray[np.float64]

DECADES = 4
"""So many factors of ten a logarithmic axis reaches down whose program scale begins at 0 or below."""


class Axes(NamedTuple):
    """Which axes are logarithmic, and whether a step along both is of the same length."""

    log_x: bool = False
    log_y: bool = False
    equal: bool = False

    @property
    def is_log(self) -> bool:
        """Whether any axis is logarithmic."""
        return self.log_x or self.log_y

    def changed(self, word: str) -> Axes:
        """Return the axes after `display WORD`: logx, logy, loglog, equal, linear (as at the start)."""
        match word:
            case "logx":
                return self._replace(log_x=True)
            case "logy":
                return self._replace(log_y=True)
            case "loglog":
                return self._replace(log_x=True, log_y=True)
            case "equal":
                return self._replace(equal=True)
            case "unequal":
                return self._replace(equal=False)
        return Axes()

    def frame(self, frame: Frame) -> Frame:
        """Return a frame of program values in those of the axes."""
        if self.log_x:
            left, right = _log_limits(frame.left, frame.right)
            frame = replace(frame, left=left, right=right)
        if self.log_y:
            bottom, top = _log_limits(frame.bottom, frame.top)
            frame = replace(frame, bottom=bottom, top=top)
        return frame

    def values(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Return program values in those of the axes; nan where there is no logarithm."""
        return _logs(x) if self.log_x else x, _logs(y) if self.log_y else y

    def to_unit(self, frame: Frame, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Return program values in units of their frame."""
        return to_unit(self.frame(frame), *self.values(x, y)) if self.is_log else to_unit(frame, x, y)

    def abscissa(self, frame: Frame, part: float) -> float:
        """Return the program value at a part of a frame's width."""
        frame = self.frame(frame)
        value = frame.left + part * (frame.right - frame.left)
        return float(10.0**value) if self.log_x else value


AXIS_WORDS = ("logx", "logy", "loglog", "linear", "equal")


def _logs(values: Floats) -> Floats:
    with np.errstate(all="ignore"):
        logs = np.log10(values)
    return np.where(values > 0, logs, np.nan)


def _log_limits(low: float, high: float) -> tuple[float, float]:
    top = log10(high) if high > 0 else 0.0
    return (log10(low) if 0 < low < high else top - DECADES), top


def equalized(
    frame: Frame, window: tuple[float, float, float, float], ratio: float
) -> tuple[float, float, float, float]:
    """Return the window, larger in one direction, in which a step along both axes is of the same length.

    `ratio`: the width of the drawing over its height.
    """
    left, right, bottom, top = window
    width, height = frame.right - frame.left, frame.top - frame.bottom
    wide, high = (right - left) * width, (top - bottom) * height
    if not (wide > 0 and high > 0 and ratio > 0):
        return window
    if wide < high * ratio:
        more = (high * ratio / wide - 1) / 2 * (right - left)
        return left - more, right + more, bottom, top
    more = (wide / ratio / high - 1) / 2 * (top - bottom)
    return left, right, bottom - more, top + more
