"""Limit cycles over a parameter: orthogonal collocation at Gauss points.

E. J. Doedel, AUTO: a program for the automatic bifurcation analysis of autonomous systems (1981).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from desire_tui.analysis.continuation.collocation import (
    DEGREE,
    adapted_mesh,
    basis,
    error_estimate,
    interpolated,
    local,
    node_times,
)
from desire_tui.analysis.continuation.curve import Curve, Point, unit
from desire_tui.analysis.continuation.multipliers import Multipliers, multipliers, tests_of
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_ACCURATE = 1e-6
_INTERVALS_MOST = 200
_EVERY = 3
"""The mesh is chosen anew after so many points."""


@dataclass(frozen=True)
class Cycle:
    """A cycle: its mesh from 0 to 1, its states z at the nodes (m by nodes), its multipliers."""

    mesh: Floats
    nodes: Floats
    period: float
    multipliers: Multipliers

    @property
    def times(self) -> Floats:
        """Where the nodes stand, as parts of the period."""
        return node_times(self.mesh)

    @property
    def unstable(self) -> int:
        """In how many directions disturbances grow."""
        return self.multipliers.unstable


class CycleCurve(Curve):
    """dz/dτ = T g(z; p), z(1) = z(0); unknowns: z at nodes, log T, parameters as parts of their ranges."""

    ends: ClassVar[tuple[str, ...]] = ("low", "high")
    noise: ClassVar[dict[str, float]] = {"fold": 1e-6, "cycle branch": 1e-9}

    def __init__(
        self,
        system: System,
        over: Range,
        mesh: Floats,
        nodes: Floats,
        accuracy: float = _ACCURATE,
        more: tuple[Range, ...] = (),
    ) -> None:
        """`nodes` (N DEGREE + 1 by m) on `mesh` (N + 1) is the cycle against which phases are counted.

        `more`: further parameters; each needs one equation more.
        """
        self.system, self.over, self._accuracy = system, over, accuracy
        self.ranges = (over, *more)
        self._since = 0
        self._known: tuple[Floats, Floats, tuple[Floats, Floats, Floats]] | None = None
        """Mesh, unknowns and derivatives that were computed last."""
        self._use(mesh, nodes)

    def _use(self, mesh: Floats, nodes: Floats) -> None:
        self.mesh = mesh
        steps = np.diff(mesh)
        form = basis()
        slopes = np.einsum("ij,kjn->kin", form.slopes, local(nodes))
        self._phase = np.einsum("i,ij,kin->kjn", form.weights, form.values, slopes)
        """Weights of nodes, interval by interval, in ∫ z · dz0/dτ dτ."""
        shares = np.zeros(len(nodes))
        np.add.at(shares, DEGREE * np.arange(len(steps))[:, None] + np.arange(DEGREE + 1),
                  steps[:, None] * np.abs(np.einsum("i,ij->j", form.weights, form.values)))  # fmt: skip
        of_nodes = np.repeat(shares / shares.sum(), nodes.shape[1])
        self.weights = np.append(of_nodes, np.ones(1 + len(self.ranges)))
        self._reference = float(np.sum(self._phase * local(nodes)))

    def nodes(self, u: Floats) -> Floats:
        """Return z at the nodes, a row each."""
        return u[: self.last(u)].reshape(-1, len(self.system))

    def last(self, u: Floats) -> int:
        """Return the place of log T, behind the nodes'."""
        return len(u) - 1 - len(self.ranges)

    def p(self, u: Floats) -> dict[str, float]:
        """Return the parameters at a point."""
        parts = u[-len(self.ranges) :].tolist()
        return {one.name: one.value(part) for one, part in zip(self.ranges, parts, strict=True)}

    def _at_gauss(self, u: Floats) -> tuple[Floats, Floats]:
        """Return z at the Gauss points, N by DEGREE by m, and T g there."""
        z = np.einsum("ij,kjn->kin", basis().values, local(self.nodes(u)))
        rates = self.system.rate(np.ascontiguousarray(z.reshape(-1, z.shape[2]).T), self.p(u))
        return z, np.exp(u[self.last(u)]) * rates.T.reshape(z.shape)

    def residual(self, u: Floats) -> Floats:
        """Return the equations of collocation, of periodicity and of the phase."""
        nodes = self.nodes(u)
        _, pushed = self._at_gauss(u)
        steps = np.diff(self.mesh)[:, None, None]
        slopes = np.einsum("ij,kjn->kin", basis().slopes, local(nodes)) / steps
        phase = float(np.sum(self._phase * local(nodes))) - self._reference
        return np.concatenate([(slopes - pushed).ravel(), nodes[-1] - nodes[0], [phase]])

    def blocks(self, u: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the collocation's derivatives, N by DEGREE by m by DEGREE + 1 by m, and z and T g."""
        if self._known is not None and self._known[0] is self.mesh and np.array_equal(self._known[1], u):
            return self._known[2]
        z, pushed = self._at_gauss(u)
        p, period = self.p(u), np.exp(u[self.last(u)])
        m = z.shape[2]
        matrices = self.system.jacobians(z.reshape(-1, m), p).reshape(*z.shape, m)
        form = basis()
        turning = form.slopes[None] / np.diff(self.mesh)[:, None, None]
        blocks = np.einsum("kij,ab->kiajb", turning, np.eye(m))
        blocks -= period * np.einsum("ij,kiab->kiajb", form.values, matrices)
        self._known = (self.mesh, u.copy(), (blocks, z, pushed))
        return blocks, z, pushed

    def matrix(self, u: Floats) -> Any:
        """Return all derivatives as a sparse array."""
        from scipy.sparse import csc_array

        blocks, z, pushed = self.blocks(u)
        count, m = len(blocks), z.shape[2]
        rows_of = np.arange(count * DEGREE * m).reshape(count, DEGREE, m)
        nodes_of = DEGREE * np.arange(count)[:, None] + np.arange(DEGREE + 1)
        columns_of = nodes_of[..., None] * m + np.arange(m)
        rows = np.broadcast_to(rows_of[:, :, :, None, None], blocks.shape)
        columns = np.broadcast_to(columns_of[:, None, None], blocks.shape)
        body, last = count * DEGREE * m, self.last(u)
        ring, inner = np.arange(m), np.arange(body)
        parts = [
            (rows, columns, blocks),
            (inner, np.full(body, last), -pushed),
            (body + ring, last - m + ring, np.ones(m)),
            (body + ring, ring, -np.ones(m)),
            (np.full(columns_of.shape, body + m), columns_of, self._phase),
        ]
        for number, slope in enumerate(self.by_parts(u, z), 1):
            parts.append((inner, np.full(body, last + number), -slope.ravel()))
        r, c, v = (np.concatenate([np.ravel(part[k]) for part in parts]) for k in range(3))
        return csc_array((v, (r, c)), shape=(body + m + 1, len(u)))

    def by_parts(self, u: Floats, z: Floats) -> list[Floats]:
        """Return the derivatives of T g at the Gauss points z by the parts of the parameters."""
        places, p = np.ascontiguousarray(z.reshape(-1, z.shape[2]).T), self.p(u)
        period = np.exp(u[self.last(u)])
        slopes = [self.system.by_parameter(places, p, one.name, one.width) * one.width for one in self.ranges]
        return [period * slope.T.reshape(z.shape) for slope in slopes]

    def examine(self, point: Point, matrix: Any) -> None:
        """Put the multipliers, the cycle and the tests into a point."""
        del matrix
        u = point.u
        point.facts = self.cycle(u)
        found = point.facts.multipliers
        along = float(point.tangent[-1])
        part = float(u[-1])
        point.tests = {"low": part, "high": 1.0 - part, "fold": along, **tests_of(found, along)}

    def cycle(self, u: Floats) -> Cycle:
        """Return what is known of the cycle at a point."""
        period = float(np.exp(u[self.last(u)]))
        return Cycle(self.mesh, self.nodes(u).T, period, multipliers(self.blocks(u)[0]))

    def adapted(self, point: Point) -> Point:
        """Return a point, now and then on a mesh that suits it better, of more intervals if need be."""
        nodes = self.nodes(point.u)
        self._since += 1
        error = error_estimate(self.mesh, nodes)
        if self._since % _EVERY and error < self._accuracy:
            self._use(self.mesh, nodes)
            return point
        count = len(self.mesh) - 1
        if error > self._accuracy and count < _INTERVALS_MOST:
            needed = int(count * (error / self._accuracy) ** (1.0 / (DEGREE + 1)))
            count = min(_INTERVALS_MOST, max(count + 4, needed))
        mesh = adapted_mesh(self.mesh, nodes, count)
        times, last = node_times(mesh), self.last(point.u)
        moved = interpolated(self.mesh, nodes, times)
        u = np.append(moved.ravel(), point.u[last:])
        direction = interpolated(self.mesh, self.nodes(point.tangent), times)
        tangent = np.append(direction.ravel(), point.tangent[last:])
        self._use(mesh, moved)
        return Point(u, unit(self, tangent), point.tests, point.facts, point.iterations)
