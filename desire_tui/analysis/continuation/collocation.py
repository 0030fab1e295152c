"""Functions of one period as piecewise polynomials, and the mesh on which they live.

C. de Boor and B. Swartz, Collocation at Gaussian points (1973); the mesh is chosen as R. D. Russell
and J. Christiansen have it, Adaptive mesh selection strategies (1978), and AUTO.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

DEGREE = 4


class Basis(NamedTuple):
    """Lagrange's polynomials over equidistant nodes of an interval [0, 1], at the Gauss points."""

    values: Floats
    """DEGREE by DEGREE + 1: row i holds the polynomials at Gauss point i."""
    slopes: Floats
    weights: Floats
    """Of Gauss' quadrature."""
    points: Floats


@cache
def basis() -> Basis:
    """Return the polynomials at the Gauss points."""
    points, weights = np.polynomial.legendre.leggauss(DEGREE)
    places = 0.5 * (points + 1.0)
    return Basis(lagrange(places), _slopes(places), 0.5 * weights, places)


def _coefficients() -> Floats:
    """Return the polynomials' coefficients, a column each, from the constant up."""
    nodes = np.arange(DEGREE + 1) / DEGREE
    return np.asarray(np.linalg.inv(np.vander(nodes, increasing=True)), dtype=np.float64)


def lagrange(places: Floats) -> Floats:
    """Return the polynomials at places of the interval, a row for each place."""
    return np.asarray(np.vander(places, DEGREE + 1, increasing=True) @ _coefficients())


def _slopes(places: Floats) -> Floats:
    powers = np.vander(places, DEGREE, increasing=True) * np.arange(1, DEGREE + 1)
    return np.asarray(powers @ _coefficients()[1:])


def local(nodes: Floats) -> Floats:
    """Return the values at the nodes of each interval, N by DEGREE + 1 by n, from N DEGREE + 1 by n."""
    count = (len(nodes) - 1) // DEGREE
    index = DEGREE * np.arange(count)[:, None] + np.arange(DEGREE + 1)
    return np.asarray(nodes[index])


def node_times(mesh: Floats) -> Floats:
    """Return where all nodes stand: N DEGREE + 1 numbers from 0 to 1."""
    inner = mesh[:-1, None] + np.diff(mesh)[:, None] * (np.arange(DEGREE) / DEGREE)
    return np.append(inner.ravel(), mesh[-1])


def interpolated(mesh: Floats, nodes: Floats, times: Floats) -> Floats:
    """Return a function's values at times from 0 to 1, a row each."""
    interval = np.clip(np.searchsorted(mesh, times, side="right") - 1, 0, len(mesh) - 2)
    places = (times - mesh[interval]) / np.diff(mesh)[interval]
    return np.asarray(np.einsum("kj,kjn->kn", lagrange(places), local(nodes)[interval]))


def monitor(mesh: Floats, nodes: Floats) -> Floats:
    """Return for each interval how fast the error grows there: the derivative of order DEGREE + 1, its root.

    That of order DEGREE is constant in an interval; the next is its difference to the neighbours.
    """
    steps = np.diff(mesh)
    signs = np.array([(-1.0) ** (DEGREE - j) * _binomial(j) for j in range(DEGREE + 1)])
    highest = np.einsum("j,kjn->kn", signs, local(nodes)) / (steps[:, None] / DEGREE) ** DEGREE
    before = np.roll(steps, 1)
    jumps = (highest - np.roll(highest, 1, axis=0)) / (0.5 * (steps + before))[:, None]
    size = 1.0 + np.abs(nodes).max(axis=0)
    next_order = 0.5 * (np.abs(jumps) + np.abs(np.roll(jumps, -1, axis=0))) / size
    return np.asarray(next_order.max(axis=1) ** (1.0 / (DEGREE + 1)))


def _binomial(j: int) -> float:
    from math import comb

    return float(comb(DEGREE, j))


def error_estimate(mesh: Floats, nodes: Floats) -> float:
    """Return about how large the error of the piecewise polynomial is, relative to its size."""
    return float(((np.diff(mesh) * monitor(mesh, nodes)) ** (DEGREE + 1)).max()) / (4.0**DEGREE * 24.0)


def adapted_mesh(mesh: Floats, nodes: Floats, count: int) -> Floats:
    """Return a mesh of so many intervals over which the error is spread evenly."""
    density = monitor(mesh, nodes)
    floor = 0.1 * float(np.average(density, weights=np.diff(mesh))) + 1e-12
    total = np.concatenate([[0.0], np.cumsum((density + floor) * np.diff(mesh))])
    found = np.interp(np.linspace(0.0, total[-1], count + 1), total, mesh)
    found[0], found[-1] = 0.0, 1.0
    return np.asarray(found)
