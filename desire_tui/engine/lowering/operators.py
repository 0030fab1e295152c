"""Operators of a segment's expressions as lowered operations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.expressions import Value

OPERATIONS = {"+": "add", "-": "sub", "*": "mul", "/": "div"}

COMPOSED: dict[str, Callable[..., Op]] = {
    "ceil": lambda x: Op("neg", (Op("floor", (Op("neg", (x,)),)),)),
    "heav": lambda x: Op("swtch", (x,)),
    "mod": lambda x, y: Op("sub", (x, Op("mul", (y, Op("floor", (Op("div", (x, y)),)))))),
}
"""Library functions that are made of others, so that back ends need not know them."""


def power(left: Value, right: Value) -> Op:
    """Lower `left ^ right`: whole constant powers are products (language.md 4)."""
    if isinstance(right, Const) and abs(right.value) <= 1024 and right.value == int(right.value):
        return Op("ipow", (left, right))
    return Op("pow", (left, right))
