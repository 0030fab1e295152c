"""Sines and cosines of the multiples of 1/128 below 1."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

from desire_tui.engine.codegen.exact_functions.pairs import split

ROWS = 128
"""So many; one is 1/128 more than the one before."""
_BITS = 160


@cache
def sines_and_cosines() -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return sine and cosine of k/128 for k from 0 to 127, each as a double and what it lacks.

    Of glibc's 220 numbers for the latter 17 have another last digit, 2⁻¹⁰⁷ and less: of no result is it seen.
    """
    return [(_taylor(k, k * _ONE // ROWS, 1), _taylor(k, _ONE, 0)) for k in range(ROWS)]


_ONE = 2**_BITS


def _taylor(k: int, term: int, n: int) -> tuple[float, float]:
    """Return the sum at k/128 that begins with a term of degree n, in whole numbers."""
    x = k * _ONE // ROWS
    total = 0
    while abs(term) > 1:
        total += term
        term = -((term * x >> _BITS) * x >> _BITS) // ((n + 1) * (n + 2))
        n += 2
    return split(Fraction(total, _ONE))
