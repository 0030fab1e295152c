"""exp of many numbers, with the bits of glibc's (2.28 and later).

x = n·ln 2 + r with |r| ≤ ln 2 / 2; Taylor's sum of exp r, whose first terms are pairs, is within 2⁻⁶⁰ of the
value. glibc's is within 0.511 units of the last place (its own analysis, the poorer case without fused
multiplication).
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.constants import ln_2
from desire_tui.engine.codegen.exact_functions.pairs import Pairs, split
from desire_tui.engine.codegen.exact_functions.rounding_test import Result, beyond, rounded

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_MOST = 700.0
_MAGIC = 1.5 * 2.0**52
_BAND = 0.014 * 2.0**-52
"""In units of the result before scaling, which is between 0.7 and 1.42: 0.011 there, and our own error."""
_TERMS = 16


def exponential(lanes: Lanes) -> Result:
    """Return exp of `%x`."""
    text, pairs, x = lanes.text, Pairs(lanes), "%x"
    shifted = pairs.fma(x, lanes.const(float(1 / ln_2())), lanes.const(_MAGIC))
    whole = lanes.sub(shifted, lanes.const(_MAGIC))
    first, second = split(ln_2())
    high = pairs.fma(whole, lanes.const(-first), x)  # without error: what is left has fewer bits
    low = lanes.mul(whole, lanes.const(-second))
    square = pairs.product(high, high)
    more = [Fraction(1, factorial(n)) for n in range(4, _TERMS)]
    inner = pairs.times(high, pairs.series(high, Fraction(1, 6), more))
    change = pairs.by(square, pairs.constant_plus(Fraction(1, 2), inner))
    grown = pairs.sum(high, change.high)
    total = pairs.sum(lanes.const(1.0), grown.high)
    small = lanes.add(grown.low, pairs.fma(low, total.high, change.low))
    half = lanes.compare("olt", total.high, lanes.const(1.0))
    band = lanes.choose(half, lanes.const(_BAND / 2), lanes.const(_BAND))
    value, doubt = rounded(lanes, total, small, band)
    far = beyond(lanes, lanes.intrinsic("fabs", x), _MOST)
    doubt = text.op(f"or {lanes.integers} {doubt}, {far}")
    power = text.op(f"bitcast {lanes.kind} {shifted} to {lanes.integers}")
    power = text.op(f"shl {lanes.integers} {power}, {lanes.integer(52)}")
    bits = text.op(f"bitcast {lanes.kind} {value} to {lanes.integers}")
    bits = text.op(f"add {lanes.integers} {bits}, {power}")
    return Result(text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}"), doubt)
