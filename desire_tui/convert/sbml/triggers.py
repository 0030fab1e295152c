"""Conditions as expressions that become positive where they become true, so that events can be located."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import (
    ZERO,
    Binary,
    Call,
    Expression,
    Logical,
    Negative,
    Not,
    Number,
    Relation,
    names_in,
)

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet


class UnlocatableError(Exception):
    """A condition that holds at single moments only: the reason."""


def rising(condition: Expression, changing: AbstractSet[str]) -> list[Expression]:
    """Return what becomes positive at the moments at which a condition becomes true. UnlocatableError.

    Two quantities are equal where their difference changes its sign, in one direction or the other; what
    holds all the time or never, since it reads nothing that is `changing`, may stand beside it.
    """
    match condition:
        case Logical("and", left, right):
            for fixed, other in ((left, right), (right, left)):
                if not names_in(fixed) & changing:
                    holds = Binary("-", fixed, Number(0.5))
                    return [Call("min", (holds, moment)) for moment in rising(other, changing)]
            return [becoming_positive(condition)]
        case Relation("=", left, right) if not (_is_truth(left) or _is_truth(right)):
            return [_difference(left, right), _difference(right, left)]
        case _:
            return [becoming_positive(condition)]


def becoming_positive(condition: Expression) -> Expression:
    """Return an expression that is above 0 where the condition holds, else 0 or less. UnlocatableError."""
    match condition:
        case Relation(">" | ">=", left, right):
            return _difference(left, right)
        case Relation("<" | "<=", left, right):
            return _difference(right, left)
        case Relation(sign, left, right) if _is_truth(left) and _is_truth(right):
            both = Logical("or", Logical("and", left, right), Logical("and", Not(left), Not(right)))
            return becoming_positive(both if sign == "=" else Not(both))
        case Relation("="):
            raise UnlocatableError("two quantities are equal at moments that no step meets")
        case Relation("<>", left, right):
            return Call("abs", (_difference(left, right),))
        case Logical(operator, left, right):
            function = "min" if operator == "and" else "max"
            return Call(function, (becoming_positive(left), becoming_positive(right)))
        case Not(operand):
            return _negated(operand)
        case _:  # a number that jumps between 0 and 1
            return Binary("-", condition, Number(0.5))


def _is_truth(expression: Expression) -> bool:
    return isinstance(expression, Relation | Logical | Not)


def _difference(left: Expression, right: Expression) -> Expression:
    return left if right == ZERO else Negative(right) if left == ZERO else Binary("-", left, right)


def _negated(operand: Expression) -> Expression:
    match operand:
        case Not(inner):
            return becoming_positive(inner)
        case Logical("and", left, right):
            return becoming_positive(Logical("or", Not(left), Not(right)))
        case Logical("or", left, right):
            return becoming_positive(Logical("and", Not(left), Not(right)))
        case Relation("=", left, right):
            return becoming_positive(Relation("<>", left, right))
        case Relation("<>", left, right):
            return becoming_positive(Relation("=", left, right))
        case _:
            return Negative(becoming_positive(operand))
