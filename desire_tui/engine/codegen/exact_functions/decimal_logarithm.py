"""log10 of many numbers: the operations of FDLIBM, which the C library's log10 is made of.

x = 2ᵏz with z in [1, 2) or, below 1, in [1/2, 1); log10 x = k·log10 2 + ln z / ln 10, in plain doubles around
the library's own ln (Sun Microsystems 1993; licence in LICENSES/FDLIBM.txt). Whether the C library at hand
does the same operations, and whether it was compiled with fused multiplication and addition, `compiled`
finds out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.logarithm import beyond_normal, logarithm, power_of_two
from desire_tui.engine.codegen.exact_functions.pairs import Pairs
from desire_tui.engine.codegen.exact_functions.rounding_test import Result

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_PER_LN_10 = 4.34294481903251816668e-01
_LOG10_2_HIGH, _LOG10_2_LOW = 3.01029995663611771306e-01, 3.69423907715893078616e-13


def decimal_logarithm(lanes: Lanes, *, fused: bool) -> Result:
    """Return log10 of `%x`; `fused`: a·b + c is rounded once."""
    text, const = lanes.text, lanes.const

    def plus(a: str, b: str, c: str) -> str:
        return Pairs(lanes).fma(a, b, c) if fused else lanes.add(lanes.mul(a, b), c)

    bits = text.op(f"bitcast {lanes.kind} %x to {lanes.integers}")
    k = lanes.sub(power_of_two(lanes, bits), const(1023.0))
    below = lanes.compare("olt", k, const(0.0))
    k = lanes.choose(below, lanes.add(k, const(1.0)), k)
    digits = text.op(f"and {lanes.integers} {bits}, {lanes.integer((1 << 52) - 1)}")
    powers = text.op(
        f"select {lanes.flags} {below}, {lanes.integers} {lanes.integer(1022 << 52)}, "
        f"{lanes.integers} {lanes.integer(1023 << 52)}"
    )
    z = text.op(f"or {lanes.integers} {digits}, {powers}")
    ln_z = logarithm(lanes, text.op(f"bitcast {lanes.integers} {z} to {lanes.kind}"))
    small = plus(k, const(_LOG10_2_LOW), lanes.mul(const(_PER_LN_10), ln_z.value))
    value = plus(k, const(_LOG10_2_HIGH), small)
    return Result(value, text.op(f"or {lanes.integers} {ln_z.doubt}, {beyond_normal(lanes, bits)}"))
