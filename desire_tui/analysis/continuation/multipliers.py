"""Floquet multipliers of a cycle, from the collocation equations, and what they tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Complex = NDArray[np.complex128]

_LARGEST = 600.0
_ON_CIRCLE = 1e-6
_BELIEVED = 1e-3


@dataclass(frozen=True)
class Multipliers:
    """Eigenvalues of the monodromy matrix; `others` are without the 1 that every cycle has.

    `error` is how far from 1 that one came out.
    """

    values: Complex
    others: Complex
    matrix: Floats
    error: float = 0.0

    @property
    def is_exact(self) -> bool:
        """Whether the others can be believed: next to a homoclinic orbit rounding may spoil them."""
        return self.error < _BELIEVED

    @property
    def unstable(self) -> int:
        """In how many directions disturbances grow."""
        return int(np.count_nonzero(np.abs(self.others) > 1.0 + _ON_CIRCLE))


def propagators(blocks: Floats) -> Floats:
    """Return for each interval what it makes of a disturbance at its beginning: N by DEGREE by m by m.

    `blocks` are those of `CycleCurve.blocks`. Entry [k, j] leads to node j + 1 of interval k.
    """
    count, degree, m = blocks.shape[:3]
    flat = blocks.reshape(count, degree * m, (degree + 1) * m)
    moved = -np.linalg.solve(flat[:, :, m:], flat[:, :, :m])
    return np.asarray(moved.reshape(count, degree, m, m), dtype=np.float64)


def multipliers(blocks: Floats) -> Multipliers:
    """Return a cycle's multipliers, the largest first."""
    m = blocks.shape[2]
    monodromy: Floats = np.eye(m)
    steps = propagators(blocks)[:, -1]
    for step in steps:
        monodromy = np.asarray(step @ monodromy)
    values = np.linalg.eigvals(monodromy).astype(np.complex128)
    values = values[np.lexsort((-values.imag, -np.abs(values)))]
    if m == 2:  # by Liouville's formula, exact however strong the attraction
        signs, logarithms = np.linalg.slogdet(steps)
        other = complex(np.prod(signs) * np.exp(np.clip(logarithms.sum(), -_LARGEST, _LARGEST)))
        pair = np.array([1.0, other]) if abs(other) <= 1.0 else np.array([other, 1.0])
        return Multipliers(pair.astype(np.complex128), np.array([other]), monodromy)
    one = int(np.argmin(np.abs(values - 1.0)))
    return Multipliers(values, np.delete(values, one), monodromy, float(abs(values[one] - 1.0)))


def tests_of(found: Multipliers, along: float) -> dict[str, float]:
    """Return functions that are 0 where a multiplier leaves the unit circle.

    `along` is the tangent's part along the parameter: where a multiplier passes 1 and the cycle does not turn
    back, another curve of cycles crosses.
    """
    others = found.others
    tests = {}
    if len(others):
        tests["period doubling"] = product(others + 1.0)
        tests["cycle branch"] = product(others - 1.0) * along
    if len(others) > 1:
        first, second = np.triu_indices(len(others), 1)
        tests["torus"] = product(others[first] * others[second] - 1.0)
    return tests


def product(values: Complex) -> float:
    """Return the real part of a product, without leaving the range of numbers."""
    size = np.abs(values)
    if np.any(size == 0.0):
        return 0.0
    sign = np.prod(values / size).real
    return float(np.sign(sign) * np.exp(np.clip(np.log(size).sum(), -_LARGEST, _LARGEST)))
