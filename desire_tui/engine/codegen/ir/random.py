"""`ran()`: the 48-bit linear congruential sequence of language.md 4.1, with jumps of any length.

X ← (MULTIPLIER·X + INCREMENT) mod 2⁴⁸, u = X / 2⁴⁸. A jump of k draws is again such a step, with constants
that are known when the code is written, so lanes and blocks of a vector draw independently and still in the
exact order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.functions import apply

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

MULTIPLIER, INCREMENT, BITS = 0x5DEECE66D, 11, 48
MASK = (1 << BITS) - 1
_INVERSE = pow(MULTIPLIER, -1, 1 << BITS)


def jump(count: int) -> tuple[int, int]:
    """Return (a, c) so that `count` steps of the sequence (backwards if negative) are X ← a·X + c mod 2⁴⁸."""
    step = (MULTIPLIER, INCREMENT) if count >= 0 else (_INVERSE, -_INVERSE * INCREMENT & MASK)
    total = (1, 0)
    for bit in f"{abs(count):b}":
        a, c = total
        total = (a * a & MASK, (a * c + c) & MASK)
        if bit == "1":
            a, c = total
            total = (a * step[0] & MASK, (a * step[1] + c) & MASK)
    return total


def advance(lanes: Lanes, state: str, count: int) -> str:
    """Write a jump of `count` draws from the integer state(s); return the new one(s)."""
    a, c = jump(count)
    text = lanes.text
    grown = text.op(f"mul {lanes.integers} {state}, {lanes.whole(a)}")
    moved = text.op(f"add {lanes.integers} {grown}, {lanes.whole(c)}")
    return text.op(f"and {lanes.integers} {moved}, {lanes.whole(MASK)}")


def fraction(lanes: Lanes, state: str) -> str:
    """Write u = X / 2⁴⁸ (exact)."""
    real = lanes.text.op(f"sitofp {lanes.integers} {state} to {lanes.kind}")
    return lanes.mul(real, lanes.const(2.0**-BITS))


def uniform(lanes: Lanes, state: str) -> str:
    """Write 2u - 1."""
    return lanes.sub(lanes.mul(lanes.const(2.0), fraction(lanes, state)), lanes.const(1.0))


def normal(lanes: Lanes, first: str, second: str) -> str:
    """Write sqrt(-2 ln u1)·cos(2π u2)."""
    logarithm = lanes.outside("log", fraction(lanes, first))
    radius = apply(lanes, "sqrt", [lanes.mul(lanes.const(-2.0), logarithm)])
    angle = lanes.mul(lanes.const(6.283185307179586), fraction(lanes, second))
    return lanes.mul(radius, lanes.outside("cos", angle))
