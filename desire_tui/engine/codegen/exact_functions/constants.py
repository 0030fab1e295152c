"""π/2 and logarithms as rational numbers, to 200 bits: enough for three doubles and what they leave."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt

_BITS = 240


def _series(first: Fraction, ratio: Fraction) -> Fraction:
    """Return Σ first·ratioᵏ/(2k + 1)."""
    total, term, k = Fraction(0), first, 0
    while abs(term) > Fraction(1, 2**_BITS):
        total += term / (2 * k + 1)
        term, k = term * ratio, k + 1
    return total


def half_pi() -> Fraction:
    """Return π/2 by Machin's formula: π/4 = 4·arctan(1/5) - arctan(1/239)."""
    fifth, other = Fraction(1, 5), Fraction(1, 239)
    return 2 * (4 * _series(fifth, -(fifth**2)) - _series(other, -(other**2)))


def ln_2() -> Fraction:
    """Return ln 2."""
    return logarithm_of(Fraction(2))


def logarithm_of(x: Fraction) -> Fraction:
    """Return ln x = 2·artanh((x - 1)/(x + 1)), for x near 1: between a half and 2."""
    part = (x - 1) / (x + 1)
    return 2 * _series(part, part**2)


def powers_of_two(bits: int) -> list[Fraction]:
    """Return 2^(n/N) for n from 0 to N - 1, N = 2^bits."""
    unit = 1 << _BITS
    step = 2 * unit
    for _ in range(bits):
        step = isqrt(step * unit)
    powers = [unit]
    for _ in range((1 << bits) - 1):
        powers.append(powers[-1] * step >> _BITS)
    return [Fraction(power, unit) for power in powers]
