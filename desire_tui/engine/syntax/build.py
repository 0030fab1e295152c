"""One method for each production of `desire.lark`: children in, node out.

A node made here is a *pattern*: `start` and `end` hold token numbers, and names, numbers and strings remember the
token they came from, so that `shapes` can make the same node again from another statement's tokens.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Union, cast

from desire_tui.engine import nodes as n
from desire_tui.engine.syntax.tokens import MATFUN, NAME, NUMBER, OCTAL, STRING, octal_value

if TYPE_CHECKING:
    from collections.abc import Iterable


class Token(str):
    """A token's text that knows its kind and its number in the statement."""

    __slots__ = ("kind", "number")
    kind: str
    number: int


class NumberToken(float):
    """A number's value that knows its token."""

    __slots__ = ("kind", "number")
    kind: str
    number: int


DIMENSIONS_MAX = 10

Value = Union[n.Node, Token, list[Any]]
Kids = list[Any]
_EXPRESSIONS = (
    n.Number, n.Text, n.Name, n.Element, n.Call, n.Unary, n.Binary, n.Transposed, n.Shifted, n.RowOf, n.Pair,
)  # fmt: skip
_CONDITIONS = (n.Relation, n.Logical, n.Not)


@dataclass(frozen=True, slots=True)
class Misuse(Exception):  # noqa: N818 - the user's, not the program's
    """The grammar allows it, its meaning does not: wording key, first and last token, facts."""

    key: str
    first: int
    last: int
    facts: dict[str, object] = field(default_factory=dict)


def _split(kids: Kids, start: int = 0) -> list[Any]:
    """Drop the separators of a list."""
    return [kid for kid in kids[start:] if not (isinstance(kid, Token) and kid.kind in ",;")]


def _names(kids: Iterable[Any]) -> tuple[str, ...]:
    return tuple(kid for kid in kids if isinstance(kid, Token) and kid.kind == NAME)


def _halves(kids: Kids) -> tuple[Kids, Kids]:
    """Split a list at its first `;`: by value, by reference."""
    for i, kid in enumerate(kids):
        if isinstance(kid, Token) and kid.kind == ";":
            return kids[:i], kids[i + 1 :]
    return kids, []


def _nodes(kids: Iterable[Any]) -> tuple[Any, ...]:
    return tuple(kid for kid in kids if not isinstance(kid, Token))


def _plain(node: Any) -> Any:
    """The expression itself; a relation in its place is a misuse."""
    if isinstance(node, _CONDITIONS):
        raise Misuse("relation-misplaced", node.start, node.end)
    return node


def _condition(node: Any) -> Any:
    """The condition itself; an expression in its place lacks a relation."""
    if isinstance(node, _EXPRESSIONS):
        raise Misuse("relation-expected", node.start, node.end, {"word": "if"})
    return node


def _channel(kids: Kids) -> tuple[n.Expr | None, Kids]:
    """Take `# n ,` from the front of a statement's children."""
    if len(kids) > 1 and isinstance(kids[1], Token) and kids[1].kind in ("#", "##"):
        rest = kids[4:]  # the statement, `#`, n, and a separator
        return kids[2], rest
    return None, kids[1:]


class Builder:
    """The productions' methods. `kids` are the children, tokens included; offsets are token numbers."""

    def token(self, kind: str, text: str, index: int) -> Token:
        """Wrap a token."""
        token = Token(text)
        token.kind, token.number = kind, index
        return token

    def make(self, method: str, kids: Kids, first: int, last: int) -> n.Node:
        """Make the node of a production."""
        return cast("n.Node", getattr(self, method)(kids, first, last))

    # ------------------------------------------------------------------------------------- expressions

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
        return n.Element(kids[0], tuple(map(_plain, _split(kids[2:-1]))), first, last)

    def call(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Call(kids[0], tuple(map(_plain, _split(kids[2:-1]))), first, last)

    def group(self, kids: Kids, first: int, last: int) -> n.Node:
        inner: Any = kids[1]
        inner.start, inner.end = first, last  # carets include the parentheses
        return cast("n.Node", inner)

    def transposed(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Transposed(kids[0], first, last)

    def row_of(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.RowOf(kids[0], first, last)

    def shifted(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Shifted(kids[0], _plain(kids[2]), first, last)

    def pair(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Pair(_plain(kids[1]), _plain(kids[3]), first, last)

    def unary(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Unary(kids[0].kind, _plain(kids[1]), first, last)

    def binary(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Binary(kids[1].kind, _plain(kids[0]), _plain(kids[2]), first, last)

    def relation(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Relation(kids[1].kind, _plain(kids[0]), _plain(kids[2]), first, last)

    def negation(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Not(_condition(kids[1]), first, last)

    def logical(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Logical(kids[1].kind, _condition(kids[0]), _condition(kids[2]), first, last)

    # ------------------------------------------------------------------------------------- anywhere

    def assign(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Assign(kids[0], _plain(kids[2]), first, last)

    def bare(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Bare(_plain(kids[0]), first, last)

    def simple(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Simple(kids[0].kind, first, last)

    # ------------------------------------------------------------------------------------- blocks and jumps

    def if_then(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.If(_condition(kids[1]), None, first, last)

    def if_positive(self, kids: Kids, first: int, last: int) -> n.Node:
        if isinstance(kids[1], _CONDITIONS):
            raise Misuse("then-missing", kids[1].start, kids[1].end)
        return n.If(None, kids[1], first, last)

    def for_(self, kids: Kids, first: int, last: int) -> n.Node:
        by = _plain(kids[7]) if len(kids) > 6 else None
        return n.For(kids[1], _plain(kids[3]), _plain(kids[5]), by, first, last)

    def while_(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.While(_condition(kids[1]), first, last)

    def until(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Until(_condition(kids[1]), first, last)

    def label(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Label(kids[1], first, last)

    def go_to(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.GoTo(kids[1], first, last)

    def restore(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Restore(kids[1] if len(kids) > 1 else None, first, last)

    def call_procedure(self, kids: Kids, first: int, last: int) -> n.Node:
        values, references = _halves(kids[3:-1])
        return n.CallProcedure(
            kids[1], tuple(map(_plain, _nodes(values))), tuple(map(_plain, _nodes(references))), first, last
        )

    def invoke(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Invoke(kids[1], tuple(map(_plain, _nodes(kids[3:-1]))), first, last)

    def drun(self, kids: Kids, first: int, last: int) -> n.Node:
        star = len(kids) > 1 and kids[1].kind == "*"
        label = kids[1] if len(kids) > 1 and not star else None
        return n.Drun(label, kids[0].kind == "drunr", star, first, last)

    # ------------------------------------------------------------------------------------- declarations

    def declare(self, kids: Kids, first: int, last: int) -> n.Node:
        groups = _nodes(kids)
        for part in (part for group in groups for part in group.parts):
            if kids[0].kind == "ARRAY" and not part.dimensions:
                raise Misuse("dimensions-missing", part.start, part.end)
        return n.Declare(kids[0].kind, groups, first, last)

    def declared_group(self, kids: Kids, first: int, last: int) -> n.Node:
        whole = kids[-1] if isinstance(kids[-1], Token) else None
        return n.DeclaredGroup(_nodes(kids), whole, first, last)

    def declared(self, kids: Kids, first: int, last: int) -> n.Node:
        dimensions = tuple(map(_plain, _nodes(kids)))
        if len(dimensions) > DIMENSIONS_MAX:
            raise Misuse("dimensions-too-many", first, last, {"limit": DIMENSIONS_MAX})
        return n.Declared(kids[0], dimensions, first, last)

    def procedure(self, kids: Kids, first: int, last: int) -> n.Node:
        values, references = _halves(kids[2:])
        return n.Procedure(kids[1], _names(values), _names(references), first, last)

    def submodel(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Submodel(kids[1], _names(kids[2:]), first, last)

    def function(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Function(kids[1], _names(kids[2:]), _plain(kids[-1]), first, last)

    # ------------------------------------------------------------------------------------- script

    def data(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Data(tuple(map(_plain, _nodes(kids))), first, last)

    def read(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Read(_nodes(kids), first, last)

    def input(self, kids: Kids, first: int, last: int) -> n.Node:
        channel, rest = _channel(kids)
        return n.Input(channel, _nodes(rest), first, last)

    def write(self, kids: Kids, first: int, last: int) -> n.Node:
        channel, rest = _channel(kids)
        raw = channel is not None and kids[1].kind == "##"
        return n.Write(channel, raw, _items(rest), first, last)

    def note(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Note(_items(kids[1:]), first, last)

    def item(self, kids: Kids, first: int, last: int) -> n.Node:
        form: Any = kids[0].kind if len(kids) > 1 else ""
        return n.WriteItem(_plain(kids[-1]), form, "", first, last)

    def connect(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Connect(kids[1], kids[3].kind, _plain(kids[4]), first, last)

    def disconnect(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Disconnect(tuple(map(_plain, _nodes(kids))), first, last)

    def dump(self, kids: Kids, first: int, last: int) -> n.Node:
        if len(kids) > 1 and kids[1].kind == "run":
            return n.Dump(None, "run", first, last)
        return n.Dump(kids[2] if len(kids) > 2 else None, "all", first, last)

    def irule(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Irule(_plain(kids[1]) if len(kids) > 1 else None, first, last)

    def seed(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Seed(_plain(kids[1]), first, last)

    def fft(self, kids: Kids, first: int, last: int) -> n.Node:
        args = tuple(map(_plain, _nodes(kids)))
        if len(args) != (5 if kids[1] == "R" else 3):
            raise Misuse("fft-form", first, last)
        return n.Fft(kids[1], args, first, last)

    def display(self, kids: Kids, first: int, last: int) -> n.Node:
        mode, args = kids[1], tuple(map(_plain, _nodes(kids)))
        wanted = {"C": 1, "N": 1, "W": 2}.get(mode, 0)
        if len(args) != wanted:
            raise Misuse("display-form", first, last, {"mode": str(mode), "wanted": ("no numbers", "one number", "two numbers")[wanted]})
        return n.Display(mode, args, first, last)

    def plot(self, kids: Kids, first: int, last: int) -> n.Node:
        args = tuple(map(_plain, _nodes(kids)))
        if len(args) > 3:
            raise Misuse("plot-form", first, last)
        return n.Plot(args, first, last)

    def show(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Show(kids[1], _plain(kids[3]) if len(kids) > 3 else None, first, last)

    def file_command(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.FileCommand(kids[0].kind, kids[1] if len(kids) > 1 else None, first, last)

    # ------------------------------------------------------------------------------------- vectors

    def derivative(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Derivative(kids[1], _plain(kids[3]), first, last)

    def vector_derivative(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.VectorDerivative(kids[2], _plain(kids[4]), first, last)

    def vector(self, kids: Kids, first: int, last: int) -> n.Node:
        delta = kids[0].kind == "Delta" or kids[1].kind == "delta"
        largest = not delta and kids[2].kind == "^"
        at = 2 if kids[1].kind == "delta" else 1
        mask, rest = _mask(kids[kids.index("=") + 1 :])
        return n.VectorAssign(kids[at], _plain(rest[0]), delta, largest, mask, first, last)

    def matrix(self, kids: Kids, first: int, last: int) -> n.Node:
        mask, rest = _mask(kids[3:])
        lower, upper = (_plain(rest[2]), _plain(rest[4])) if len(rest) > 1 else (None, None)
        return n.MatrixAssign(kids[1], _plain(rest[0]), kids[0].kind == "DELTA", mask, lower, upper, first, last)

    def dot(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Dot(kids[1], _plain(kids[3]), kids[0].kind == "AVG", first, last)

    # ------------------------------------------------------------------------------------- segments

    def store(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Store(kids[1], kids[3], first, last)

    def get(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Get(kids[1], kids[3], first, last)

    def delay(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Delay(
            kids[1], kids[3], _plain(kids[5]), _plain(kids[7]), kids[0].kind == "tdelay", first, last
        )

    def track_hold(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.TrackHold(kids[1], kids[3], _plain(kids[5]), _plain(kids[7]), first, last)

    def table(self, kids: Kids, first: int, last: int) -> n.Node:
        """`func y = F(x` means func1(x; F); `func2 f = F(x, y; X, Y` means func2(x, y; F, X, Y)."""
        array: Token = kids[3]
        arguments = list(map(_plain, _nodes(kids[5:])))
        table = n.Name(array, array.number, array.number)
        if kids[0].kind == "func":
            call = n.Call("func1", (*arguments, table), array.number, last)
        else:
            call = n.Call("func2", (*arguments[:2], table, *arguments[2:]), array.number, last)
        return n.FunctionTable(kids[1], call, first, last)

    def term(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Term(_plain(kids[1]), first, last)

    def sample(self, kids: Kids, first: int, last: int) -> n.Node:
        return n.Sample(_plain(kids[1]), first, last)

    def request(self, kids: Kids, first: int, last: int) -> n.Node:
        channel, rest = _channel(kids)
        return n.Request(kids[0].kind, channel, _nodes(rest), first, last)

    def learn(self, kids: Kids, first: int, last: int) -> n.Node:
        kind, output, weights, source = kids[0].kind, kids[1], kids[3], kids[5]
        if kind != "CLEARN":
            return n.Learn(kind, output, weights, source, _plain(kids[7]), None, conscience=False, start=first, end=last)
        criterion = _plain(kids[9])
        conscience = len(kids) > 10
        if isinstance(criterion, n.RowOf):  # `crit#`: the mark of the conscience, not a row of a matrix
            criterion, conscience = n.Name(criterion.name, criterion.start, criterion.start), True
        return n.Learn(kind, output, weights, source, _plain(kids[7]), criterion, conscience, first, last)



def _mask(kids: Kids) -> tuple[str | None, Kids]:
    """Take `[m]` from the front."""
    if isinstance(kids[0], Token):
        return kids[1], kids[3:]
    return None, kids


def _items(kids: Kids) -> tuple[n.WriteItem, ...]:
    """Give each item the separator behind it."""
    items: list[Any] = []
    for kid in kids:
        if isinstance(kid, Token):
            items[-1].separator = kid.kind
        else:
            items.append(kid)
    return tuple(items)


__all__ = ["MATFUN", "OCTAL", "STRING", "Builder", "Misuse", "NumberToken", "Token", "Value"]
