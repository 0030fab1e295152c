"""XPPAUT's expressions.

Its operators have three levels, each worked off from left to right: `| + -`, then `& * /`, then `^` and the
comparisons, so that `x > 1 + y` is `(x > 1) + y` and `2^3^2` is 64. A sign at the start of an expression
stands before all of its first power. Upper and lower case are alike: names come out in lower case.
"""

from __future__ import annotations

import re

from desire_tui.convert.expressions import (
    PI,
    Binary,
    Call,
    Choice,
    Expression,
    Logical,
    Name,
    Negative,
    Number,
    Relation,
)
from desire_tui.convert.xppaut.vocabulary import MISSING, NotConvertibleError, called

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


def parsed(text: str, *, notes: list[str] | None = None) -> Expression:
    """Return the expression that a text is. NotConvertibleError.

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
            raise NotConvertibleError(
                f"'{self._text.strip()}' does not end before '{self._tokens[self._at]}'"
            )
        return expression

    def _peek(self) -> str:
        return self._tokens[self._at] if self._at < len(self._tokens) else ""

    def _take(self, wanted: str) -> None:
        if self._peek() != wanted:
            found = f"'{self._peek()}'" if self._peek() else "the end"
            raise NotConvertibleError(f"'{self._text.strip()}' has {found} where '{wanted}' was expected")
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
            self._notes.append("comparisons bind tighter than + - * /, as in XPPAUT")
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
            raise NotConvertibleError(f"'{self._text.strip()}' ends too early")
        self._at += 1
        expression = self._begun(token)
        self._bare = False
        return expression

    def _begun(self, first: str) -> Expression:
        if first == "(":
            inner = self._level(0)
            self._take(")")
            return inner
        if first[0].isdigit() or first[0] == ".":
            return Number(float(first), first if _plain(first) else "")
        if not (first[0].isalpha() or first[0] == "_"):
            raise NotConvertibleError(f"'{self._text.strip()}' cannot be read at '{first}'")
        return self._named(first.lower())

    def _named(self, name: str) -> Expression:
        if name in MISSING:
            raise NotConvertibleError(MISSING[name])
        if name == "pi":
            return PI
        if name == "if":
            return self._choice()
        if name == "sum":
            return self._sum()
        if self._peek() != "(":
            if name.endswith("'") and name != INDEX:
                raise NotConvertibleError(f"'{name}' means something in boundary conditions only")
            return Name(name)
        return called(name, self._arguments())

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
                raise NotConvertibleError(f"'{self._text.strip()}': 'if' needs 'then' and 'else'")
            self._at += 1
            ways.append(self._arguments()[0])
        return Choice(condition, ways[0], ways[1])

    def _sum(self) -> Expression:
        bounds = self._arguments()
        if self._peek().lower() != "of" or len(bounds) != 2:
            raise NotConvertibleError(f"'{self._text.strip()}': a sum is sum(a,b)of(term)")
        self._at += 1
        return Call(SUM, (*bounds, self._arguments()[0]))


def _tokens(text: str) -> list[str]:
    tokens, at = [], 0
    stripped = text.rstrip()
    while at < len(stripped):
        found = _TOKEN.match(stripped, at)
        if found is None:
            raise NotConvertibleError(f"'{stripped.strip()}' cannot be read at '{stripped[at:].strip()[:1]}'")
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
