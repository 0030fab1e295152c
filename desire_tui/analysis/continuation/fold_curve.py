"""Curves over two parameters: what those of folds and of Hopf points have in common, and folds.

G. Moore and A. Spence (1980); A. Griewank and G. Reddien (1983); W. Govaerts, Numerical Methods for
Bifurcations of Dynamical Equilibria (2000).
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from desire_tui.analysis.continuation.curve import Curve, Point
from desire_tui.analysis.continuation.equilibrium_curve import AtRest
from desire_tui.analysis.equilibria.flow import central
from desire_tui.analysis.equilibria.kinds import eigenvalues

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_STEP = 1e-3
EIGENVECTOR = 0.1
"""Weight of an eigenvector's elements: what matters is where the steady state is."""


def bounds(u: Floats) -> dict[str, float]:
    """Return the tests at whose zeros a curve over two parameters is left."""
    first, second = map(float, u[-2:])
    return {"low": first, "high": 1.0 - first, "low 2": second, "high 2": 1.0 - second}


class TwoParameters(Curve):
    """What folds and Hopf points have in common: two ranges, the last two unknowns."""

    ends: ClassVar[tuple[str, ...]] = ("low", "high", "low 2", "high 2")

    def __init__(self, system: System, over: tuple[Range, Range]) -> None:
        self.system, self.over = system, over

    def p(self, u: Floats) -> dict[str, float]:
        """Return both parameters at a point."""
        return {one.name: one.value(float(part)) for one, part in zip(self.over, u[-2:], strict=True)}

    def z(self, u: Floats) -> Floats:
        """Return the steady state at a point."""
        return u[: len(self.system)]

    def matrix_at(self, u: Floats) -> Floats:
        """Return the system's Jacobian at a point."""
        return self.system.jacobian(self.z(u), self.p(u))

    def by_parts(self, u: Floats) -> Floats:
        """Return the derivatives of g by the parts of both parameters, m by 2."""
        z, p = self.z(u), self.p(u)
        slopes = [self.system.by_parameter(z, p, one.name, one.width) * one.width for one in self.over]
        return np.column_stack(slopes)

    def turned_by_parts(self, u: Floats, vector: Floats) -> Floats:
        """Return the derivatives of (∂g/∂z) v by the parts of both parameters, m by 2."""
        columns = []
        for k in (-2, -1):
            axis = np.zeros(len(u))
            axis[k] = 1.0
            columns.append(central(partial(self._turned, u, axis, vector), _STEP))
        return np.column_stack(columns)

    def _turned(self, u: Floats, axis: Floats, vector: Floats, step: float) -> Floats:
        return np.asarray(self.matrix_at(u + step * axis) @ vector)


class FoldCurve(TwoParameters):
    """g = 0, (∂g/∂z) v = 0, v·v = 1; unknowns z, v (m each) and both parameters' parts.

    cusp: w·D²g[v, v] with the left null vector w; Bogdanov-Takens: w·v.
    """

    def __init__(
        self, system: System, over: tuple[Range, Range], z: Floats, parts: tuple[float, float]
    ) -> None:
        """`z` and `parts` are a fold's."""
        super().__init__(system, over)
        m = len(system)
        self.weights = np.concatenate([np.ones(m), np.full(m, EIGENVECTOR), np.ones(2)])
        left, _, right = np.linalg.svd(self.matrix_at(np.concatenate([z, parts])))
        self.first = np.concatenate([z, right[-1], parts])
        """The unknowns at the fold."""
        self._left = left[:, -1]

    def _v(self, u: Floats) -> Floats:
        return u[len(self.system) : -2]

    def residual(self, u: Floats) -> Floats:
        """Return 2 m + 1 numbers."""
        v = self._v(u)
        rate = self.system.rate(self.z(u), self.p(u))
        return np.concatenate([rate, self.matrix_at(u) @ v, [0.5 * (v @ v - 1.0)]])

    def matrix(self, u: Floats) -> Floats:
        """Return the derivatives, 2 m + 1 by 2 m + 2."""
        m = len(self.system)
        v, jacobian = self._v(u), self.matrix_at(u)
        found = np.zeros((2 * m + 1, 2 * m + 2))
        found[:m, :m], found[:m, -2:] = jacobian, self.by_parts(u)
        found[m:-1, :m] = self.system.second(self.z(u), self.p(u), v)
        found[m:-1, m:-2], found[m:-1, -2:] = jacobian, self.turned_by_parts(u, v)
        found[-1, m:-2] = v
        return found

    def examine(self, point: Point, matrix: Any) -> None:
        """Put eigenvalues and tests into a point."""
        m, u = len(self.system), point.u
        v, w = self._v(u), self._left_at(u)
        point.facts = AtRest(eigenvalues(matrix[:m, :m]))
        cusp, double = float(w @ matrix[m:-1, :m] @ v), float(w @ v)
        point.tests = {**bounds(u), "cusp": cusp, "Bogdanov-Takens": double}

    def _left_at(self, u: Floats) -> Floats:
        """Return the left null vector, its sign that of the last point's."""
        w = np.linalg.svd(self.matrix_at(u))[0][:, -1]
        return np.asarray(-w if float(w @ self._left) < 0.0 else w)

    def adapted(self, point: Point) -> Point:
        """Return the point; its left null vector tells the sign of the next one's."""
        self._left = self._left_at(point.u)
        return point
