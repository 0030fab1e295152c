"""sin and cos of many numbers, with the bits of glibc's.

Arguments are reduced by multiples of π/2 to |r| ≤ π/4 as pairs of doubles (Cody and Waite, fused), both
functions are Taylor sums whose first terms are pairs. What is not a pair is the sum behind x³/6: its
roundings, 2⁻⁶⁰ and 2⁻⁶¹ at most, times r³ leave less than 2.2·2⁻⁶². glibc (2.28 and later) adds one
correction of at most 2⁻⁸ to an entry of a table of sines at multiples of 1/128 (Gal and Bachelis 1991); the
three or four roundings of half a unit in that correction amount to less than 3.6·2⁻⁶². Where the result is
below 1/8, glibc says 0.501 units of the last place.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import factorial
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.constants import half_pi
from desire_tui.engine.codegen.exact_functions.pairs import Pair, Pairs, split
from desire_tui.engine.codegen.exact_functions.rounding_test import rounded

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_MOST = 2.0**20
"""Larger arguments are the library's: reduction by three doubles is exact enough up to here."""
_LEAST = 2.0**-30
"""So near, for each multiple of π/2 taken away, the reduced argument loses too many bits."""
_MAGIC = 1.5 * 2.0**52
"""Added and taken away: rounds to a whole number, whose last bits it shows."""
_BAND = 1.5 * 2.0**-60
_SMALL, _RELATIVE = 0.125, 2.0**-60


def _term(n: int) -> Fraction:
    """Return a coefficient of Taylor's series: ±1/n!."""
    return Fraction((-1) ** (n // 2), factorial(n))


def _economized(terms: list[Fraction], most: Fraction) -> list[Fraction]:
    """Return a polynomial of one degree less, as near as can be for x in [0, most].

    The last term gives way to what Chebyshev's polynomial of its degree leaves of it (C. Lanczos 1938).
    """
    degree = len(terms) - 1
    before, now = [Fraction(1)], [Fraction(-1), 2 / most]  # T0, T1 of 2x/most - 1
    for _ in range(1, degree):
        doubled = [2 * a for a in (*(-c for c in now), Fraction(0))]
        for power, c in enumerate(now):
            doubled[power + 1] += 4 / most * c
        before, now = now, [a - b for a, b in zip(doubled, [*before, Fraction(0), Fraction(0)], strict=False)]
    part = terms[-1] / now[-1]
    return [term - part * c for term, c in zip(terms[:-1], now[:-1], strict=True)]


@cache
def _series(least: int) -> list[Fraction]:
    """Return Taylor's series from x⁵ or x⁶ on, in powers of x²: 2⁻⁶⁴ off."""
    return _economized([_term(n) for n in range(least, least + 13, 2)], (half_pi() / 2) ** 2)


def sine(pairs: Pairs, r: Pair, square: Pair) -> Pair:
    """Return sin r for |r| ≤ π/4."""
    lanes = pairs.lanes
    factor = pairs.by(square, pairs.series(square.high, _term(3), _series(5)))
    change = pairs.by(r, factor)
    total = pairs.sum(r.high, change.high)
    return Pair(total.high, lanes.add(total.low, lanes.add(change.low, r.low)))


def cosine(pairs: Pairs, square: Pair) -> Pair:
    """Return cos r for |r| ≤ π/4."""
    inner = pairs.by(square, pairs.series(square.high, _term(4), _series(6)))
    return pairs.constant_plus(Fraction(1), pairs.by(square, pairs.constant_plus(_term(2), inner)))


class SineAndCosine:
    """Both functions of the argument `%x`, as pairs."""

    def __init__(self, lanes: Lanes) -> None:
        self.lanes, self.pairs = lanes, Pairs(lanes)
        self._x = "%x"
        size = lanes.intrinsic("fabs", self._x)
        text, pairs = lanes.text, self.pairs
        shifted = pairs.fma(size, lanes.const(float(1 / half_pi())), lanes.const(_MAGIC))
        turns = lanes.sub(shifted, lanes.const(_MAGIC))
        self._quadrant = text.op(f"bitcast {lanes.kind} {shifted} to {lanes.integers}")
        reduced = self._reduce(size, lanes.neg(turns))
        square = pairs.product(reduced.high, reduced.high)
        doubled = lanes.add(reduced.high, reduced.high)
        square = Pair(square.high, pairs.fma(doubled, reduced.low, square.low))
        self._sine, self._cosine = sine(pairs, reduced, square), cosine(pairs, square)
        large = lanes.compare("ogt", size, lanes.const(_MOST))
        least = lanes.mul(turns, lanes.const(_LEAST))
        near = lanes.compare("olt", lanes.intrinsic("fabs", reduced.high), least)
        self._strange = text.op(f"or {lanes.flags} {large}, {near}")

    def _reduce(self, x: str, turns: str) -> Pair:
        """Return x + turns·π/2: the first product cancels without error."""
        lanes, pairs = self.lanes, self.pairs
        first, _ = split(half_pi())
        second, _ = split(half_pi() - Fraction(first))
        third = float(half_pi() - Fraction(first) - Fraction(second))
        near = pairs.fma(turns, lanes.const(first), x)
        by = pairs.product(turns, lanes.const(second))
        total = pairs.sum(near, by.high)
        return Pair(total.high, lanes.add(total.low, pairs.fma(turns, lanes.const(third), by.low)))

    def result(self, name: str) -> tuple[str, str]:
        """Return the values of `sin` or `cos` and the flags of those in doubt."""
        lanes, text = self.lanes, self.lanes.text
        quadrant = self._quadrant
        if name == "cos":
            quadrant = text.op(f"add {lanes.integers} {quadrant}, {lanes.integer(1)}")
        odd = text.op(f"trunc {lanes.integers} {quadrant} to {lanes.flags}")
        found = Pair(
            lanes.choose(odd, self._cosine.high, self._sine.high),
            lanes.choose(odd, self._cosine.low, self._sine.low),
        )
        size = lanes.intrinsic("fabs", found.high)
        small = lanes.compare("olt", size, lanes.const(_SMALL))
        band = lanes.choose(small, lanes.mul(size, lanes.const(_RELATIVE)), lanes.const(_BAND))
        value, doubt = rounded(lanes, found, band)
        doubt = text.op(f"or {lanes.flags} {doubt}, {self._strange}")
        half = text.op(f"and {lanes.integers} {quadrant}, {lanes.integer(2)}")
        sign = text.op(f"shl {lanes.integers} {half}, {lanes.integer(62)}")
        bits = text.op(f"bitcast {lanes.kind} {value} to {lanes.integers}")
        bits = text.op(f"xor {lanes.integers} {bits}, {sign}")
        if name == "sin":
            own = text.op(f"bitcast {lanes.kind} {self._x} to {lanes.integers}")
            own = text.op(f"and {lanes.integers} {own}, {lanes.integer(-(2**63))}")
            bits = text.op(f"xor {lanes.integers} {bits}, {own}")
        return text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}"), doubt
