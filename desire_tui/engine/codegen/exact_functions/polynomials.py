"""Polynomials that are near to series over an interval."""

from __future__ import annotations

from fractions import Fraction


def economized(terms: list[Fraction], low: Fraction, high: Fraction) -> list[Fraction]:
    """Return a polynomial of one degree less, as near as can be for x in [low, high].

    Of each, the coefficients in rising powers. The last term gives way to what Chebyshev's polynomial of its
    degree leaves of it (C. Lanczos 1938).
    """
    degree = len(terms) - 1
    width = high - low
    shift, slope = -(low + high) / width, 2 / width
    before, now = [Fraction(1)], [shift, slope]  # T0, T1 of the x in [-1, 1] that stands for x
    for _ in range(1, degree):
        doubled = [2 * shift * c for c in (*now, Fraction(0))]
        for power, c in enumerate(now):
            doubled[power + 1] += 2 * slope * c
        before, now = now, [a - b for a, b in zip(doubled, [*before, Fraction(0), Fraction(0)], strict=False)]
    part = terms[-1] / now[-1]
    return [term - part * c for term, c in zip(terms[:-1], now[:-1], strict=True)]
