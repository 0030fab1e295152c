"""What the productions' methods are made of: tokens that know their number, and ways to take children apart.

A node made here is a *pattern*: `start` and `end` hold token numbers, and names, numbers and strings
remember the token they came from, so that `shapes` can make the same node again from another statement's
tokens.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

from desire_tui.engine.nodes.expressions import Condition, Expr, Truth
from desire_tui.engine.nodes.record import Node
from desire_tui.engine.syntax.statement_tokens import NAME

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.nodes.files import WriteItem


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


Value = Node | Token | list[Any]
Kids = list[Any]
_EXPRESSIONS = get_args(Expr)
CONDITIONS = get_args(Condition)


class Misuse(Exception):  # noqa: N818 - the user's, not the program's
    """The grammar allows it, its meaning does not: wording key, first and last token, facts."""

    def __init__(self, key: str, first: int, last: int, facts: dict[str, object] | None = None) -> None:
        super().__init__(key)
        self.key, self.first, self.last, self.facts = key, first, last, facts


def without_separators(kids: Kids) -> list[Any]:
    """Drop the separators of a list."""
    return [kid for kid in kids if not (isinstance(kid, Token) and kid.kind in ",;")]


def names_in(kids: Iterable[Any]) -> tuple[str, ...]:
    """Keep the names of a list."""
    return tuple(kid for kid in kids if isinstance(kid, Token) and kid.kind == NAME)


def halves(kids: Kids) -> tuple[Kids, Kids]:
    """Split a list at its first `;`: by value, by reference."""
    for i, kid in enumerate(kids):
        if isinstance(kid, Token) and kid.kind == ";":
            return kids[:i], kids[i + 1 :]
    return kids, []


def nodes_in(kids: Iterable[Any]) -> tuple[Any, ...]:
    """Keep the nodes of a list."""
    return tuple(kid for kid in kids if not isinstance(kid, Token))


def plain(node: Any) -> Any:
    """Return the expression itself; a condition in its place (the grammar wants parentheses) is 1 or 0."""
    if isinstance(node, CONDITIONS):
        return Truth(node, node.start, node.end)
    return node


def condition(node: Any) -> Any:
    """Return the condition itself; an expression in its place lacks a relation."""
    if isinstance(node, _EXPRESSIONS):
        raise Misuse("relation-expected", node.start, node.end, {"word": "if"})
    return node


def channel_of(kids: Kids) -> tuple[Expr | None, Kids]:
    """Take `# n ,` from the front of a statement's children."""
    if len(kids) > 1 and isinstance(kids[1], Token) and kids[1].kind in ("#", "##"):
        rest = kids[4:]  # the statement, `#`, n, and a separator
        return plain(kids[2]), rest
    return None, kids[1:]


def mask_of(kids: Kids) -> tuple[str | None, Kids]:
    """Take `[m]` from the front."""
    if isinstance(kids[0], Token):
        return kids[1], kids[3:]
    return None, kids


def items_in(kids: Kids) -> tuple[WriteItem, ...]:
    """Give each item the separator behind it."""
    items: list[Any] = []
    for kid in kids:
        if isinstance(kid, Token):
            items[-1].separator = kid.kind
        else:
            items.append(kid)
    return tuple(items)
