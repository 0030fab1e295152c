"""Derivatives of functions that are known by their values only."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

STEP = 1e-5
"""In parts of a quantity's size: rounding is then 1e-11 of the derivative, and what bends over a hundredth
of the size is followed as exactly by the difference of fourth order."""


def derivative(function: Callable[[float], Floats], at: float, size: float) -> Floats:
    """Return the derivative of a function by central differences, extrapolated once (Richardson 1911)."""
    step = STEP * size
    wide, narrow = ((function(at + h) - function(at - h)) / ((at + h) - (at - h)) for h in (step, 0.5 * step))
    return (4.0 * narrow - wide) / 3.0
