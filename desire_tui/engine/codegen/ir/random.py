"""`ran()` and `gauss()` as instructions: the sequence of `random_sequence`, with jumps of any length.

A jump of k draws is again a step of the sequence, with constants that are known when the code is written, so
lanes and blocks of a vector draw independently and still in the exact order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.functions import apply
from desire_tui.engine.random_sequence import MASK, RADIUS_FACTOR, SCALE, TWO_PI, jump

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes

_BITS_OF_2_52 = 0x4330000000000000


def advance(lanes: Lanes, state: str, count: int) -> str:
    """Write a jump of `count` draws from the integer state(s); return the new one(s)."""
    a, c = jump(count)
    text = lanes.text
    grown = text.op(f"mul {lanes.integers} {state}, {lanes.integer(a)}")
    moved = text.op(f"add {lanes.integers} {grown}, {lanes.integer(c)}")
    return text.op(f"and {lanes.integers} {moved}, {lanes.integer(MASK)}")


def fraction(lanes: Lanes, state: str) -> str:
    """Write u = X / 2⁴⁸ (exact)."""
    text = lanes.text
    if lanes.width == 1:
        return lanes.mul(text.op(f"sitofp i64 {state} to double"), lanes.const(SCALE))
    # few machines convert vectors of 64-bit integers: X below 2⁵² are the last bits of 2⁵² + X
    bits = text.op(f"or {lanes.integers} {state}, {lanes.integer(_BITS_OF_2_52)}")
    real = lanes.sub(text.op(f"bitcast {lanes.integers} {bits} to {lanes.kind}"), lanes.const(2.0**52))
    return lanes.mul(real, lanes.const(SCALE))


def uniform(lanes: Lanes, state: str) -> str:
    """Write 2u - 1."""
    return lanes.sub(lanes.mul(lanes.const(2.0), fraction(lanes, state)), lanes.const(1.0))


def normal(lanes: Lanes, first: str, second: str) -> str:
    """Write sqrt(-2 ln u1)·cos(2π u2)."""
    logarithm = lanes.call_library("log", fraction(lanes, first))
    radius = apply(lanes, "sqrt", [lanes.mul(lanes.const(RADIUS_FACTOR), logarithm)])
    angle = lanes.mul(lanes.const(TWO_PI), fraction(lanes, second))
    return lanes.mul(radius, lanes.call_library("cos", angle))
