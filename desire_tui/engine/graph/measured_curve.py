"""Points of a data file as a curve of a page, drawn by markers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.curve import Curve
from desire_tui.engine.graph.still_record import still_record

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.graph.curve import Frame
    from desire_tui.engine.runtime.point_set import PointSet

_SLACK = 1e-9


def measured_curve(points: PointSet, frame: Frame, color: int) -> Curve:
    """Return points as a curve; those over t end with the time that the frame shows."""
    x, y = points.x, points.y
    if frame.kind == "dispt":
        slack = _SLACK * (frame.right - frame.left)
        inside = (x >= frame.left - slack) & (x <= frame.right + slack)
        x, y = x[inside], y[inside]
    return Curve(
        points.name, points.x_name, color, still_record([x, y], frame), 1, 0, frame,
        joined=False, measured=True, own_color=color,
    )  # fmt: skip


def without_known(curves: Sequence[Curve], there: Sequence[Curve]) -> list[Curve]:
    """Return the curves but those points which an earlier run has brought to the page already."""
    known = [one for one in there if one.measured]
    return [one for one in curves if not (one.measured and any(_same(one, other) for other in known))]


def _same(one: Curve, other: Curve) -> bool:
    names = (one.name, one.x_name) == (other.name, other.x_name)
    return names and np.array_equal(one.record.rows, other.record.rows)
