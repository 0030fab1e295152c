"""The value of a constant expression: the arithmetic of the language, with what the caller knows of names."""

from __future__ import annotations

from operator import add, mul, sub, truediv
from typing import TYPE_CHECKING

from desire_tui.engine.left_chains import chain
from desire_tui.engine.library import power
from desire_tui.engine.nodes.expressions import Binary, Number, Unary

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.nodes.expressions import Expr

_OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "+": add, "-": sub, "*": mul, "/": truediv, "^": power,
}  # fmt: skip


def evaluate(node: Expr, value_of: Callable[[Expr], float | None]) -> float | None:
    """Return the value of an expression; None if a part of it has none.

    `value_of` is asked for the value of everything but numbers, signs and operations. ArithmeticError,
    ValueError: an operation has no result.
    """
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Unary):
        value = evaluate(node.operand, value_of)
        return None if value is None else -value if node.op == "-" else value
    if not isinstance(node, Binary) or node.op not in _OPERATIONS:
        return value_of(node)
    first, steps = chain(node) if node.op != "^" else (node.left, [node])
    result = evaluate(first, value_of)
    for step in steps:
        right = evaluate(step.right, value_of)
        if step.op not in _OPERATIONS:
            return value_of(step)
        result = None if result is None or right is None else _OPERATIONS[step.op](result, right)
    return result
