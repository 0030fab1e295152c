"""Whether a JACOBIAN segment holds the derivatives of the model: compared at a few places, before any run.

The model is differentiated exactly (`passes.differentiate`), so the two matrices may differ only by
rounding, wherever the states are. Nothing is integrated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.lowered.jacobian_array import checked_array
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.slices import jacobian_pass
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.runtime.run_faults import state_name
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]

WORK_MOST = 100_000
"""States times elements of J, beyond which a model is not compared: that would take a second, in Python."""
_PLACES = 8
_TOLERATED_PLACES = 2
"""A disagreement counts if it shows at more than so many places: not at a kink or a cancellation alone."""
_RELATIVE_TOLERANCE = 1e-3
"""Relative: constants are rounded to a few digits where somebody differentiates by hand."""
_ROUNDING = 1e-10
"""Relative to the largest element of the row: what cancellation may leave of an element that is 0."""
_SHOWN = 3


@dataclass(frozen=True)
class _Place:
    """A time, the states there, and both matrices."""

    t: float
    states: Array
    given: Array
    exact: Array

    def differ(self) -> NDArray[np.bool_]:
        """Where the matrices disagree; an element that is inf or nan in either is not judged."""
        size = np.maximum(np.abs(self.given), np.abs(self.exact))
        finite = np.isfinite(size)
        row = np.where(finite, size, 0.0).max(axis=1, initial=0.0)[:, None]
        with np.errstate(invalid="ignore"):
            difference = np.abs(self.given - self.exact)
        found: NDArray[np.bool_] = finite & (difference > _RELATIVE_TOLERANCE * size + _ROUNDING * row)
        return found


def wrong_elements(segment: Segment, values: Values) -> tuple[Diagnostic, ...] | None:
    """Return a warning 462 for each element of the JACOBIAN segment that is not the model's derivative.

    Compared near the states that `values` hold; parameters are taken as they are. None: there is no
    JACOBIAN, the model cannot be differentiated (random numbers, memory) or is too large (`WORK_MOST`).
    t and the states are put back, defined variables and the array are not. DesireError 230: the array is
    not n by n.
    """
    if segment.jacobian is None or segment.order * len(segment.jacobian.entries) > WORK_MOST:
        return None
    try:
        matrices = _Matrices(segment, values)
    except NotDifferentiable:
        return None
    t, states = values.cells[T], matrices.states()
    start, *others = [matrices.at(*place) for place in _places(t, states)]
    matrices.move(t, states)
    votes = sum(place.differ().astype(int) for place in others)
    return tuple(
        _warning(segment, (int(row), int(column)), [start, *others])
        for row, column in np.argwhere(np.asarray(votes) > _TOLERATED_PLACES)
    )


class _Matrices:
    """Both matrices of a segment as functions of t and the states."""

    def __init__(self, segment: Segment, values: Values) -> None:
        self.order, self.values = segment.order, values
        self.ranges = [(s.slot, s.first, s.count) for s in segment.states]
        self.array = checked_array(segment, values)
        self.statements = StatementClosures(values, self.order)
        self.jacobian = self.statements.compile(jacobian_pass(segment, self.order))
        tangent = differentiate(segment, values.room)
        self.directions = tangent.directions
        self.tangent = self.statements.compile(tangent.body)

    def states(self) -> Array:
        x = np.empty(self.order)
        for slot, first, count in self.ranges:
            x[first : first + count] = self.values.data[slot : slot + count]
        return x

    def at(self, t: float, states: Array) -> _Place:
        n, data = self.order, self.values.data
        exact = np.empty((n, n))
        with np.errstate(all="ignore"):
            for column in range(n):
                self.move(t, states)
                data[self.directions : self.directions + n] = 0.0
                data[self.directions + column] = 1.0
                self.tangent()
                exact[:, column] = self.statements.derivatives
            self.move(t, states)
            flat = data[self.array : self.array + n * n]
            flat[:] = 0.0
            self.jacobian()
        return _Place(t, states, flat.reshape(n, n).copy(), exact)

    def move(self, t: float, states: Array) -> None:
        self.values.cells[T] = t
        for slot, first, count in self.ranges:
            self.values.data[slot : slot + count] = states[first : first + count]


def _places(t: float, states: Array) -> Iterator[tuple[float, Array]]:
    """Yield the start itself, to show numbers that a user can repeat, and random places around it.

    Half of them are near, for models that overflow far away; half of them keep the signs of the states and
    are otherwise positive (logarithms, roots, concentrations).
    """
    yield t, states
    n, random = len(states), np.random.default_rng(1)
    for number in range(_PLACES):
        added = random.uniform(0.1, 1.0, n) * (1e-3 if number < _PLACES // 2 else 1.0)
        sign = random.choice((-1.0, 1.0), n) if number % 2 else np.where(states < 0.0, -1.0, 1.0)
        yield t + random.uniform(0.01, 1.0), states * random.uniform(0.7, 1.3, n) + sign * added


def _warning(segment: Segment, element: tuple[int, int], places: list[_Place]) -> Diagnostic:
    place = next(p for p in places if p.differ()[element])
    row, column = element
    facts = {
        "row": row + 1, "column": column + 1, "given": place.given[element], "exact": place.exact[element],
        "state": state_name(segment, row)[0], "by": state_name(segment, column)[0],
        "place": _described(segment, place),
    }  # fmt: skip
    where = _where(segment, row, column)
    span = None if where is None else where.span
    return Diagnostic("jacobian-differs", span, facts, segment.source, "warning")


def _described(segment: Segment, place: _Place) -> str:
    """Return the place in words: `t = 0, x = 1, y = 0`, large models cut short."""
    numbers = [f"{state_name(segment, i)[0]} = {x:.4g}" for i, x in enumerate(place.states[:_SHOWN])]
    more = ", …" if len(place.states) > _SHOWN else ""
    return f"t = {place.t:.4g}, {', '.join(numbers)}{more}"


def _where(segment: Segment, row: int, column: int) -> Where | None:
    """Return the element's line; for one that is missing the state's `d/dt` line."""
    assert segment.jacobian is not None
    for entry in reversed(segment.jacobian.entries):
        if (entry.row, entry.column) == (row, column) and entry.where is not None:
            return entry.where
    return state_name(segment, row)[1]
