"""Expressions and conditions as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.left_chains import chain
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Logical,
    Name,
    Not,
    Number,
    Pair,
    Relation,
    RowOf,
    Shifted,
    Text,
    Transposed,
    Truth,
    Unary,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.nodes.expressions import Condition, Expr

_BINDS = {"+": 1, "-": 1, "*": 2, "/": 2, "&": 2, "^": 4}
_SIGN = 3
_ATOM = 5


def expression(node: Expr, binds: int = 0) -> str:
    """Return an expression, in parentheses where its operator binds less tightly than `binds`."""
    text, own = _bare_expr(node)
    return f"({text})" if own < binds else text


def _bare_expr(node: Expr) -> tuple[str, int]:
    match node:
        case Number(value):
            return format_number(value), _ATOM
        case Text(value):
            return quoted(value), _ATOM
        case Name(name):
            return name, _ATOM
        case Element(name, subscripts):
            return f"{name}[{listed(subscripts)}]", _ATOM
        case Call(name, args):
            return f"{name}({listed(args)})", _ATOM
        case Transposed(name):
            return f"{name}%", _ATOM
        case RowOf(name):
            return f"{name}#", _ATOM
        case Shifted(name, by):
            return f"{name}{{{expression(by)}}}", _ATOM
        case Pair(re, im):
            return f"[{expression(re)}, {expression(im)}]", _ATOM
        case Truth(holds):
            return f"({condition(holds)})", _ATOM
        case Unary(op, operand):
            return f"{op}{_operand(op, expression(operand, _SIGN))}", _SIGN
        case Binary("^", left, right):
            # A sign may follow `^` without parentheses, a sign before it belongs to the whole power.
            exponent = expression(right, _SIGN)
            return f"{expression(left, _ATOM)}^{exponent}", _BINDS["^"]
        case Binary():
            return _chain(node)
    assert_never(node)


def _chain(node: Binary) -> tuple[str, int]:
    """Write a sum or product; a sum on the left of `*` needs parentheses, the other way round it does not."""
    first, steps = chain(node)
    text, binds = _bare_expr(first)
    pieces, opened = [text], 0
    for step in steps:
        own = _BINDS[step.op]
        if binds < own:
            opened += 1
            pieces.append(")")
        pieces.append(f" {step.op} {expression(step.right, own + 1)}")
        binds = own
    return "(" * opened + "".join(pieces), binds


def _operand(sign: str, text: str) -> str:
    """Keep two minus signs apart: `--` would begin a comment."""
    return f" {text}" if sign == "-" and text.startswith("-") else text


def condition(node: Condition, binds: int = 0) -> str:
    """Return a condition, in parentheses where its operator binds less tightly than `binds`."""
    match node:
        case Relation(op, left, right):
            return f"{expression(left, 1)} {op} {expression(right, 1)}"
        case Not(operand):
            inner = condition(operand, 3)
            # `not` is a word only before a name, a number or a parenthesis.
            return f"not {inner}" if inner.startswith("(") else f"not ({condition(operand)})"
        case Logical(op, left, right):
            own = 2 if op == "and" else 1
            text = f"{condition(left, own)} {op} {condition(right, own + 1)}"
            return f"({text})" if own < binds else text
    assert_never(node)


def format_number(value: float) -> str:
    """Return the shortest text that reads back as the same number.

    Only hexadecimal literals are negative (`&&FFFF` is −1); infinite values cannot be written.
    """
    if value < 0 and value == int(value):
        return f"&&{int(value) + 0x10000:X}"
    if value == int(value) and abs(value) < 1e16:  # repr changes to exponents there
        return str(int(value))
    return repr(value)


def quoted(text: str) -> str:
    """Return a string between the quotes that it does not hold."""
    return f'"{text}"' if "'" in text else f"'{text}'"


def listed(items: Iterable[Expr]) -> str:
    """Return expressions between commas."""
    return ", ".join(map(expression, items))
