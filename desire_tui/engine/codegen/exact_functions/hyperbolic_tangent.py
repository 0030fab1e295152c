"""tanh of many numbers: the operations of FDLIBM, which the C library's tanh is made of.

No bound of its error would tell which way it rounds: it may be 2 units of the last place off. So the method
is FDLIBM's, operation by operation (Sun Microsystems 1993; licence in LICENSES/FDLIBM.txt): tanh x = -e/(e
+ 2) with e = expm1(-2|x|) below 1, and 1 - 2/(e + 2) with e = expm1(2|x|) from there. Whether the C library
at hand does the same operations, and whether it was compiled with fused multiplication and addition,
`compiled` finds out.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.pairs import Pairs

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes


def _number(bits: int) -> float:
    return float(struct.unpack("<d", struct.pack("<Q", bits))[0])


_LN2_HIGH, _LN2_LOW = _number(0x3FE62E42FEE00000), _number(0x3DEA39EF35793C76)
_PER_LN2 = _number(0x3FF71547652B82FE)
_Q = tuple(
    _number(bits)
    for bits in (
        0xBFA11111111110F4,
        0x3F5A01A019FE5585,
        0xBF14CE199EAADBB7,
        0x3ED0CFCA86E65239,
        0xBE8AFDB76E09C32D,
    )
)
"""Of (eʳ + 1)/(eʳ - 1)·r, in powers of r²/2."""
_HALF_LN2 = _number(0x3FD62E4300000000)
"""From here on a multiple of ln 2 is taken away: by the upper half of the bits."""
_ONE_FROM = 22.0


def hyperbolic_tangent(lanes: Lanes, *, fused: bool) -> str:
    """Return tanh of `%x`; `fused`: a·b + c is rounded once."""
    const = lanes.const
    size, most = lanes.intrinsic("fabs", "%x"), const(_ONE_FROM)
    large = lanes.compare("oge", size, const(1.0))
    size = lanes.choose(lanes.compare("ogt", size, most), most, size)  # not a number: it stays so
    e = _expm1(lanes, lanes.add(size, size), large, fused=fused)
    ratio = lanes.div(lanes.choose(large, const(2.0), lanes.neg(e)), lanes.add(e, const(2.0)))
    result = lanes.choose(large, lanes.sub(const(1.0), ratio), ratio)
    name = f"llvm.copysign.{lanes.suffix}"
    lanes.text.declarations.add(f"declare {lanes.kind} @{name}({lanes.kind}, {lanes.kind})")
    return lanes.text.op(f"call {lanes.kind} @{name}({lanes.kind} {result}, {lanes.kind} %x)")


def _expm1(lanes: Lanes, size: str, large: str, *, fused: bool) -> str:
    """Return eˣ - 1 for x = `size` in [2, 44] where the flag is set, else for x = -`size` in [-2, 0].

    What FDLIBM takes away from x is k ln 2, with the sign of x, so that what is left has the sign, too. It
    computes in a way of its own for k above 56, where tanh x is 1 whatever the last digits are.
    """

    def plus(a: str, b: str, c: str) -> str:
        return Pairs(lanes).fma(a, b, c) if fused else lanes.add(lanes.mul(a, b), c)

    def signed(value: str) -> str:
        return lanes.choose(large, value, lanes.neg(value))

    add, sub, mul, const, choose = lanes.add, lanes.sub, lanes.mul, lanes.const, lanes.choose
    one, half = const(1.0), const(0.5)
    k = lanes.intrinsic("trunc", plus(const(_PER_LN2), size, half))
    k = choose(lanes.compare("olt", size, const(_HALF_LN2)), const(0.0), k)
    high, low = Pairs(lanes).fma(k, const(-_LN2_HIGH), size), mul(k, const(_LN2_LOW))  # the first is exact
    left = sub(high, low)
    r, c = signed(left), signed(sub(sub(high, left), low))
    r_half = mul(half, r)
    z = mul(r, r_half)
    z2 = mul(z, z)
    z4 = mul(z2, z2)
    q = [const(value) for value in _Q]
    first, second, third = plus(z, q[0], one), plus(z, q[2], q[1]), plus(z, q[4], q[3])
    rational = plus(z4, third, plus(z2, second, first))
    t = plus(lanes.neg(rational), r_half, const(3.0))
    e = mul(z, lanes.div(sub(rational, t), plus(lanes.neg(r), t, const(6.0))))
    none = sub(r, plus(r, e, lanes.neg(z)))
    e = sub(plus(r, sub(e, c), lanes.neg(c)), z)
    change = sub(e, r)
    minus_one = sub(mul(const(-0.5), change), half)
    part = _power(lanes, lanes.neg(k))
    # times 2ᵏ are: 1 - 2⁻ᵏ - (e - r) up to 20, (r - (e + 2⁻ᵏ)) + 1 beyond, 1 - (e - r) below 0
    few = lanes.compare("olt", k, const(20.0))
    grown = choose(few, sub(sub(one, part), change), add(sub(r, add(e, part)), one))
    grown = mul(choose(large, grown, sub(one, change)), choose(large, _power(lanes, k), part))
    grown = choose(large, grown, sub(grown, one))
    is_one = lanes.text.op(
        f"select {lanes.flags} {large}, {lanes.flags} zeroinitializer, "
        f"{lanes.flags} {lanes.compare('oeq', k, one)}"
    )
    grown = choose(is_one, minus_one, grown)
    return choose(lanes.compare("oeq", k, const(0.0)), none, grown)


def _power(lanes: Lanes, k: str) -> str:
    """Return 2ᵏ for whole numbers."""
    text = lanes.text
    shifted = lanes.add(k, lanes.const(1.5 * 2.0**52 + 1023))
    bits = text.op(f"bitcast {lanes.kind} {shifted} to {lanes.integers}")
    power = text.op(f"shl {lanes.integers} {bits}, {lanes.integer(52)}")
    return text.op(f"bitcast {lanes.integers} {power} to {lanes.kind}")
