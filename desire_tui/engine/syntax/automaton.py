"""Steps through the LALR tables over the tokens of one statement.

Why not lark's own loop: it would need lark imported at every start (50 ms), tokens as lark objects, and it
hides the stack, which the messages need. The loop below is the textbook's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from desire_tui.engine.left_chains import OPERATORS
from desire_tui.engine.syntax.build import Misuse, NodeBuilder
from desire_tui.engine.syntax.lalr_tables import tables

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.syntax.build import Value

HEIGHT_MAX = 200
"""Levels of an expression's tree: later passes recurse, twice for each level at worst."""
PIECE_HEIGHT = 100
"""Left operands of this height count no more: long chains are computed in pieces (`engine.left_chains`)."""


class Unexpected(Exception):  # noqa: N818 - not an error of this program
    """The token number `at` (one past the last: the statement's end) cannot stand there; `expected` could."""

    def __init__(self, at: int, expected: frozenset[str]) -> None:
        super().__init__(at)
        self.at, self.expected = at, expected


def derive(kinds: Sequence[str], texts: Sequence[str]) -> Statement:
    """Return the statement's node with token numbers for offsets (`start` the first, `end` the last token's).

    Raises Unexpected, or Misuse where the grammar's shape is right but its meaning is not.
    """
    table = tables()
    actions, gotos, rules = table.actions, table.gotos, table.rules
    builder = NodeBuilder()
    states = [table.start]
    values: list[Value] = []
    firsts: list[int] = []
    lasts: list[int] = []
    heights: list[int] = []
    at, count = 0, len(kinds)
    while True:
        kind = kinds[at] if at < count else "$END"
        move = actions[states[-1]].get(kind)
        if move is None:
            raise Unexpected(at, _expected(states))
        if move >= 0:
            states.append(move)
            values.append(builder.token(kind, texts[at], at))
            firsts.append(at)
            lasts.append(at)
            heights.append(0)
            at += 1
            continue
        origin, size, method, splice = rules[-1 - move]
        if size == 1 and not method:
            # Chains such as atom → power → signed → product → sum are most of the work: only a state changes.
            if splice and not isinstance(values[-1], list):
                values[-1] = [values[-1]]
            states[-1] = gotos[states[-2]][origin]
        else:
            children = values[-size:]
            first, last = firsts[-size], lasts[-1]
            if size == 3 and heights[-3] >= PIECE_HEIGHT and kinds[lasts[-2]] in OPERATORS:
                heights[-3] = 0
            height = max(heights[-size:])
            del states[-size:], values[-size:], firsts[-size:], lasts[-size:], heights[-size:]
            if method:
                height += 1
                if height > HEIGHT_MAX:
                    raise Misuse("expression-too-deep", first, last, {"limit": HEIGHT_MAX})
                values.append(builder.make(method, _flat(children), first, last))
            else:
                values.append(_flat(children))
            firsts.append(first)
            lasts.append(last)
            heights.append(height)
            states.append(gotos[states[-1]][origin])
        if states[-1] == table.accept and at == count:
            return cast("Statement", values[-1])  # the start symbol makes nothing else


def _flat(children: list[Value]) -> list[Value]:
    """Splice lists into their parent; the first child's list is reused: long lists grow in linear time."""
    flat = children[0] if isinstance(children[0], list) else [children[0]]
    for child in children[1:]:
        if isinstance(child, list):
            flat.extend(child)
        else:
            flat.append(child)
    return flat


def _expected(states: list[int]) -> frozenset[str]:
    """Return the kinds that can really follow: LALR states list more, which reductions would refuse."""
    table = tables()
    return frozenset(kind for kind in table.actions[states[-1]] if _accepts(list(states), kind))


def _accepts(states: list[int], kind: str) -> bool:
    table = tables()
    while True:
        move = table.actions[states[-1]].get(kind)
        if move is None:
            return False
        if move >= 0:
            return True
        rule = table.rules[-1 - move]
        del states[-rule.size :]
        states.append(table.gotos[states[-1]][rule.origin])
        if states[-1] == table.accept:
            return kind == "$END"
