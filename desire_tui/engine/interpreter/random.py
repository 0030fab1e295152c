"""The random numbers of scripts: the same sequence that compiled code goes on with (language.md 4.1)."""

from __future__ import annotations

from math import cos, log, sqrt
from typing import TYPE_CHECKING

from desire_tui.engine.random_sequence import INCREMENT, MASK, MULTIPLIER, RADIUS_FACTOR, SCALE, TWO_PI

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray


class Noise:
    """Draws from `state[0]`, the 48-bit state that `Values.random` holds."""

    def __init__(self, state: NDArray[np.uint64]) -> None:
        self.uniform, self.normal = _drawers(memoryview(state))  # type: ignore[arg-type]  # integers, as numpy does not say


def _drawers(state: memoryview[int]) -> tuple[Callable[[], float], Callable[[], float]]:
    def uniform() -> float:
        """Uniform in (−1, 1)."""
        state[0] = x = (MULTIPLIER * state[0] + INCREMENT) & MASK
        return 2.0 * (x * SCALE) - 1.0

    def normal() -> float:
        """Box and Muller's cosine branch; the radius is drawn first."""
        state[0] = x = (MULTIPLIER * state[0] + INCREMENT) & MASK
        state[0] = y = (MULTIPLIER * x + INCREMENT) & MASK
        return sqrt(RADIUS_FACTOR * log(x * SCALE)) * cos(TWO_PI * (y * SCALE))

    return uniform, normal
