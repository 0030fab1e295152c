"""sin and cos of many numbers, with the bits of glibc's.

|x| = kπ/16 + r, |r| ≤ π/32, where r is a pair of doubles (Cody and Waite, fused). With the sine S and the
cosine C of the multiple, sin x = S·cos r + C·sin r is

    S + t + t·r²·P + S·r⁴·Q,  t = r·(C - S·r/2),  P = (sin r - r)/r³,  Q = (cos r - 1 + r²/2)/r⁴ + P/2

where only S + t is made without error; the rest is at most r³/6 < 2⁻¹²·⁵ (P. T. P. Tang, "Table-lookup
algorithms for elementary functions and their error analysis", 10th IEEE Symposium on Computer Arithmetic,
1991). cos x is the same with C for S and -S for C. What depends on what is as short as can be: runs wait for
the result.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from math import ceil, cos, factorial, log2, pi
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.exact_functions.angles import sines_and_cosines, step
from desire_tui.engine.codegen.exact_functions.constants import half_pi
from desire_tui.engine.codegen.exact_functions.lookups import SIZE, looked_up, second_of, two_in_one
from desire_tui.engine.codegen.exact_functions.pairs import Pair, Pairs
from desire_tui.engine.codegen.exact_functions.polynomials import economized
from desire_tui.engine.codegen.exact_functions.rounding_test import Result, beyond, rounded

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_MOST = 2.0**17
"""Larger arguments are the library's: of so many multiples two parts are taken away without error."""
_MAGIC = 1.5 * 2.0**52
"""Added and taken away: rounds to a whole number, whose last bits it shows."""
_OWN = 0.5 * 2.0**-62
"""Our error: three roundings in r³·P, and three of sums of at most 2⁻¹²·⁵."""
_LEFT_OUT = 0.0049
"""r²/2 at most: so much of what the double of S lacks is left out."""
_ONCE = 0.8
_RELATIVE = 1.4 * 2.0**-60
"""Of r where S is 0: three roundings in r³·P and two of sums; glibc says 0.501 units of the last place."""


def _band(angle: int, *, fused: bool) -> float:
    """Return how far from ours a number may be that glibc rounds to sin x, |x| being near angle·π/16.

    glibc (2.28 and later) adds a correction to an entry of a table of sines at multiples of 1/128 (Gal and
    Bachelis 1991). The correction is D·s with |s| ≤ 2⁻⁸ and D the derivative at that multiple. It is rounded
    twice, at most by 2⁻⁶² each and by less if it is smaller, or once if glibc was compiled with `fused`
    multiplication and addition; s once or, in what glibc does where D < 0.77, twice.
    """
    if not angle:
        return 0.0  # `_RELATIVE` holds
    slope = min(cos((angle - 0.5) * pi / SIZE) + 0.01, 1.0)
    most = 2.0 ** ceil(log2(slope))
    roundings = (1 if fused else 2) * most + (slope if slope > _ONCE else 2 * min(slope, 0.77))
    (_, lacks), _ = sines_and_cosines()[angle]
    return roundings * 2.0**-62 + _OWN + _LEFT_OUT * abs(lacks)


@cache
def _series() -> tuple[list[Fraction], list[Fraction]]:
    """Return P and 2·Q as polynomials in r²: 2⁻⁶⁹ and less off."""
    odd, even = ([Fraction((-1) ** (n // 2), factorial(n)) for n in range(k, k + 10, 2)] for k in (3, 4))
    both = [2 * a + b for a, b in zip(even, odd, strict=True)]
    none, most = Fraction(0), Fraction(1, 100)
    return economized(odd, none, most), economized(both, none, most)


class SineAndCosine:
    """Both functions of the argument `%x`."""

    def __init__(self, lanes: Lanes, *, fused: bool) -> None:
        """`fused`: the C library's were compiled with fused multiplication and addition."""
        self.lanes, self.pairs, self._fused = lanes, Pairs(lanes), fused
        pairs = self.pairs
        self._size = lanes.intrinsic("fabs", "%x")
        shifted = pairs.fma(self._size, lanes.const(float(8 / half_pi())), lanes.const(_MAGIC))
        self._index = lanes.text.op(f"bitcast {lanes.kind} {shifted} to {lanes.integers}")
        self._r = self._reduce(lanes.sub(shifted, lanes.const(_MAGIC)))
        self._sine, self._cosine = self._table()
        square = lanes.mul(self._r.high, self._r.high)
        fourth = lanes.mul(square, square)
        odd, even = (self._polynomial(square, fourth, series) for series in _series())
        self._square, self._odd, self._fourth, self._even = square, odd, fourth, even

    def _reduce(self, turns: str) -> Pair:
        """Return |x| - turns·π/16, all but the last product without error."""
        lanes, pairs = self.lanes, self.pairs
        first, second, third = (lanes.const(-part) for part in step())
        near = pairs.fma(turns, first, self._size)
        high = pairs.fma(turns, second, near)
        low = pairs.fma(turns, second, lanes.sub(near, high))
        return Pair(high, pairs.fma(turns, third, low))

    def _table(self) -> tuple[_Entry, _Entry]:
        """Look up sine and cosine of the multiple."""
        lanes = self.lanes
        values = sines_and_cosines()
        halves = [[pair[part][0] / 2 for pair in values] for part in (0, 1)]
        lows = [two_in_one(sine[1], cosine[1]) for sine, cosine in values]
        by_angle = [_band(angle, fused=self._fused) for angle in range(SIZE // 2 + 1)]
        bands = [two_in_one(by_angle[abs(SIZE // 2 - k)], by_angle[min(k, SIZE - k)]) for k in range(SIZE)]
        sine, cosine, low, band = looked_up(lanes, self._index, [*halves, lows, bands])
        return _Entry(sine, low, second_of(lanes, band)), _Entry(cosine, second_of(lanes, low), band)

    def _polynomial(self, x: str, square: str, c: list[Fraction]) -> str:
        """Return c0 + c1·x + x²·(c2 + c3·x)."""
        pairs, lanes = self.pairs, self.lanes
        first, last = (pairs.fma(x, lanes.const(float(c[k + 1])), lanes.const(float(c[k]))) for k in (0, 2))
        return pairs.fma(square, last, first)

    def result(self, name: str) -> Result:
        """Return `sin` or `cos`."""
        lanes, pairs, text, r = self.lanes, self.pairs, self.lanes.text, self._r
        own, other = self._sine, self._cosine
        if name == "cos":
            own, other = other, _Entry(lanes.neg(own.half), lanes.neg(own.low), own.band)
        less, base, derivative = (
            lanes.neg(own.half),
            lanes.add(own.half, own.half),
            lanes.add(other.half, other.half),
        )
        slope = pairs.fma(less, r.high, derivative)
        left = pairs.fma(less, r.high, lanes.sub(derivative, slope))
        change = pairs.times(r.high, Pair(slope, left))
        total = pairs.sum(base, change.high)
        low = pairs.fma(pairs.fma(less, r.high, slope), r.low, pairs.fma(other.low, r.high, own.low))
        low = pairs.fma(lanes.mul(own.half, self._fourth), self._even, low)
        low = lanes.add(low, pairs.fma(lanes.mul(change.high, self._square), self._odd, change.low))
        relative = lanes.mul(lanes.intrinsic("fabs", r.high), lanes.const(_RELATIVE))
        value, doubt = rounded(lanes, total, low, lanes.larger(relative, own.band))
        doubt = text.op(f"or {lanes.integers} {doubt}, {beyond(lanes, self._size, _MOST)}")
        bits = text.op(f"shl {lanes.integers} {self._index}, {lanes.integer(59)}")
        if name == "sin":
            argument = text.op(f"bitcast {lanes.kind} %x to {lanes.integers}")
            bits = text.op(f"xor {lanes.integers} {bits}, {argument}")
        sign = text.op(f"and {lanes.integers} {bits}, {lanes.integer(-(2**63))}")
        bits = text.op(f"bitcast {lanes.kind} {value} to {lanes.integers}")
        bits = text.op(f"xor {lanes.integers} {bits}, {sign}")
        return Result(text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}"), doubt)


class _Entry(NamedTuple):
    """Of a sine: its half, what its double lacks, and the band of the rounding test."""

    half: str
    low: str
    band: str
