"""The multiples of π/16 below π: π/16 itself, their sines and cosines."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

from desire_tui.engine.codegen.exact_functions.constants import half_pi
from desire_tui.engine.codegen.exact_functions.pairs import split

_BITS = 160
_SECOND_BITS = 33


@cache
def sines_and_cosines() -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return sine and cosine of kπ/16 for k from 0 to 15, as pairs of doubles."""
    unit = 2**_BITS
    quarter = []
    for k in range(5):
        x = round(k * half_pi() / 8 * unit)
        sine, cosine = (split(Fraction(_taylor(x, *first), unit)) for first in ((x, 1), (unit, 0)))
        quarter.append((sine, cosine))
    quarter += [(cosine, sine) for sine, cosine in quarter[3::-1]]
    return [*quarter, *((sine, (-high, -low)) for sine, (high, low) in quarter[7:0:-1])]


def _taylor(x: int, term: int, n: int) -> int:
    """Return the sum that begins with a term of degree n, in whole numbers."""
    total = 0
    while abs(term) > 1:
        total += term
        term = -((term * x >> _BITS) * x >> _BITS) // ((n + 1) * (n + 2))
        n += 2
    return total


def step() -> tuple[float, float, float]:
    """Return π/16 as three doubles. Products of the second with whole numbers up to 2²⁰ are doubles."""
    whole = half_pi() / 8
    first = float(whole)
    left = whole - Fraction(first)
    unit = 2 ** (left.denominator.bit_length() - abs(left.numerator).bit_length() + _SECOND_BITS - 1)
    second = Fraction(round(left * unit), unit)
    return first, float(second), float(left - second)
