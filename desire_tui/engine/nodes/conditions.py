"""The expressions that a condition compares."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.expressions import Logical, Not, Relation

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.nodes.expressions import Condition, Expr


def compared(condition: Condition) -> tuple[Expr, ...]:
    """Return the expressions on both sides of a condition's relations, from left to right."""
    match condition:
        case Relation(_, left, right):
            return (left, right)
        case Logical(_, first, second):
            return (*compared(first), *compared(second))
        case Not(operand):
            return compared(operand)


def with_compared(condition: Condition, change: Callable[[Expr], Expr]) -> Condition:
    """Return a condition whose compared expressions are changed ones."""
    start, end = condition.start, condition.end
    match condition:
        case Relation(op, left, right):
            return Relation(op, change(left), change(right), start, end)
        case Logical(op, first, second):
            return Logical(op, with_compared(first, change), with_compared(second, change), start, end)
        case Not(operand):
            return Not(with_compared(operand, change), start, end)
