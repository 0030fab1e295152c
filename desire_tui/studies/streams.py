"""A stream of random numbers for each run, from the study's seed and the run's number alone.

Run 0 draws as the program itself does behind `SEED seed` (without a seed: behind its own SEED). The streams
of the others begin at places of the sequence that splitmix64 (Steele, Lea, Flood, 2014) takes from both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.random_sequence import BITS, seeded

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15
_FACTORS = 0xBF58476D1CE4E5B9, 0x94D049BB133111EB


def stream(state: int, number: int) -> int:
    """Return where the random numbers of a run begin if those of run 0 begin at `state`."""
    return state if number == 0 else _mixed(_mixed(state) + number * _GOLDEN) >> 64 - BITS


def streams(state: int, first: int, count: int) -> NDArray[np.uint64]:
    """Return `stream` of `count` runs from `first` on."""
    numbers = np.arange(first, first + count, dtype=np.uint64)
    z = np.uint64(_mixed(state)) + numbers * np.uint64(_GOLDEN) + np.uint64(_GOLDEN)  # all modulo 2⁶⁴
    for shift, factor in ((30, _FACTORS[0]), (27, _FACTORS[1])):
        z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
    found = (z ^ (z >> np.uint64(31))) >> np.uint64(64 - BITS)
    return np.where(numbers == 0, np.uint64(state), found)


def first_state(seed: int | None, own: int) -> int:
    """Return where run 0 begins: at the seed, or without one where the program itself does."""
    return own if seed is None else seeded(seed)


def _mixed(z: int) -> int:
    z = (z + _GOLDEN) & _MASK
    z = (z ^ z >> 30) * _FACTORS[0] & _MASK
    z = (z ^ z >> 27) * _FACTORS[1] & _MASK
    return z ^ z >> 31
