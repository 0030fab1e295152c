"""Curves given by N equations of N + 1 unknowns: one step along, by pseudo-arclength.

H. B. Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems (1977): the unknowns are
predicted along the tangent and corrected across it, so that the curve may turn back in any of them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_ITERATIONS = 10
_QUICK = 0.1
"""A step that is shorter than this part of the one before: the matrix is good enough."""
_EXACT = 1e-12
_ROUNDED = 1e-8
"""Steps as short as this that do not get shorter any more are rounding."""


@dataclass
class Point:
    """A point of a curve: N + 1 unknowns and the unit tangent there.

    `tests` are functions that change sign where something happens; `facts` what is known of it besides.
    """

    u: Floats
    tangent: Floats
    tests: dict[str, float] = field(default_factory=dict)
    facts: Any = None
    iterations: int = 0


class Curve(ABC):
    """N equations of N + 1 unknowns; scalar products are weighted."""

    weights: Floats
    ends: ClassVar[tuple[str, ...]] = ()
    """Tests at whose zeros the curve is left: positive inside."""
    noise: ClassVar[dict[str, float]] = {}
    """Tests that are smaller than this change their sign by rounding."""

    @abstractmethod
    def residual(self, u: Floats) -> Floats:
        """Return N numbers, 0 on the curve. They may be nan."""

    @abstractmethod
    def matrix(self, u: Floats) -> Any:
        """Return the derivatives, N by N + 1: a dense array or a sparse one."""

    @abstractmethod
    def examine(self, point: Point, matrix: Any) -> None:
        """Put tests and facts into a point."""

    def explains(self, here: Point, ahead: Point, zeros: Sequence[tuple[str, Point]]) -> bool:
        """Whether the zeros found in a step can be all: two of one test in a step leave no sign."""
        del here, ahead, zeros
        return True

    def adapted(self, point: Point) -> Point:
        """Return an accepted point as the next step is to begin at; the curve may change its mesh for it."""
        return point


def bordered(matrix: Any, row: Floats) -> Callable[[Floats], Floats]:
    """Return what solves N equations and one more, given by a row. LinAlgError: they are singular."""
    if isinstance(matrix, np.ndarray):
        square = np.vstack([matrix, row])
        return lambda right: np.asarray(np.linalg.solve(square, right))
    from scipy.sparse import csc_array, vstack
    from scipy.sparse.linalg import splu

    try:
        factors = splu(csc_array(vstack([matrix, csc_array(row[None, :])])))
    except RuntimeError as reason:  # SuperLU: the factor is exactly singular
        raise np.linalg.LinAlgError(str(reason)) from None
    return lambda right: np.asarray(factors.solve(right))


def tangent_at(curve: Curve, matrix: Any, along: Floats) -> Floats:
    """Return the unit tangent that points the way of another direction."""
    right = np.zeros(len(along))
    right[-1] = 1.0
    return unit(curve, bordered(matrix, along * curve.weights)(right))


def unit(curve: Curve, direction: Floats) -> Floats:
    """Return a direction with length 1 in the curve's measure."""
    return np.asarray(direction / np.sqrt(direction @ (curve.weights * direction)))


def corrected(curve: Curve, predicted: Floats, across: Floats) -> tuple[Floats, Any, int] | None:
    """Return the point of the curve in the plane across a direction, its matrix and the iterations.

    Newton's method; a matrix that is sparse, and so large, is used again while the steps shrink quickly.
    None: it does not converge.
    """
    u = predicted.copy()
    row = across * curve.weights
    before = np.inf
    solve = None
    for iteration in range(1, _ITERATIONS + 1):
        value = curve.residual(u)
        if not np.all(np.isfinite(value)):
            return None
        try:
            if solve is None:
                matrix = curve.matrix(u)
                solve = bordered(matrix, row)
            step = solve(np.append(-value, row @ (predicted - u)))
        except np.linalg.LinAlgError:
            return None
        length = float(np.sqrt(step @ (curve.weights * step)))
        if not length < max(4.0 * before, 1.0):  # nan too
            return None
        u = u + step
        size = 1.0 + float(np.sqrt(u @ (curve.weights * u)))
        if length < _EXACT * size or (length < _ROUNDED * size and length > 0.3 * before):
            return u, matrix if iteration == 1 else curve.matrix(u), iteration
        if isinstance(matrix, np.ndarray) or length > _QUICK * before:
            solve = None
        before = length
    return None


def advanced(curve: Curve, point: Point, length: float) -> Point | None:
    """Return the point a length further along. None: there is none to be found."""
    found = corrected(curve, point.u + length * point.tangent, point.tangent)
    if found is None:
        return None
    u, matrix, iterations = found
    try:
        tangent = tangent_at(curve, matrix, point.tangent)
    except np.linalg.LinAlgError:
        return None
    ahead = Point(u, tangent, iterations=iterations)
    curve.examine(ahead, matrix)
    return ahead


def point_at(curve: Curve, u: Floats, along: Floats) -> Point | None:
    """Return the curve's point near u, in the plane across a direction, with its tangent that way."""
    found = corrected(curve, u, along)
    if found is None:
        return None
    u, matrix, iterations = found
    try:
        tangent = tangent_at(curve, matrix, along)
    except np.linalg.LinAlgError:
        tangent = unit(curve, along)
    point = Point(u, tangent, iterations=iterations)
    curve.examine(point, matrix)
    return point
