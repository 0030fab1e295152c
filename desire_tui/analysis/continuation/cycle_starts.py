"""Where curves of cycles begin: at a Hopf point, at a period doubling, at a branch point of cycles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.collocation import DEGREE, node_times
from desire_tui.analysis.continuation.curve import Point, point_at, unit
from desire_tui.analysis.continuation.cycle_curve import CycleCurve
from desire_tui.analysis.continuation.lyapunov import critical_vector
from desire_tui.analysis.continuation.multipliers import propagators
from desire_tui.analysis.continuation.null_vectors import null_vectors

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve

    Floats = NDArray[np.float64]

_INTERVALS = 20
_SMALL = (0.02, 0.005, 0.1)
"""Amplitudes, in scaled coordinates, with which cycles at such points are tried."""
_ROUNDS, _SINGULAR = 3, 1e-4
"""How often null vectors are made better, and how large the least singular value may come out."""


def from_hopf(curve: EquilibriumCurve, u: Floats, omega: float) -> tuple[CycleCurve, Point] | None:
    """Return the curve of cycles that is born at a Hopf point, and its first cycle."""
    mesh = np.linspace(0.0, 1.0, _INTERVALS + 1)
    times = node_times(mesh)
    z, part = u[:-1], float(u[-1])
    q = critical_vector(curve.system.jacobian(z, curve.p(u)), omega)
    wave = np.real(np.exp(2j * np.pi * times)[:, None] * q)
    for amplitude in _SMALL:
        nodes = z + amplitude * wave
        cycles = CycleCurve(curve.system, curve.over, mesh, nodes)
        along = unit(cycles, np.append(wave.ravel(), [0.0, 0.0]))
        first = point_at(cycles, np.append(nodes.ravel(), [np.log(2.0 * np.pi / omega), part]), along)
        if first is not None and np.abs(first.u[-1] - part) < 0.1:
            return cycles, first
    return None


def from_branch_point(curve: CycleCurve, point: Point, sign: float) -> tuple[CycleCurve, Point] | None:
    """Return the curve of cycles that crosses another one here, and its first cycle on one side.

    Its direction is the null vector of the equations that is no tangent of the curve which is known.
    """
    across = _null_vector(curve, point)
    if across is None:
        return None
    for length in _SMALL:
        cycles = CycleCurve(curve.system, curve.over, curve.mesh, curve.nodes(point.u))
        along = sign * across
        first = point_at(cycles, point.u + length * along, along)
        if first is not None:
            return cycles, first
    return None


def _null_vector(curve: CycleCurve, point: Point) -> Floats | None:
    """Return the unit null vector across the tangent; None: there is none."""
    from scipy.sparse import csc_array, vstack

    matrix = vstack([curve.matrix(point.u), csc_array((point.tangent * curve.weights)[None, :])])
    column, row = np.random.default_rng(4).normal(size=(2, len(point.u)))
    try:
        for _ in range(_ROUNDS):
            found = null_vectors(matrix, column, row)
            column, row = found.left / np.linalg.norm(found.left), found.right / np.linalg.norm(found.right)
    except np.linalg.LinAlgError:
        return None
    return unit(curve, found.right) if abs(found.value) < _SINGULAR else None


def from_doubling(curve: CycleCurve, point: Point) -> tuple[CycleCurve, Point] | None:
    """Return the curve of cycles of twice the period that begins here, and its first cycle."""
    nodes, mesh = curve.nodes(point.u), curve.mesh
    blocks = curve.blocks(point.u)[0]
    values, vectors = np.linalg.eig(point.facts.multipliers.matrix)
    here = vectors[:, int(np.argmin(np.abs(values + 1.0)))].real
    wave = [here]
    for leads in propagators(blocks):
        wave += [leads[j] @ here for j in range(DEGREE)]
        here = wave[-1]
    once = np.array(wave) / np.abs(wave).max()
    twice = np.vstack([nodes, nodes[1:]])
    direction = np.vstack([once, -once[1:]])
    mesh = np.concatenate([0.5 * mesh, 0.5 + 0.5 * mesh[1:]])
    for amplitude in _SMALL:
        moved = twice + amplitude * direction
        cycles = CycleCurve(curve.system, curve.over, mesh, moved)
        along = unit(cycles, np.append(direction.ravel(), [0.0, 0.0]))
        u = np.append(moved.ravel(), [point.u[-2] + np.log(2.0), point.u[-1]])
        first = point_at(cycles, u, along)
        if first is not None:
            return cycles, first
    return None
