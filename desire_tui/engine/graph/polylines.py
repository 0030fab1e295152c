"""Polylines made fit for drawing: cut at the frame, thinned without losing a peak.

Everything here works in frame units: the frame is the square 0 … 1 by 0 … 1. nan and inf break a line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Frame

    Floats = NDArray[np.float64]


_FAR = 1e9
"""Frames away; beyond, rounding would spoil the cut, and no eye can tell the direction."""


def to_unit(frame: Frame, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return program values in frame units."""
    return (
        (x - frame.left) / ((frame.right - frame.left) or 1.0),
        (y - frame.bottom) / ((frame.top - frame.bottom) or 1.0),
    )


def through(window: tuple[float, float, float, float], x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return frame units as parts of a window (left, right, bottom, top)."""
    left, right, bottom, top = window
    return (x - left) / ((right - left) or 1.0), (y - bottom) / ((top - bottom) or 1.0)


def clip_polyline(x: Floats, y: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the parts of a polyline's n - 1 segments inside the unit square as x1, y1, x2, y2.

    Liang and Barsky's method over whole arrays: a segment is x1 + s (x2 - x1) for `enter` ≤ s ≤ `leave`, and
    each side of the square raises `enter` or lowers `leave`. Segments with an end that is nan or inf are left
    out.
    """
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = np.clip(x, -_FAR, _FAR), np.clip(y, -_FAR, _FAR)
    x1, y1 = x[:-1], y[:-1]
    with np.errstate(all="ignore"):
        dx, dy = x[1:] - x1, y[1:] - y1
        enter = np.zeros(len(dx))
        leave = np.ones(len(dx))
        inside = finite[1:] & finite[:-1]
        for step, room in ((-dx, x1), (dx, 1.0 - x1), (-dy, y1), (dy, 1.0 - y1)):
            at = room / step
            enter = np.where(step < 0.0, np.maximum(enter, at), enter)
            leave = np.where(step > 0.0, np.minimum(leave, at), leave)
            inside &= (step != 0.0) | (room >= 0.0)
        inside &= enter <= leave
    x1, y1, dx, dy, enter, leave = (a[inside] for a in (x1, y1, dx, dy, enter, leave))
    return x1 + enter * dx, y1 + enter * dy, x1 + leave * dx, y1 + leave * dy


def thin_columns(x: Floats, y: Floats, columns: int) -> tuple[Floats, Floats]:
    """Thin a curve over a never-falling abscissa: at most four samples in each of `columns` columns.

    Kept are, in each run of neighbouring samples in one column, the first, the lowest, the highest and the
    last, in their order: at that width the drawing is the same and no peak is lost. Samples that are nan are
    kept once.
    """
    count = len(x)
    if count <= 4 * columns:
        return x, y
    with np.errstate(invalid="ignore"):
        column = np.clip(np.floor(x * columns), -1, columns)
    column = np.where(np.isfinite(y), column, columns + 1.0)
    starts = np.flatnonzero(np.concatenate(([True], column[1:] != column[:-1])))
    safe = np.where(np.isfinite(y), y, 0.0)
    ends = np.append(starts[1:], count) - 1
    group = np.cumsum(np.concatenate(([0], (column[1:] != column[:-1]).astype(np.intp))))
    low = _first_where(safe == np.minimum.reduceat(safe, starts)[group], group, len(starts))
    high = _first_where(safe == np.maximum.reduceat(safe, starts)[group], group, len(starts))
    keep = np.unique(np.concatenate((starts, low, high, ends)))
    return x[keep], y[keep]


def _first_where(hit: NDArray[np.bool_], group: NDArray[np.intp], groups: int) -> NDArray[np.intp]:
    """Index of the first hit in each group."""
    at = np.flatnonzero(hit)
    first = np.zeros(groups, dtype=np.intp)
    first[group[at][::-1]] = at[::-1]
    return first
