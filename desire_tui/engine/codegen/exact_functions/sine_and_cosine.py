"""sin and cos of many numbers, with the bits of glibc's.

Arguments are reduced by multiples of π/2 to |r| ≤ π/4 as pairs of doubles (Cody and Waite, fused), both
functions are Taylor sums whose first terms are pairs: within 2⁻⁶² of the value. glibc (2.28 and later) adds
one correction of at most 2⁻⁸ to an entry of a table of sines at multiples of 1/128 (Gal and Bachelis 1991);
the roundings in that correction amount to less than 3.6·2⁻⁶². Where the result is below 1/8, glibc says
0.501 units of the last place.
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.constants import half_pi
from desire_tui.engine.codegen.exact_functions.pairs import Pair, Pairs, split
from desire_tui.engine.codegen.exact_functions.rounding_test import rounded

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_MOST = 2.0**20
"""Larger arguments are the library's: reduction by three doubles is exact enough up to here."""
_LEAST = 2.0**-20
"""So near to a multiple of π/2 the reduced argument loses too many bits."""
_MAGIC = 1.5 * 2.0**52
"""Added and taken away: rounds to a whole number, whose last bits it shows."""
_BAND = 1.25 * 2.0**-60
_SMALL, _RELATIVE = 0.125, 2.0**-60


def _term(n: int) -> Fraction:
    """Return a coefficient of Taylor's series: ±1/n!."""
    return Fraction((-1) ** (n // 2), factorial(n))


def sine(pairs: Pairs, r: Pair, square: Pair) -> Pair:
    """Return sin r for |r| ≤ π/4."""
    lanes = pairs.lanes
    rest = lanes.mul(square.high, pairs.polynomial(square.high, [_term(n) for n in range(5, 18, 2)]))
    factor = pairs.by(square, pairs.constant_plus(_term(3), rest))
    change = pairs.by(r, factor)
    total = pairs.sum(r.high, change.high)
    return Pair(total.high, lanes.add(total.low, lanes.add(change.low, r.low)))


def cosine(pairs: Pairs, square: Pair) -> Pair:
    """Return cos r for |r| ≤ π/4."""
    lanes = pairs.lanes
    rest = lanes.mul(square.high, pairs.polynomial(square.high, [_term(n) for n in range(6, 19, 2)]))
    inner = pairs.by(square, pairs.constant_plus(_term(4), rest))
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
        near = lanes.compare("olt", lanes.intrinsic("fabs", reduced.high), lanes.const(_LEAST))
        turned = lanes.compare("ogt", turns, lanes.const(0.0))
        near = text.op(f"and {lanes.flags} {near}, {turned}")
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
