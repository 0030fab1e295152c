"""Expressions whose value is known before a model runs: bounds of sums, places, points of tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Binary, Call, Expression, Name, Negative, Number
from desire_tui.convert.xppaut.vocabulary import NotConvertibleError

if TYPE_CHECKING:
    from collections.abc import Mapping


def constant(expression: Expression, values: Mapping[str, float]) -> float:
    """Return the value of an expression of numbers and of names with known values. NotConvertibleError."""

    def of(part: Expression) -> float:
        match part:
            case Number(value):
                return value
            case Name("<PI>"):
                return math.pi
            case Name(name) if name in values:
                return values[name]
            case Negative(operand):
                return -of(operand)
            case Binary(operator, left, right):
                return _arithmetic(operator, of(left), of(right))
            case Call("floor", (argument,)):
                return float(math.floor(of(argument)))
            case Call("mod", (left, right)):
                return of(left) % of(right)
            case _:
                raise NotConvertibleError("an index or a bound of a sum must be a constant")

    try:
        return of(expression)
    except (ArithmeticError, ValueError):
        raise NotConvertibleError("an index or a bound of a sum cannot be computed") from None


def _arithmetic(operator: str, left: float, right: float) -> float:
    match operator:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case "/":
            return left / right
        case _:
            return float(left**right)
