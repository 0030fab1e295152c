"""What is left of |x| when multiples of π/2 are taken away, by the operations of glibc's sin and cos.

Up to 0.855 nothing is taken away; from there to 2.43 π/2 as two doubles; beyond the multiple nearest to |x|,
of π/2 as four numbers, the first three of which have so few digits that products with up to 2²⁶ are doubles.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.exact_functions.constants import half_pi
from desire_tui.engine.codegen.exact_functions.pairs import Pairs, split

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_LARGEST = float.fromhex("0x1.921fbp+26")
"""From here on glibc takes multiples away in another way."""
_OWN_WAY = float(half_pi()) + 27 / 256
"""Between 0.855 and 2.43 glibc's sin looks into its table before it adds `low` to `size`, its cos and sincos
after that. Where `size` is halfway between two entries these may differ; of all such numbers only this one
has another sine for it."""
_SOME, _MANY = float.fromhex("0x1.b6p-1"), float.fromhex("0x1.368fdp+1")
_MAGIC = 1.5 * 2.0**52
"""Added and taken away: rounds to a whole number, whose last bits it shows."""
_LAST_BITS = (25, 53, 80)
"""Behind the point, of the first three parts of π/2."""


class Rest(NamedTuple):
    """|x| = turns·π/2 ± (size + low); `is_whole`: nothing was taken away from any element."""

    size: str
    low: str
    sign: str
    """Integers whose first bit is set where ± is -; their other bits are 0."""
    turns: str
    """Integers; the last two bits count."""
    unknown: str
    """Integers that are not 0 where all this is wrong, and the library is to be asked."""
    is_whole: bool = False


def quarter_turn() -> tuple[float, float, float, float]:
    """Return π/2 in four parts, each next to what those before leave."""
    left, parts = half_pi(), []
    for bits in _LAST_BITS:
        part = Fraction(round(left * 2**bits), 2**bits)
        parts.append(float(part))
        left -= part
    return parts[0], parts[1], parts[2], float(left)


def is_large(lanes: Lanes, size: str) -> str:
    """Return the flags of elements from which something is taken away, or which are not a number."""
    return lanes.compare("uge", size, lanes.const(_SOME))


def untouched(lanes: Lanes, size: str) -> Rest:
    """Return what is left of |x| where nothing is taken away from any element."""
    nothing = "zeroinitializer"
    return Rest(size, lanes.const(-0.0), nothing, nothing, nothing, is_whole=True)  # + -0 changes no number


def reduced(lanes: Lanes, size: str) -> Rest:
    """Return what is left of |x|."""
    signed, low, turns = _reduced(lanes, size)
    sign = sign_of(lanes, signed)
    return Rest(
        lanes.intrinsic("fabs", signed), with_sign(lanes, low, sign), sign, turns, _unknown(lanes, size)
    )


def _reduced(lanes: Lanes, size: str) -> tuple[str, str, str]:
    """Return what is left as a double and what that lacks, and the multiple."""
    fma, const = Pairs(lanes).fma, lanes.const
    first, second, third, fourth = quarter_turn()
    double, lacks = split(half_pi())
    many = lanes.compare("uge", size, const(_MANY))
    one_or_none = lanes.choose(lanes.compare("olt", size, const(_SOME)), const(_MAGIC), const(_MAGIC + 1.0))
    shifted = lanes.choose(many, nearest_turns(lanes, size), one_or_none)
    turns = lanes.sub(shifted, const(_MAGIC))
    turns_of_many = lanes.choose(many, turns, const(0.0))
    large = lanes.choose(many, const(-first), const(-double))
    small = lanes.choose(many, const(-third), const(-lacks))
    near = fma(turns_of_many, const(-second), fma(turns, large, size))
    nearer = fma(turns, small, near)
    low = fma(turns, small, lanes.sub(near, nearer))
    value = fma(turns_of_many, const(-fourth), nearer)
    low = lanes.add(low, fma(turns_of_many, const(-fourth), lanes.sub(nearer, value)))
    return value, low, lanes.text.op(f"bitcast {lanes.kind} {shifted} to {lanes.integers}")


def _unknown(lanes: Lanes, size: str) -> str:
    large = lanes.compare("oge", size, lanes.const(_LARGEST))
    own_way = lanes.compare("oeq", size, lanes.const(_OWN_WAY))
    either = lanes.text.op(f"or {lanes.flags} {large}, {own_way}")
    return lanes.text.op(f"sext {lanes.flags} {either} to {lanes.integers}")


def nearest_turns(lanes: Lanes, size: str) -> str:
    """Return the whole number nearest to |x|/(π/2), to which `_MAGIC` is added."""
    return Pairs(lanes).fma(size, lanes.const(float(1 / half_pi())), lanes.const(_MAGIC))


def sign_of(lanes: Lanes, x: str) -> str:
    """Return integers whose first bit is that of x, all others 0."""
    bits = lanes.text.op(f"bitcast {lanes.kind} {x} to {lanes.integers}")
    return lanes.text.op(f"and {lanes.integers} {bits}, {lanes.integer(-(2**63))}")


def with_sign(lanes: Lanes, x: str, sign: str) -> str:
    """Return -x where the first bit of `sign` is set; its other bits are 0."""
    bits = lanes.text.op(f"bitcast {lanes.kind} {x} to {lanes.integers}")
    bits = lanes.text.op(f"xor {lanes.integers} {bits}, {sign}")
    return lanes.text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}")
