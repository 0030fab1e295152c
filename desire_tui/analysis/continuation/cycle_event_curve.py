"""Folds of cycles and period doublings over two parameters.

The equations of a cycle and one more, which is 0 where the matrix of its disturbances is singular: the last
unknown of that matrix bordered by a row and a column (W. Govaerts, Numerical Methods for Bifurcations of
Dynamical Equilibria, 2000; Yu. A. Kuznetsov, W. Govaerts, E. J. Doedel, A. Dhooge, Numerical periodic
normalization for codim 1 bifurcations of limit cycles, SIAM J. Numer. Anal. 43, 2005).
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from desire_tui.analysis.continuation.collocation import DEGREE, basis, local
from desire_tui.analysis.continuation.cycle_curve import CycleCurve
from desire_tui.analysis.continuation.fold_curve import TwoParameters, bounds
from desire_tui.analysis.continuation.multipliers import product
from desire_tui.analysis.continuation.null_vectors import null_vectors
from desire_tui.analysis.equilibria.flow import central

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.continuation.null_vectors import NullVectors
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

CycleEvent = Literal["fold of cycles", "period doubling"]

_STEP = 1e-3
_ROUNDS = 4


class CycleEventCurve(CycleCurve):
    """Cycles, one of whose multipliers is 1 (a second time) or -1; unknowns as of cycles, and two parts.

    Of a fold the matrix is that of the cycle's own equations by z and log T; of a period doubling that of
    its disturbances, which come back with the other sign. cusp of cycles: w·D²F[v, v] is 0.
    """

    ends: ClassVar[tuple[str, ...]] = TwoParameters.ends
    noise: ClassVar[dict[str, float]] = {}

    def __init__(
        self, system: System, over: tuple[Range, Range], mesh: Floats, nodes: Floats, event: CycleEvent
    ) -> None:
        """`nodes` on `mesh` is a cycle with the event, or near to one."""
        super().__init__(system, over[0], mesh, nodes, more=over[1:])
        self.event = event
        self._border: tuple[Floats, Floats] | None = None

    def border(self, u: Floats) -> None:
        """Choose row and column anew, by inverse iteration at a cycle with the event."""
        matrix = self._disturbances(u)
        random = np.random.default_rng(5)
        column, row = random.normal(size=(2, matrix.shape[0]))
        if self._border is not None and len(self._border[0]) == len(column):
            column, row = self._border
        for _ in range(_ROUNDS):
            found = null_vectors(matrix, column, row)
            column, row = found.left / np.linalg.norm(found.left), found.right / np.linalg.norm(found.right)
        self._border = column, row

    def _disturbances(self, u: Floats) -> Any:
        """Return the matrix that is singular where the event is, as a sparse array."""
        matrix, last = super().matrix(u), self.last(u)
        if self.event == "fold of cycles":
            return matrix[:, : last + 1]
        m = len(self.system)
        back = matrix[:last, :last].tolil()
        back[last - m :, :m] = np.eye(m)
        return back.tocsc()

    def _vectors(self, u: Floats) -> NullVectors:
        if self._border is None:
            self.border(u)
        assert self._border is not None
        return null_vectors(self._disturbances(u), *self._border)

    def residual(self, u: Floats) -> Floats:
        """Return the equations of the cycle and that of the event."""
        value = super().residual(u)
        if not np.all(np.isfinite(value)):
            return np.append(value, np.nan)
        try:
            return np.append(value, self._vectors(u).value)
        except np.linalg.LinAlgError:
            return np.append(value, np.nan)

    def matrix(self, u: Floats) -> Any:
        """Return all derivatives as a sparse array."""
        from scipy.sparse import csc_array, vstack

        return csc_array(vstack([super().matrix(u), csc_array(self._slope(u)[0][None, :])]))

    def _slope(self, u: Floats) -> tuple[Floats, Floats]:
        """Return the derivatives of the event's equation, -w·(∂A/∂u) v, and v as a direction of u."""
        found = self._vectors(u)
        last, p, form = self.last(u), self.p(u), basis()
        blocks, z, pushed = self.blocks(u)
        count, m = len(blocks), z.shape[2]
        period = float(np.exp(u[last]))
        direction = np.zeros(len(u))
        direction[: len(found.right)] = found.right
        along_period = float(direction[last])
        v = np.einsum("ij,kjn->kin", form.values, local(self.nodes(direction)))
        w = found.left[: count * DEGREE * m].reshape(v.shape)
        places, moves = z.reshape(-1, m), v.reshape(-1, m)
        step = _STEP / max(float(np.abs(moves).max()), 1e-300)
        matrices = self.system.jacobians(places, p)
        turned = central(lambda h: self.system.jacobians(places + h * moves, p), step)
        by_z = period * (turned + along_period * matrices)
        rows = np.einsum("ga,gab->gb", w.reshape(-1, m), by_z).reshape(v.shape)
        slope = np.zeros(len(u))
        parts = np.einsum("ij,kib->kjb", form.values, rows)
        nodes = slope[:last].reshape(-1, m)
        for j in range(DEGREE + 1):
            nodes[j : j + DEGREE * count : DEGREE] += parts[:, j]
        pushed_on = period * np.einsum("gab,gb->ga", matrices, moves).reshape(v.shape)
        slope[last] = float(np.sum(w * (pushed_on + along_period * pushed)))
        by_parts = self.by_parts(u, z)
        for number, one in enumerate(self.ranges):
            turned = central(partial(self._moved, places, moves, p, one), _STEP)
            total = period * turned.reshape(v.shape) + along_period * by_parts[number]
            slope[last + 1 + number] = float(np.sum(w * total))
        return slope, direction

    def _moved(self, places: Floats, moves: Floats, p: dict[str, float], one: Range, part: float) -> Floats:
        """Return (∂g/∂z) v at places, with a parameter moved by a part of its range."""
        matrices = self.system.jacobians(places, {**p, one.name: p[one.name] + part * one.width})
        return np.asarray(np.einsum("gab,gb->ga", matrices, moves))

    def examine(self, point: Point, matrix: Any) -> None:
        """Put the cycle and tests into a point."""
        del matrix
        u = point.u
        point.facts = self.cycle(u)
        point.tests = bounds(u)
        found = point.facts.multipliers
        critical = 1.0 if self.event == "fold of cycles" else -1.0
        nearest = int(np.argmin(np.abs(found.others - critical)))
        rest = np.asarray(np.delete(found.others, nearest), dtype=np.complex128)
        if self.event == "fold of cycles":
            slope, direction = self._slope(u)
            point.tests["cusp of cycles"] = float(slope @ direction)
        if found.is_exact and len(rest):
            point.tests["fold-flip"] = product(rest + critical)
            point.tests["1:1 resonance" if critical > 0 else "1:2 resonance"] = product(rest - critical)

    def adapted(self, point: Point) -> Point:
        """Return the point, perhaps on another mesh; row and column are chosen anew."""
        point = super().adapted(point)
        self.border(point.u)
        return point
