"""A segment's right-hand side and Jacobian as Python closures of t and x."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.state_equations import state_equations
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values

    Floats = NDArray[np.float64]

_DIFFERENCE = 2.0**-26
"""Square root of the machine's epsilon."""


class ReferenceEquations:
    """Implements `runtime.equations.Equations`. Without derivatives of its statements it differences them."""

    addresses = None

    def __init__(self, segment: Segment, values: Values) -> None:
        equations = state_equations(segment, values.room)
        self.n, self._values = equations.order, values
        self.pattern = Pattern.of(self.n, *sparsity_pattern(equations))
        self._ranges = [(s.slot, s.first, s.count) for s in equations.states]
        self._statements = StatementClosures(values, self.n)
        self._derivative = self._statements.compile(derivative_slice(equations))
        try:
            tangent = differentiate(equations, values.room)
        except NotDifferentiable:
            self._tangent, self._directions = None, 0
        else:
            self._tangent = self._statements.compile(tangent.body)
            self._directions = tangent.directions

    def derivatives(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`."""
        self._move(t, x)
        with np.errstate(all="ignore"):
            self._derivative()
        return self._statements.derivatives.copy()

    def many(self, times: Floats, states: Floats) -> Floats:
        """See `runtime.equations`."""
        rows = [self.derivatives(t, x) for t, x in zip(times.tolist(), states, strict=True)]
        return np.array(rows).reshape(states.shape)

    def jacobian(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`."""
        found = np.zeros((self.n, self.n))
        for column in range(self.n):
            found[:, column] = self._column(t, x, column)
        return found

    def jacobians(self, times: Floats, states: Floats) -> Floats:
        """See `runtime.equations`."""
        pairs = zip(times.tolist(), states, strict=True)
        return np.array([self.jacobian(t, x) for t, x in pairs]).reshape(-1, self.n, self.n)

    def entries(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`."""
        return self.jacobian(t, x)[self.pattern.rows, self.pattern.columns]

    def _column(self, t: float, x: Floats, column: int) -> Floats:
        if self._tangent is None:
            moved = x.copy()
            moved[column] += _DIFFERENCE * max(1.0, abs(x[column]))
            rise: Floats = self.derivatives(t, moved) - self.derivatives(t, x)
            return rise / float(moved[column] - x[column])
        directions = self._values.data[self._directions : self._directions + self.n]
        directions[:] = 0.0
        directions[column] = 1.0
        self._move(t, x)
        with np.errstate(all="ignore"):
            self._tangent()
        return self._statements.derivatives.copy()

    def _move(self, t: float, x: Floats) -> None:
        self._values.cells[T] = t
        for slot, first, count in self._ranges:
            self._values.data[slot : slot + count] = x[first : first + count]
