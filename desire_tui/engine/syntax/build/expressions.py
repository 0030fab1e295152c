"""Productions of expressions, conditions and what stands anywhere."""

# ruff: noqa: D102 - each method is named after its production in desire.lark

from __future__ import annotations

from typing import Any, cast

from desire_tui.engine import nodes as n
from desire_tui.engine.syntax.build.children import (
    Kids,
    NumberToken,
    Token,
    condition,
    plain,
    without_separators,
)
from desire_tui.engine.syntax.literals import octal_value
from desire_tui.engine.syntax.statement_tokens import NUMBER


class ExpressionProductions:
    """Numbers to conditions; assignments."""

    def number(self, kids: Kids, first: int, last: int) -> n.Node:
        token: Token = kids[0]
        value = NumberToken(float(token) if token.kind == NUMBER else octal_value(token))
        value.kind, value.number = token.kind, token.number
        return n.Number(value, first, last)

    def name(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Name(kids[0], first, last)

    def text(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Text(kids[0], first, last)

    def element(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Element(kids[0], tuple(map(plain, without_separators(kids[2:-1]))), first, last)

    def call(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Call(kids[0], tuple(map(plain, without_separators(kids[2:-1]))), first, last)

    def group(self, kids: Kids, first: int, last: int) -> n.Node:
        inner: Any = kids[1]
        inner.start, inner.end = first, last  # carets include the parentheses
        return cast("n.Node", inner)

    def transposed(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Transposed(kids[0], first, last)

    def row_of(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.RowOf(kids[0], first, last)

    def shifted(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Shifted(kids[0], plain(kids[2]), first, last)

    def pair(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Pair(plain(kids[1]), plain(kids[3]), first, last)

    def unary(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Unary(kids[0].kind, plain(kids[1]), first, last)

    def binary(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Binary(kids[1].kind, plain(kids[0]), plain(kids[2]), first, last)

    def relation(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Relation(kids[1].kind, plain(kids[0]), plain(kids[2]), first, last)

    def negation(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Not(condition(kids[1]), first, last)

    def logical(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Logical(kids[1].kind, condition(kids[0]), condition(kids[2]), first, last)

    def assign(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Assign(kids[0], plain(kids[2]), first, last)

    def bare(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Bare(plain(kids[0]), first, last)

    def simple(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Simple(kids[0].kind, first, last)
