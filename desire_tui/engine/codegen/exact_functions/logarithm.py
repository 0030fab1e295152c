"""ln of many numbers, with the bits of glibc's (2.28 and later).

x = 2ᵏz, where z is in one of sixteen cells around 1, and 1/c in each of them has so few bits that r = z/c - 1
is a double, |r| < 0.035. Then

    ln x = k·ln 2 + ln c + r - r²/2 + r³·P

where all but the last product are made without error (P. T. P. Tang, "Table-driven implementation of the
logarithm function in IEEE floating-point arithmetic", ACM TOMS 16, 1990). k·ln 2 + ln c is two doubles, the
first of which is a multiple of 2⁻⁴² and without error too; around 1 it is 0.
"""

from __future__ import annotations

import struct
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.exact_functions.constants import ln_2, logarithm_of
from desire_tui.engine.codegen.exact_functions.lookups import SIZE, looked_up
from desire_tui.engine.codegen.exact_functions.pairs import Pair, Pairs
from desire_tui.engine.codegen.exact_functions.polynomials import economized
from desire_tui.engine.codegen.exact_functions.rounding_test import Result, rounded

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_FIRST = 0x3FE6800000000000
"""The bits of the least z: 1 is inside the cell from 1 - 2⁻⁶ to 1 + 2⁻⁵."""
_CELL = 48
"""Bits of a double below the four that say which cell it is in."""
_LEAST, _INFINITE = 0x0010000000000000, 0x7FF0000000000000
"""The bits of the least number with all its digits, and of inf."""
_BITS_OF_2_52 = 0x4330000000000000
_GRID = 2**42
_DEGREE = 8
_BAND_LARGE = 1.4 * 2.0**-62
"""glibc rounds z/c - 1, which is below 2⁻⁸, by up to 2⁻⁶², and its polynomial is off by 2⁻⁶⁴·⁴; ours 2⁻⁶⁶."""
_BAND_SMALL = 0.022 * 2.0**-52
"""Of the result's power of two. glibc says 0.52 units of the last place, less than `_BAND_LARGE` where
|ln x| < 1/16 and it computes in another way; ours 0.002 units."""


class Cell(NamedTuple):
    """Numbers from `low` to `high`, 1/c as a double for all of them, and what r may be at most."""

    low: float
    high: float
    inverse: float
    most: float


@cache
def cells() -> list[Cell]:
    """Return the cells that z may be in."""
    edges = [_double(_FIRST + (k << _CELL)) for k in range(SIZE + 1)]
    return [_cell(low, high) for low, high in pairwise(edges)]


def _cell(low: float, high: float) -> Cell:
    """Choose the 1/c that leaves the least r among those for which r is a double."""
    last = 53 if low < 1.0 else 52  # bits of z behind the point
    found = []
    for bits in range(7):
        for numerator in range(int(2**bits / high), int(2**bits / low) + 2):
            inverse = numerator / 2**bits
            most = max(abs(low * inverse - 1.0), abs(high * inverse - 1.0))
            if most <= 2.0 ** (53 - last - bits):
                found.append(Cell(low, high, inverse, most))
    return min(found, key=lambda cell: cell.most)


@cache
def _series() -> list[Fraction]:
    """Return -2·P: 2⁻⁶⁷ and less off, times r³."""
    most = Fraction(max(cell.most for cell in cells()))
    terms = [Fraction(2 * (-1) ** (n + 1), n + 3) for n in range(_DEGREE + 3)]
    while len(terms) > _DEGREE + 1:
        terms = economized(terms, -most, most)
    return terms


def logarithm(lanes: Lanes, x: str) -> Result:
    """Return ln of numbers."""
    text, pairs, const = lanes.text, Pairs(lanes), lanes.const
    bits = text.op(f"bitcast {lanes.kind} {x} to {lanes.integers}")
    place = text.op(f"sub {lanes.integers} {bits}, {lanes.integer(_FIRST - (1024 << 52))}")
    k = lanes.sub(power_of_two(lanes, place), const(1024.0))
    z = _mantissa(lanes, place)
    cell = text.op(f"lshr {lanes.integers} {place}, {lanes.integer(_CELL)}")
    inverse, first, second, _ = looked_up(lanes, cell, _tables())
    r = pairs.fma(z, inverse, const(-1.0))
    ln_2_first, ln_2_second = _on_grid(ln_2())
    base = pairs.fma(k, const(ln_2_first), first)
    less = pairs.fma(k, const(ln_2_second), second)
    near = pairs.sum(base, r)
    half = pairs.product(lanes.mul(r, const(-0.5)), r)
    total = pairs.sum(near.high, half.high)
    low = lanes.add(lanes.add(near.low, total.low), lanes.add(half.low, less))
    rest = lanes.mul(lanes.mul(half.high, r), pairs.by_squares(r, _series()))
    value, doubt = rounded(lanes, Pair(total.high, low), rest, _band(lanes, total.high))
    return Result(value, text.op(f"or {lanes.integers} {doubt}, {beyond_normal(lanes, bits)}"))


def power_of_two(lanes: Lanes, bits: str) -> str:
    """Return as a double what stands above the last 52 bits: of positive doubles 1023 + their power of 2."""
    text = lanes.text
    power = text.op(f"lshr {lanes.integers} {bits}, {lanes.integer(52)}")
    power = text.op(f"or {lanes.integers} {power}, {lanes.integer(_BITS_OF_2_52)}")
    return lanes.sub(text.op(f"bitcast {lanes.integers} {power} to {lanes.kind}"), lanes.const(2.0**52))


def _mantissa(lanes: Lanes, place: str) -> str:
    """Return z."""
    text = lanes.text
    bits = text.op(f"and {lanes.integers} {place}, {lanes.integer((1 << 52) - 1)}")
    bits = text.op(f"add {lanes.integers} {bits}, {lanes.integer(_FIRST)}")
    return text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}")


def _band(lanes: Lanes, value: str) -> str:
    text = lanes.text
    bits = text.op(f"bitcast {lanes.kind} {value} to {lanes.integers}")
    bits = text.op(f"and {lanes.integers} {bits}, {lanes.integer(_INFINITE)}")
    power = text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}")
    band, large = lanes.mul(power, lanes.const(_BAND_SMALL)), lanes.const(_BAND_LARGE)
    return lanes.choose(lanes.compare("olt", band, large), band, large)


def beyond_normal(lanes: Lanes, bits: str) -> str:
    """Return integers that are not 0 where a double is no positive number with all its digits."""
    text = lanes.text
    above = text.op(f"sub {lanes.integers} {bits}, {lanes.integer(_LEAST)}")
    flags = text.op(f"icmp uge {lanes.integers} {above}, {lanes.integer(_INFINITE - _LEAST)}")
    return text.op(f"sext {lanes.flags} {flags} to {lanes.integers}")


def _tables() -> list[list[float]]:
    """Return 1/c, and ln c as two doubles."""
    logarithms = [_on_grid(-logarithm_of(Fraction(cell.inverse))) for cell in cells()]
    inverses = [cell.inverse for cell in cells()]
    return [inverses, *([pair[part] for pair in logarithms] for part in (0, 1)), [0.0] * SIZE]


def _on_grid(value: Fraction) -> tuple[float, float]:
    first = Fraction(round(value * _GRID), _GRID)
    return float(first), float(value - first)


def _double(bits: int) -> float:
    return float(struct.unpack("<d", struct.pack("<Q", bits))[0])
