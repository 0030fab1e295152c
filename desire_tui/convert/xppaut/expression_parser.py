"""XPPAUT's expressions.

Its operators have three levels, each worked off from left to right: `| + -`, then `& * /`, then `^` and the
comparisons, so that `x > 1 + y` is `(x > 1) + y` and `2^3^2` is 64. A sign at the start of an expression
stands before all of its first power. Upper and lower case are alike: names come out in lower case.
"""

from __future__ import annotations

import math
import re
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

INDEX = "i'"
"""What counts in a sum."""
SUM = "sum("
"""Stands for `sum(low,high)of(term)` until the sum is written out: no quantity can be called so."""

_TOKEN = re.compile(
    r"\s*(?:((?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)|([a-z_]\w*'?)|(\*\*|==|!=|<=|>=|[-+*/^&|<>(),#{}\[\]]))",
    re.IGNORECASE | re.ASCII,
)
_LEVELS: tuple[dict[str, str], ...] = (
    {"+": "+", "-": "-", "|": "or"},
    {"*": "*", "/": "/", "&": "and"},
    {"^": "^", "**": "^", "==": "=", "!=": "<>", "<": "<", ">": ">", "<=": "<=", ">=": ">="},
)
_SAME = frozenset("sin cos tan asin acos atan sinh cosh tanh exp abs sqrt ceil".split())
_RENAMED = {"ln": "ln", "log": "ln", "log10": "log", "flr": "floor", "sign": "sgn"}
_TWO = frozenset({"atan2", "max", "min", "mod"})
BUILT_IN = frozenset({*_SAME, *_RENAMED, *_TWO, "heav", "ran", "normal", "not", "delay", "del_shft", "shift", "sum",
                      "if", "then", "else", "of", "t", "pi", "besselj", "bessely", "besseli", "erf", "erfc",
                      "lgamma", "poisson", "hom_bcs", "int"})  # fmt: skip
"""XPPAUT's own words in expressions."""
_MISSING = {
    "besselj": "Desire has no Bessel functions", "bessely": "Desire has no Bessel functions",
    "besseli": "Desire has no Bessel functions", "erf": "Desire has no error function",
    "erfc": "Desire has no error function", "lgamma": "Desire has no gamma function",
    "poisson": "Desire draws no Poisson numbers", "hom_bcs": "it belongs to AUTO's homoclinic orbits",
    "int": "Volterra integrals are not solved here",
}  # fmt: skip


class NotConvertible(Exception):
    """An expression that cannot be read or said otherwise: the reason."""


def parsed(text: str, *, notes: list[str] | None = None) -> Expression:
    """Return the expression that a text is. NotConvertible.

    Sums come out as calls of SUM, `shift` and `del_shft` as calls of these names. `notes` gets what a reader
    of the text might take otherwise than XPPAUT does.
    """
    return _Parser(text, notes if notes is not None else []).whole()


class _Parser:
    def __init__(self, text: str, notes: list[str]) -> None:
        self._text, self._notes = text, notes
        self._tokens = _tokens(text)
        self._at = 0
        self._bare = False
        """The last expression was a comparison without parentheses."""

    def whole(self) -> Expression:
        expression = self._level(0)
        if self._at < len(self._tokens):
            raise NotConvertible(f"'{self._text.strip()}' does not end before '{self._tokens[self._at]}'")
        return expression

    def _peek(self) -> str:
        return self._tokens[self._at] if self._at < len(self._tokens) else ""

    def _take(self, wanted: str) -> None:
        if self._peek() != wanted:
            found = f"'{self._peek()}'" if self._peek() else "the end"
            raise NotConvertible(f"'{self._text.strip()}' has {found} where '{wanted}' was expected")
        self._at += 1

    def _level(self, level: int) -> Expression:
        if level == len(_LEVELS):
            return self._signed()
        left = self._operand(level)
        while (sign := self._peek()) in _LEVELS[level]:
            self._at += 1
            right = self._operand(level)
            left = _operation(_LEVELS[level][sign], left, right)
            self._bare = isinstance(left, Relation)
        return left

    def _operand(self, level: int) -> Expression:
        begin = self._at
        expression = self._level(level + 1)
        around = {self._peek(), self._tokens[begin - 1] if begin else ""}
        if self._bare and level < 2 and around & {"+", "-", "*", "/"}:
            self._notes.append(f"'{self._text.strip()}': comparisons bind tighter than + - * /, as in XPPAUT")
        return expression

    def _signed(self) -> Expression:
        if self._peek() not in {"-", "+"}:
            return self._atom()
        sign = self._tokens[self._at]
        self._at += 1
        operand = self._level(2)  # a sign stands before the whole power
        return Negative(operand) if sign == "-" else operand

    def _atom(self) -> Expression:
        token = self._peek()
        if not token:
            raise NotConvertible(f"'{self._text.strip()}' ends too early")
        self._at += 1
        expression = self._begun(token)
        self._bare = False
        return expression

    def _begun(self, token: str) -> Expression:
        if token == "(":
            inner = self._level(0)
            self._take(")")
            return inner
        if token[0].isdigit() or token[0] == ".":
            return Number(float(token), token if _plain(token) else "")
        if not (token[0].isalpha() or token[0] == "_"):
            raise NotConvertible(f"'{self._text.strip()}' cannot be read at '{token}'")
        return self._named(token.lower())

    def _named(self, name: str) -> Expression:
        if name in _MISSING:
            raise NotConvertible(_MISSING[name])
        if name == "pi":
            return Name("PI")
        if name == "if":
            return self._choice()
        if name == "sum":
            return self._sum()
        if self._peek() != "(":
            if name.endswith("'") and name != INDEX:
                raise NotConvertible(f"'{name}' means something in boundary conditions only")
            return Name(name)
        return _called(name, self._arguments())

    def _arguments(self) -> tuple[Expression, ...]:
        self._take("(")
        arguments = [self._level(0)]
        while self._peek() == ",":
            self._at += 1
            arguments.append(self._level(0))
        self._take(")")
        return tuple(arguments)

    def _choice(self) -> Expression:
        (condition,) = self._arguments()
        ways = []
        for word in ("then", "else"):
            if self._peek().lower() != word:
                raise NotConvertible(f"'{self._text.strip()}': 'if' needs 'then' and 'else'")
            self._at += 1
            ways.append(self._arguments()[0])
        return Choice(condition, ways[0], ways[1])

    def _sum(self) -> Expression:
        bounds = self._arguments()
        if self._peek().lower() != "of" or len(bounds) != 2:
            raise NotConvertible(f"'{self._text.strip()}': a sum is sum(a,b)of(term)")
        self._at += 1
        return Call(SUM, (*bounds, self._arguments()[0]))


def _tokens(text: str) -> list[str]:
    tokens, at = [], 0
    stripped = text.rstrip()
    while at < len(stripped):
        found = _TOKEN.match(stripped, at)
        if found is None:
            raise NotConvertible(f"'{stripped.strip()}' cannot be read at '{stripped[at:].strip()[:1]}'")
        tokens.append(found[1] or found[2] or found[3])
        at = found.end()
    return tokens


def _plain(token: str) -> bool:
    """Whether Desire reads this number just so, and a person reads it without a second look."""
    return bool(re.fullmatch(r"\d+(\.\d+)?", token))


def _operation(operator: str, left: Expression, right: Expression) -> Expression:
    match operator:
        case "and" | "or":
            return Logical(operator, left, right)
        case "+" | "-" | "*" | "/" | "^":
            return Binary(operator, left, right)
        case "=" | "<>" | "<" | ">" | "<=" | ">=":
            return Relation(operator, left, right)
        case _:
            raise AssertionError(operator)


def _fixed(count: int) -> Callable[[str, tuple[Expression, ...]], None]:
    def check(name: str, arguments: tuple[Expression, ...]) -> None:
        if len(arguments) != count:
            raise NotConvertible(f"'{name}' takes {count} argument(s)")

    return check


_ONE_ARGUMENT, _TWO_ARGUMENTS = _fixed(1), _fixed(2)


def _called(name: str, arguments: tuple[Expression, ...]) -> Expression:
    """Return a call by Desire's functions; of what is no word of XPPAUT, a call of the model's own."""
    if name in _SAME or name in _RENAMED:
        _ONE_ARGUMENT(name, arguments)
        return Call(_RENAMED.get(name, name), arguments)
    if name in _TWO:
        _TWO_ARGUMENTS(name, arguments)
        return Call(name, arguments)
    match name:
        case "heav":  # 1 at 0, where Desire's function of the same name is 0
            _ONE_ARGUMENT(name, arguments)
            return Relation(">=", arguments[0], Number(0.0))
        case "not":
            _ONE_ARGUMENT(name, arguments)
            return Not(arguments[0])
        case "ran":  # within 0 and its argument; Desire's within -1 and 1
            _ONE_ARGUMENT(name, arguments)
            half = Binary("/", arguments[0], Number(2.0))
            return Binary("*", half, Binary("+", Number(1.0), Call("ran", ())))
        case "normal":  # mean and standard deviation
            _TWO_ARGUMENTS(name, arguments)
            deviation = Binary("*", arguments[1], Call("gauss", (Number(0.0),)))
            return Binary("+", arguments[0], deviation)
        case _:
            return Call(name, arguments)


def constant(expression: Expression, values: dict[str, float]) -> float:
    """Return the value of an expression of numbers and of names with known values. NotConvertible."""

    def of(part: Expression) -> float:
        match part:
            case Number(value):
                return value
            case Name("PI"):
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
                raise NotConvertible("an index or a bound of a sum must be a constant")

    try:
        return of(expression)
    except (ArithmeticError, ValueError):
        raise NotConvertible("an index or a bound of a sum cannot be computed") from None


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
