"""Measured points as a run finds them: copies of the tables that `data 'file'` filled, ready to be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.runtime.point_set import PointSet

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.segment import MeasuredColumn, MeasuredPoints, Segment
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.values import Values

    Floats = NDArray[np.float64]


def point_sets(segment: Segment, values: Values) -> tuple[PointSet, ...]:
    """Return the points that a segment's display draws. DesireError 536: columns without a time in common."""
    return tuple(_points(segment, points, values) for points in _asked(segment))


def outside_warnings(segment: Segment, record: RunRecord) -> tuple[Diagnostic, ...]:
    """Return a warning for each column none of whose times lies within the run."""
    warnings = []
    low, high = record.time_range
    for points, found in zip(_asked(segment), record.points, strict=True):
        if points.x is None and not np.any((found.x >= low) & (found.x <= high)):
            facts: dict[str, object] = {
                "name": found.name, "first": float(found.x.min()), "last": float(found.x.max()),
                "begin": low, "end": high,
            }  # fmt: skip
            problem = at_statement("measured-outside-run", facts, segment, points.y.where)
            warnings.append(replace(problem, severity="warning"))
    return tuple(warnings)


def _asked(segment: Segment) -> Iterator[MeasuredPoints]:
    for request in segment.requests:
        yield from request.points


def _points(segment: Segment, points: MeasuredPoints, values: Values) -> PointSet:
    t, y = _table(points.y, values)
    if points.x is None:
        return PointSet(points.y.name, "t", t, y)
    other, x = _table(points.x, values)
    here, there = _together(t, other)
    if not len(here):
        facts: dict[str, object] = {"y": points.y.name, "x": points.x.name}
        raise DesireError(at_statement("measured-apart", facts, segment, points.y.where))
    return PointSet(points.y.name, points.x.name, x[there], y[here])


def points_of_table(name: str, table: Floats) -> PointSet:
    """Return a copy of what a table of `data 'file'` holds: n times, then the n values there."""
    t, y = table.copy().reshape(2, -1)
    return PointSet(name, "t", t, y)


def _table(column: MeasuredColumn, values: Values) -> tuple[Floats, Floats]:
    points = points_of_table(column.name, values.data[column.slot : column.slot + column.count])
    return points.x, points.y


def _together(one: Floats, other: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return where the same times stand in two rising sequences; what was measured often, in its order."""
    first, second = _counted(one), _counted(other)
    places = {time: place for place, time in enumerate(second)}
    pairs = [(place, places[time]) for place, time in enumerate(first) if time in places]
    here, there = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    return here, there


def _counted(times: Floats) -> list[tuple[float, int]]:
    """Return each time with how often it came before."""
    before: dict[float, int] = {}
    found = []
    for time in times.tolist():
        found.append((time, before.get(time, 0)))
        before[time] = before.get(time, 0) + 1
    return found
