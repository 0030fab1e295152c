"""The one walk over the parts of a statement or an expression.

It visits every field of every node, so that a new class of nodes needs nothing here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.declarations import Function
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.record import Node

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.statements import Statement

_fields: dict[type[Node], tuple[str, ...]] = {}
"""Fields that may hold nodes, by class."""


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all its parts, from left to right, however deep they nest."""
    rest: list[object] = [node]
    while rest:
        part = rest.pop()
        if isinstance(part, tuple):
            rest.extend(reversed(part))
        elif isinstance(part, Node):
            yield part
            rest.extend([getattr(part, field) for field in reversed(_fields_of(part.__class__))])


def parts_read(statement: Statement) -> Iterator[Name | Element | Call]:
    """Yield every name, element and call of a statement; of a FUNCTION's body all but its dummies.

    Targets are among them, which does no harm: they are assigned.
    """
    own = statement.dummies if isinstance(statement, Function) else ()
    for part in walk(statement):
        if isinstance(part, Name | Element | Call) and part.name not in own:
            yield part


def _fields_of(kind: type[Node]) -> tuple[str, ...]:
    known = _fields.get(kind)
    if known is None:
        slots: tuple[str, ...] = getattr(kind, "__slots__", ())
        known = _fields[kind] = tuple(s for s in slots if s not in {"start", "end", "name"})
    return known
