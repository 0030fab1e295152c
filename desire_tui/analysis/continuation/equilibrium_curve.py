"""Steady states over a parameter, with the functions that are 0 at folds, branch points and Hopf points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from desire_tui.analysis.continuation.curve import Curve
from desire_tui.analysis.equilibria.kinds import eigenvalues, unstable_count
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]
    Complex = NDArray[np.complex128]

_LARGEST = 600.0
_ROUNDING = 1e-11
_ROUNDED = 1e-9


@dataclass(frozen=True)
class Range:
    """A parameter between two values, as a coordinate from 0 to 1."""

    name: str
    low: float
    high: float

    @property
    def width(self) -> float:
        """Return how far it goes."""
        return self.high - self.low

    def value(self, part: float) -> float:
        """Return the parameter at a place from 0 to 1."""
        return self.low if abs(part) < _ROUNDING else self.low + part * self.width

    def part(self, value: float) -> float:
        """Return the place of a value."""
        return (value - self.low) / self.width


@dataclass(frozen=True)
class AtRest:
    """What is known at a steady state."""

    eigenvalues: Complex

    @property
    def unstable(self) -> int:
        """In how many directions disturbances grow."""
        return unstable_count(self.eigenvalues)

    @property
    def is_clear(self) -> bool:
        """Whether no eigenvalue is so near to the imaginary axis that rounding decides its side."""
        sizes = np.abs(self.eigenvalues)
        return bool(np.abs(self.eigenvalues.real).min(initial=np.inf) > _ROUNDED * sizes.max(initial=0.0))


class EquilibriumCurve(Curve):
    """g(z; p) = 0 with the unknowns z (m) and the parameter's part of its range."""

    ends = ("low", "high")
    noise: ClassVar[dict[str, float]] = {"fold": 1e-6}

    def __init__(self, system: System, over: Range, mark: float | None = None) -> None:
        self.system, self.over, self.mark = system, over, mark
        self.weights = np.ones(len(system) + 1)

    def p(self, u: Floats) -> dict[str, float]:
        """Return the parameter at a point."""
        return {self.over.name: self.over.value(float(u[-1]))}

    def residual(self, u: Floats) -> Floats:
        """Return g, m numbers."""
        return self.system.rate(u[:-1], self.p(u))

    def matrix(self, u: Floats) -> Floats:
        """Return ∂g/∂z and ∂g/∂p, m by m + 1."""
        p = self.p(u)
        slope = self.system.by_parameter(u[:-1], p, self.over.name, self.over.width)
        return np.column_stack([self.system.jacobian(u[:-1], p), slope * self.over.width])

    def examine(self, point: Point, matrix: Any) -> None:
        """Put eigenvalues and tests into a point.

        fold: the tangent's part along the parameter; branch: the determinant with the tangent as last row
        (Keller); hopf: the product of all sums of two eigenvalues; at `mark`, the parameter has this part.
        """
        values = eigenvalues(matrix[:, :-1])
        point.facts = AtRest(values)
        point.tests = {
            "low": float(point.u[-1]),
            "high": 1.0 - float(point.u[-1]),
            "fold": float(point.tangent[-1]),
            "branch": determinant(np.vstack([matrix, point.tangent])),
            "hopf": pair_product(values),
        }
        if self.mark is not None:
            point.tests["mark"] = float(point.u[-1]) - self.mark

    def explains(self, here: Point, ahead: Point, zeros: Sequence[tuple[str, Point]]) -> bool:
        """Whether as many eigenvalues have passed the imaginary axis as the zeros tell."""
        if "fold" not in here.tests or not here.facts.is_clear or not ahead.facts.is_clear:
            return True
        alone = sum(name in ("fold", "branch") for name, _ in zeros)
        pairs = sum(
            name == "hopf" and turning_pair(place.facts.eigenvalues) is not None for name, place in zeros
        )
        change = abs(ahead.facts.unstable - here.facts.unstable)
        return bool(change <= alone + 2 * pairs and (change - alone) % 2 == 0)


def determinant(matrix: Floats) -> float:
    """Return a determinant, kept from overflow."""
    sign, logarithm = np.linalg.slogdet(matrix)
    return float(sign * np.exp(np.clip(logarithm, -_LARGEST, _LARGEST)))


def pair_product(values: Complex) -> float:
    """Return the product of all λ_i + λ_k, i < k, which is real. nan: there are none."""
    if len(values) < 2:
        return float("nan")
    first, second = np.triu_indices(len(values), 1)
    sums = values[first] + values[second]
    size = np.abs(sums)
    if np.any(size == 0.0):
        return 0.0
    sign = np.prod(sums / size).real
    return float(np.sign(sign) * np.exp(np.clip(np.log(size).sum(), -_LARGEST, _LARGEST)))


def turning_pair(values: Complex) -> tuple[int, float] | None:
    """Return index and imaginary part of the pair nearest to the imaginary axis, if its sum is about 0.

    None: what has the sum 0 are two real eigenvalues (a neutral saddle).
    """
    turning = np.flatnonzero(values.imag > 0.0)
    if not len(turning):
        return None
    nearest = int(turning[np.argmin(np.abs(values[turning].real))])
    omega = float(values[nearest].imag)
    if abs(values[nearest].real) > 1e-4 * max(omega, 1e-3 * float(np.abs(values).max())):
        return None
    return nearest, omega
