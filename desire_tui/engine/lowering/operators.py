"""Operators of a segment's expressions as lowered operations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value

OPERATIONS = {"+": "add", "-": "sub", "*": "mul", "/": "div"}


def power(left: Value, right: Value) -> Op:
    """Lower `left ^ right`: whole constant powers are products (language.md 4)."""
    if isinstance(right, Const) and abs(right.value) <= 1024 and right.value == int(right.value):
        return Op("ipow", (left, right))
    return Op("pow", (left, right))
