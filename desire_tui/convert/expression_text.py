"""An expression as Desire writes it, with as few parentheses as its grammar allows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import (
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
)

if TYPE_CHECKING:
    from collections.abc import Callable

_CONDITION, _SUM, _PRODUCT, _SIGNED, _POWER, _ATOM = range(6)
_LEVEL = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "^": _POWER}


def expression_text(expression: Expression, name_of: Callable[[str], str] = str) -> str:
    """Return its text. `name_of` gives quantities and functions their names in the program."""
    return _Writer(name_of).at_least(expression, _SUM)


def condition_text(expression: Expression, name_of: Callable[[str], str] = str) -> str:
    """Return its text as a script's `if` takes it; a number holds where it is not 0."""
    return _Writer(name_of).condition(expression)


def number_text(value: float) -> str:
    """Return the shortest text from which Desire reads exactly this number."""
    if value == int(value) and abs(value) < 1e15:
        return str(int(value))
    mantissa, exponent, power = repr(float(value)).partition("e")
    return f"{mantissa}e{int(power)}" if exponent else mantissa


class _Writer:
    def __init__(self, name_of: Callable[[str], str]) -> None:
        self._name_of = name_of

    def at_least(self, expression: Expression, level: int) -> str:
        """Return its text, in parentheses if its operator binds weaker than `level`."""
        text, own = self._text(expression)
        return text if own >= level else f"({text})"

    def _text(self, expression: Expression) -> tuple[str, int]:
        match expression:
            case Number(value, text):
                return text or number_text(value), _ATOM
            case Name(name):
                return self._name_of(name), _ATOM
            case Negative(operand):
                return f"-{self.at_least(operand, _POWER)}", _SIGNED
            case Binary():
                return self._binary(expression), _LEVEL[expression.operator]
            case Call("[]", (array, index)):
                return f"{self.at_least(array, _ATOM)}[{self.at_least(index, _SUM)}]", _ATOM
            case Call(function, arguments):
                between = "; " if function == "func1" else ", "  # a table stands behind a semicolon
                inner = between.join(self.at_least(argument, _SUM) for argument in arguments)
                return f"{self._name_of(function)}({inner})", _ATOM
            case Choice(condition, then, otherwise):
                chosen = ", ".join(self.at_least(part, _SUM) for part in (otherwise, then))
                # a condition is worth 1 or 0, and comp takes what is above 0 for true
                return f"comp(({self.condition(condition)}), {chosen})", _ATOM
            case Relation() | Logical() | Not():
                return f"({self.condition(expression)})", _ATOM

    def _binary(self, expression: Binary) -> str:
        operator, level = expression.operator, _LEVEL[expression.operator]
        if operator == "^":  # from right to left; a sign may stand in the exponent
            return f"{self.at_least(expression.left, _ATOM)}^{self.at_least(expression.right, _SIGNED)}"
        left = self.at_least(expression.left, level)
        right = self.at_least(expression.right, level + 1)
        return f"{left} {operator} {right}" if level == _SUM else f"{left}{operator}{right}"

    def condition(self, expression: Expression) -> str:
        match expression:
            case Relation(operator, left, right):
                return f"{self.at_least(left, _SUM)} {operator} {self.at_least(right, _SUM)}"
            case Logical(operator, left, right):
                return f"{self._operand(left, operator)} {operator} {self._operand(right, operator)}"
            case Not(operand):
                return f"not ({self.condition(operand)})"
            case _:  # a number: true if it is not 0
                return f"{self.at_least(expression, _SUM)} <> 0"

    def _operand(self, expression: Expression, outer: str) -> str:
        """Return an operand of `and`, `or`; `and` binds tighter, and behind neither a sign may stand."""
        text = self.condition(expression)
        mixed = isinstance(expression, Logical) and expression.operator != outer
        return f"({text})" if mixed or text.startswith("-") else text
