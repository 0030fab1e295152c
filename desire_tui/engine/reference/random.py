"""Random draws of one statement, in the order that language.md 4.1 fixes.

A statement over an array draws for the last element first; within an element draws go from left to right.
"""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.random_sequence import INCREMENT, MASK, MULTIPLIER, RADIUS_FACTOR, SCALE, TWO_PI

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Sequence:
    """The 48-bit linear congruential sequence; its state is `Values.random`."""

    def __init__(self, state: NDArray[np.uint64]) -> None:
        self.state = state

    def uniform(self) -> float:
        """Return the next u, 0 ≤ u < 1."""
        x = (int(self.state[0]) * MULTIPLIER + INCREMENT) & MASK
        self.state[0] = x
        return x * SCALE

    def block(self, count: int) -> Array:
        """Return the next `count` numbers u."""
        if not count:
            return np.empty(0)
        factors, summands = _jumps(1 << (count - 1).bit_length())
        drawn = (factors[:count] * self.state[0] + summands[:count]) & np.uint64(MASK)
        self.state[0] = drawn[-1]
        numbers: Array = drawn * SCALE
        return numbers


@cache
def _jumps(count: int) -> tuple[NDArray[np.uint64], NDArray[np.uint64]]:
    """Return a, c so that k + 1 steps are X ← (a[k]·X + c[k]) mod 2⁴⁸; `count` is a power of 2.

    Whole numbers of 64 bits count modulo 2⁶⁴, which leaves the lower 48 bits as they should be.
    """
    factors, summands = np.array([MULTIPLIER], np.uint64), np.array([INCREMENT], np.uint64)
    while len(factors) < count:
        summands = np.concatenate([summands, factors * summands[-1] + summands])
        factors = np.concatenate([factors, factors * factors[-1]])
    return factors, summands


def normal(u1: float, u2: float) -> float:
    """Return sqrt(-2 ln u1)·cos(2π u2) (Box and Muller)."""
    radius = math.sqrt(RADIUS_FACTOR * math.log(u1)) if u1 > 0.0 else math.inf
    return radius * math.cos(TWO_PI * u2)


class ElementDraws:
    """What a statement over `count` elements draws: elements × draws, filled before it is evaluated."""

    def __init__(self, sequence: Sequence, count: int) -> None:
        self.sequence = sequence
        self.count = count
        self.width = 0
        self.table: Array = np.empty((count, 0))

    def reserve(self, count: int) -> int:
        """Return the column of the next `count` draws of each element."""
        column = self.width
        self.width += count
        return column

    def fill(self) -> None:
        """Draw for all elements, the last one first."""
        if self.width:
            self.table = self.sequence.block(self.count * self.width).reshape(self.count, self.width)[::-1]

    def uniform(self, column: int) -> Array:
        """Return `ran()` of each element."""
        return 2.0 * self.table[:, column] - 1.0

    def normal(self, column: int) -> Array:
        """Return `gauss(0)` of each element."""
        with np.errstate(divide="ignore", invalid="ignore"):
            radius = np.sqrt(RADIUS_FACTOR * np.log(self.table[:, column]))
            return np.asarray(radius * np.cos(TWO_PI * self.table[:, column + 1]), dtype=np.float64)
