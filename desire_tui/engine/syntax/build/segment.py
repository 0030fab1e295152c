"""Productions of vector and matrix statements and of DYNAMIC segments."""

# ruff: noqa: D102 - each method is named after its production in desire.lark

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.assignments import Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.display import Request
from desire_tui.engine.nodes.expressions import Call, Name, RowOf
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    Fast,
    FunctionTable,
    Get,
    Learn,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)
from desire_tui.engine.syntax.build.children import (
    Kids,
    Token,
    channel_of,
    mask_of,
    names_in,
    nodes_in,
    plain,
)

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.statements import Statement


def _bounds(rest: Kids) -> tuple[Expr | None, Expr | None]:
    """Return what stands behind the `;` of a sum."""
    return (plain(rest[2]), plain(rest[4])) if len(rest) > 1 else (None, None)


class Dynamic:
    """Vectors, matrices, derivatives, delays, requests, learning."""

    def derivative(self, kids: Kids, first: int, last: int) -> Statement:
        target, value = nodes_in(kids)
        return Derivative(target, plain(value), first, last)

    def vector_derivative(self, kids: Kids, first: int, last: int) -> Statement:
        (name,), value = names_in(kids), kids[-1]
        return VectorDerivative(name, plain(value), first, last)

    def vector(self, kids: Kids, first: int, last: int) -> Statement:
        delta = kids[0].kind == "Delta" or kids[1].kind == "delta"
        largest = not delta and kids[2].kind == "^"
        at = 2 if kids[1].kind == "delta" else 1
        mask, rest = mask_of(kids[kids.index("=") + 1 :])
        lower, upper = _bounds(rest)
        return VectorAssign(kids[at], plain(rest[0]), delta, largest, mask, lower, upper, first, last)

    def matrix(self, kids: Kids, first: int, last: int) -> Statement:
        mask, rest = mask_of(kids[3:])
        lower, upper = _bounds(rest)
        return MatrixAssign(kids[1], plain(rest[0]), kids[0].kind == "DELTA", mask, lower, upper, first, last)

    def dot(self, kids: Kids, first: int, last: int) -> Statement:
        return Dot(kids[1], plain(kids[3]), kids[0].kind == "AVG", first, last)

    def store(self, kids: Kids, first: int, last: int) -> Statement:
        return Store(kids[1], kids[3], first, last)

    def get(self, kids: Kids, first: int, last: int) -> Statement:
        return Get(kids[1], kids[3], first, last)

    def delay(self, kids: Kids, first: int, last: int) -> Statement:
        return Delay(kids[1], kids[3], plain(kids[5]), plain(kids[7]), kids[0].kind == "tdelay", first, last)

    def track_hold(self, kids: Kids, first: int, last: int) -> Statement:
        return TrackHold(kids[1], kids[3], plain(kids[5]), plain(kids[7]), first, last)

    def table(self, kids: Kids, first: int, last: int) -> Statement:
        """`func y = F(x` means func1(x; F); `func2 f = F(x, y; X, Y` means func2(x, y; F, X, Y)."""
        array: Token = kids[3]
        arguments = list(map(plain, nodes_in(kids[5:])))
        table = Name(array, array.number, array.number)
        if kids[0].kind == "func":
            call = Call("func1", (*arguments, table), array.number, last)
        else:
            call = Call("func2", (*arguments[:2], table, *arguments[2:]), array.number, last)
        return FunctionTable(kids[1], call, first, last)

    def term(self, kids: Kids, first: int, last: int) -> Statement:
        return Term(plain(kids[1]), first, last)

    def sample(self, kids: Kids, first: int, last: int) -> Statement:
        return Sample(plain(kids[1]), first, last)

    def event(self, kids: Kids, first: int, last: int) -> Statement:
        return Event(plain(kids[1]), first, last)

    def every(self, kids: Kids, first: int, last: int) -> Statement:
        start = plain(kids[3]) if len(kids) > 3 else None
        return Every(plain(kids[1]), start, first, last)

    def fast(self, kids: Kids, first: int, last: int) -> Statement:
        del kids
        return Fast(first, last)

    def request(self, kids: Kids, first: int, last: int) -> Statement:
        channel, rest = channel_of(kids)
        return Request(kids[0].kind, channel, nodes_in(rest), first, last)

    def learn(self, kids: Kids, first: int, last: int) -> Statement:
        kind, output, weights, source = kids[0].kind, kids[1], kids[3], kids[5]
        rate, *criteria = map(plain, nodes_in(kids))
        if kind != "CLEARN":
            return Learn(kind, output, weights, source, rate, None, fast=False, start=first, end=last)
        (criterion,) = criteria
        fast = isinstance(kids[-1], Token)
        if isinstance(criterion, RowOf):  # `crit#`: the mark of fast learning, not a row of a matrix
            criterion, fast = Name(criterion.name, criterion.start, criterion.start), True
        return Learn(kind, output, weights, source, rate, criterion, fast, first, last)
