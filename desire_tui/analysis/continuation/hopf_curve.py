"""Hopf points over two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from desire_tui.analysis.continuation.equilibrium_curve import AtRest, determinant
from desire_tui.analysis.continuation.fold_curve import EIGENVECTOR, TwoParameters, bounds
from desire_tui.analysis.continuation.lyapunov import critical_vector, first_lyapunov
from desire_tui.analysis.equilibria.kinds import eigenvalues

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_SLOW = 1e-3
"""So much slower than at the first point, the Lyapunov coefficient says nothing any more."""


class HopfCurve(TwoParameters):
    """g = 0, J v = -ω w, J w = ω v; unknowns z, v, w (m each), ω in units of its first value, both parts.

    Its length is held at 1 and its phase at that of the point before. generalised Hopf: the first Lyapunov
    coefficient; zero-Hopf: the determinant without the pair; at a Bogdanov-Takens point, ω = 0, it ends.
    """

    ends: ClassVar[tuple[str, ...]] = (*TwoParameters.ends, "Bogdanov-Takens")

    def __init__(
        self, system: System, over: tuple[Range, Range], z: Floats, parts: tuple[float, float], omega: float
    ) -> None:
        """`z`, `parts` and `omega` are a Hopf point's."""
        super().__init__(system, over)
        m = len(system)
        self.weights = np.concatenate([np.ones(m), np.full(2 * m, EIGENVECTOR), np.ones(3)])
        self._unit = omega
        q = critical_vector(self.matrix_at(np.concatenate([z, parts])), omega)
        self._q = np.concatenate([q.real, q.imag])
        self.first = np.concatenate([z, self._q, [1.0], parts])
        """The unknowns at the Hopf point."""

    def _parts(self, u: Floats) -> tuple[Floats, Floats, float]:
        m = len(self.system)
        return u[m : 2 * m], u[2 * m : 3 * m], self.omega(u)

    def omega(self, u: Floats) -> float:
        """Return the frequency at a point."""
        return self._unit * float(u[-3])

    def _phase(self) -> Floats:
        """Return the row with v·w0 - w·v0."""
        m = len(self.system)
        return np.concatenate([self._q[m:], -self._q[:m]])

    def residual(self, u: Floats) -> Floats:
        """Return 3 m + 2 numbers."""
        v, w, omega = self._parts(u)
        q, jacobian = np.concatenate([v, w]), self.matrix_at(u)
        rate = self.system.rate(self.z(u), self.p(u))
        ends = [0.5 * (q @ q - 1.0), self._phase() @ q]
        return np.concatenate([rate, jacobian @ v + omega * w, jacobian @ w - omega * v, ends])

    def matrix(self, u: Floats) -> Floats:
        """Return the derivatives, 3 m + 2 by 3 m + 3."""
        m = len(self.system)
        v, w, omega = self._parts(u)
        jacobian, one = self.matrix_at(u), np.eye(m)
        z, p = self.z(u), self.p(u)
        found = np.zeros((3 * m + 2, 3 * m + 3))
        first, second, third = slice(0, m), slice(m, 2 * m), slice(2 * m, 3 * m)
        found[first, first], found[first, -2:] = jacobian, self.by_parts(u)
        found[second, first], found[third, first] = self.system.second(z, p, v), self.system.second(z, p, w)
        found[second, second], found[second, third] = jacobian, omega * one
        found[third, second], found[third, third] = -omega * one, jacobian
        found[second, -3], found[third, -3] = self._unit * w, -self._unit * v
        found[second, -2:], found[third, -2:] = self.turned_by_parts(u, v), self.turned_by_parts(u, w)
        found[-2, m : 3 * m], found[-1, m : 3 * m] = np.concatenate([v, w]), self._phase()
        return found

    def examine(self, point: Point, matrix: Any) -> None:
        """Put eigenvalues and tests into a point."""
        u, m = point.u, len(self.system)
        omega = self.omega(u)
        jacobian = matrix[:m, :m]
        point.facts = AtRest(eigenvalues(jacobian))
        point.tests = {**bounds(u), "Bogdanov-Takens": float(u[-3])}
        if m > 2:
            point.tests["zero-Hopf"] = determinant(jacobian) / (omega * omega)
        if float(u[-3]) > _SLOW:
            point.tests["generalised Hopf"] = first_lyapunov(self.system, self.z(u), self.p(u), omega)

    def adapted(self, point: Point) -> Point:
        """Return the point, against which the next one's phase is held."""
        m = len(self.system)
        self._q = point.u[m : 3 * m].copy()
        return point
