"""Derivatives of expressions, for equations that are differentiated before they are solved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import (
    ONE,
    ZERO,
    Binary,
    Call,
    Choice,
    Expression,
    Logical,
    Name,
    Negative,
    Not,
    Number,
    Relation,
    product,
    quotient,
)

if TYPE_CHECKING:
    from collections.abc import Callable


class NotDifferentiableError(Exception):
    """A function without a derivative here: its name."""


def derivative(expression: Expression, name: str) -> Expression:
    """Return the derivative with respect to a quantity. NotDifferentiableError."""
    match expression:
        case Number() | Relation() | Logical() | Not():
            return ZERO
        case Name(other):
            return ONE if other == name else ZERO
        case Negative(operand):
            return negative(derivative(operand, name))
        case Choice(condition, then, otherwise):
            ways = derivative(then, name), derivative(otherwise, name)
            return ways[0] if ways[0] == ways[1] else Choice(condition, *ways)
        case Binary("+", left, right):
            return plus(derivative(left, name), derivative(right, name))
        case Binary("-", left, right):
            return plus(derivative(left, name), negative(derivative(right, name)))
        case Binary("*", left, right):
            return plus(times(derivative(left, name), right), times(left, derivative(right, name)))
        case Binary("/", left, right):
            return _of_quotient(left, right, name)
        case Binary(_, left, right):
            return _of_power(left, right, name)
        case Call(function, (argument,)) if function in _OUTER:
            inner = derivative(argument, name)
            return ZERO if inner == ZERO else times(_OUTER[function](argument), inner)
        case Call(function, arguments):
            if any(derivative(argument, name) != ZERO for argument in arguments):
                raise NotDifferentiableError(function)
            return ZERO


def plus(left: Expression, right: Expression) -> Expression:
    """Return the sum; 0 is left out."""
    if left == ZERO:
        return right
    if right == ZERO:
        return left
    return Binary("-", left, right.operand) if isinstance(right, Negative) else Binary("+", left, right)


def times(left: Expression, right: Expression) -> Expression:
    """Return the product; 0 and factors of 1 are left out."""
    return ZERO if ZERO in (left, right) else product(left, right)


def negative(operand: Expression) -> Expression:
    """Return -x."""
    if operand == ZERO:
        return ZERO
    return operand.operand if isinstance(operand, Negative) else Negative(operand)


def _of_quotient(left: Expression, right: Expression, name: str) -> Expression:
    first = quotient(derivative(left, name), right)
    second = derivative(right, name)
    if second == ZERO:
        return ZERO if derivative(left, name) == ZERO else first
    part = negative(quotient(times(left, second), Binary("^", right, Number(2.0))))
    return part if derivative(left, name) == ZERO else plus(first, part)


def _of_power(left: Expression, right: Expression, name: str) -> Expression:
    base, exponent = derivative(left, name), derivative(right, name)
    if exponent == ZERO:
        if base == ZERO:
            return ZERO
        lower = (
            Number(right.value - 1)
            if isinstance(right, Number) and right.value >= 1
            else Binary("-", right, ONE)
        )
        power = left if lower == ONE else ONE if lower == ZERO else Binary("^", left, lower)
        return times(times(right, power), base)
    whole = Binary("^", left, right)
    through_exponent = times(times(whole, Call("ln", (left,))), exponent)
    through_base = (
        ZERO if base == ZERO else times(times(right, Binary("^", left, Binary("-", right, ONE))), base)
    )
    return plus(through_base, through_exponent)


def _inverse(x: Expression) -> Expression:
    return Binary("/", ONE, x)


def _square(x: Expression) -> Expression:
    return Binary("^", x, Number(2.0))


_OUTER: dict[str, Callable[[Expression], Expression]] = {
    "sin": lambda x: Call("cos", (x,)),
    "cos": lambda x: Negative(Call("sin", (x,))),
    "tan": lambda x: _inverse(_square(Call("cos", (x,)))),
    "exp": lambda x: Call("exp", (x,)),
    "ln": _inverse,
    "log": lambda x: _inverse(Binary("*", x, Call("ln", (Number(10.0),)))),
    "sqrt": lambda x: _inverse(Binary("*", Number(2.0), Call("sqrt", (x,)))),
    "sinh": lambda x: Call("cosh", (x,)),
    "cosh": lambda x: Call("sinh", (x,)),
    "tanh": lambda x: _inverse(_square(Call("cosh", (x,)))),
    "asin": lambda x: _inverse(Call("sqrt", (Binary("-", ONE, _square(x)),))),
    "acos": lambda x: Negative(_inverse(Call("sqrt", (Binary("-", ONE, _square(x)),)))),
    "atan": lambda x: _inverse(Binary("+", ONE, _square(x))),
    "abs": lambda x: Call("sgn", (x,)),
}
