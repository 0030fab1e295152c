"""Productions of expressions, conditions and what stands anywhere."""

# ruff: noqa: D102 - each method is named after its production in desire.lark

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from desire_tui.engine.nodes.assignments import Assign, Bare
from desire_tui.engine.nodes.commands import Simple
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
    Unary,
)
from desire_tui.engine.syntax.build.children import (
    Kids,
    Misuse,
    NumberToken,
    Token,
    condition,
    nodes_in,
    plain,
    without_separators,
)
from desire_tui.engine.syntax.literals import octal_value
from desire_tui.engine.syntax.statement_tokens import NUMBER

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Condition, Expr
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.statements import Statement


class ExpressionProductions:
    """Numbers to conditions; assignments."""

    def number(self, kids: Kids, first: int, last: int) -> Expr:
        token: Token = kids[0]
        value = NumberToken(float(token) if token.kind == NUMBER else octal_value(token))
        value.kind, value.number = token.kind, token.number
        return Number(value, first, last)

    def name(self, kids: Kids, first: int, last: int) -> Expr:
        return Name(kids[0], first, last)

    def text(self, kids: Kids, first: int, last: int) -> Expr:
        return Text(kids[0], first, last)

    def element(self, kids: Kids, first: int, last: int) -> Expr:
        return Element(kids[0], tuple(map(plain, without_separators(kids[2:-1]))), first, last)

    def call(self, kids: Kids, first: int, last: int) -> Expr:
        return Call(kids[0], tuple(map(plain, without_separators(kids[2:-1]))), first, last)

    def group(self, kids: Kids, first: int, last: int) -> Node:
        inner: Any = kids[1]
        inner.start, inner.end = first, last  # carets include the parentheses
        return cast("Node", inner)

    def transposed(self, kids: Kids, first: int, last: int) -> Expr:
        return Transposed(kids[0], first, last)

    def row_of(self, kids: Kids, first: int, last: int) -> Expr:
        return RowOf(kids[0], first, last)

    def shifted(self, kids: Kids, first: int, last: int) -> Expr:
        return Shifted(kids[0], plain(kids[2]), first, last)

    def pair(self, kids: Kids, first: int, last: int) -> Expr:
        return Pair(plain(kids[1]), plain(kids[3]), first, last)

    def unary(self, kids: Kids, first: int, last: int) -> Expr:
        return Unary(kids[0].kind, plain(kids[1]), first, last)

    def binary(self, kids: Kids, first: int, last: int) -> Expr:
        return Binary(kids[1].kind, plain(kids[0]), plain(kids[2]), first, last)

    def relation(self, kids: Kids, first: int, last: int) -> Condition:
        return Relation(kids[1].kind, plain(kids[0]), plain(kids[2]), first, last)

    def negation(self, kids: Kids, first: int, last: int) -> Condition:
        return Not(condition(kids[1]), first, last)

    def logical(self, kids: Kids, first: int, last: int) -> Condition:
        return Logical(kids[1].kind, condition(kids[0]), condition(kids[2]), first, last)

    def assign(self, kids: Kids, first: int, last: int) -> Statement:
        return Assign(kids[0], plain(kids[2]), first, last)

    def bare(self, kids: Kids, first: int, last: int) -> Statement:
        return Bare(plain(kids[0]), first, last)

    def mixed_brackets(self, kids: Kids, first: int, last: int) -> Statement:
        """`s[a, b)`: either bracket opens and closes the list of a submodel, whose arguments are names."""
        args = nodes_in(kids)
        if all(isinstance(arg, Name) for arg in args):
            return Bare(Call(kids[0], args, first, last), first, last)
        key = "bracket-unclosed" if kids[1].kind == "[" else "parenthesis-unclosed"
        closer = kids[-1]
        facts = {"at": closer, "closer": "]", "before": f" before '{closer}'"}
        raise Misuse(key, closer.number, closer.number, facts)

    def simple(self, kids: Kids, first: int, last: int) -> Statement:
        return Simple(kids[0].kind, first, last)
