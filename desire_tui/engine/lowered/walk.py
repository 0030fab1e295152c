"""The one walk over expressions, and the one over statements."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.lowered.expressions import (
    Const,
    Load,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.lowered.statements import Guard

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, SimpleAction


def operands(node: Value) -> tuple[Value, ...]:
    """Return the expressions that a node computes with, in the order in which they are evaluated."""
    match node:
        case Op():
            return node.args
        case Load() | Const() | Vec() | ShiftedVec() | MatVec() | PatternRow() | Outer():
            return ()
        case Table1():
            return (node.x,)
        case Table2():
            return (node.x, node.y)
        case _:
            assert_never(node)


def walk_values(*values: Value | None) -> Iterator[Value]:
    """Every node of some expressions, outer ones first; one that stands at several places comes once.

    A loop, not recursion: FUNCTIONs of FUNCTIONs share parts, so the tree behind an expression may be
    exponentially larger than the expression, and deeper than Python's stack.
    """
    seen: set[int] = set()
    rest = [value for value in reversed(values) if value is not None]
    while rest:
        node = rest.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        yield node
        rest.extend(reversed(operands(node)))


def walk_actions(actions: Iterable[Action]) -> Iterator[Action]:
    """Every statement in order, a guard before those that it holds."""
    for action in actions:
        yield action
        if isinstance(action, Guard):
            yield from walk_actions(action.body)
            yield from walk_actions(action.orelse)


def simple_actions(actions: Iterable[Action]) -> Iterator[SimpleAction]:
    """Every statement in order, those inside guards too, the guards themselves left out."""
    for action in walk_actions(actions):
        if not isinstance(action, Guard):
            yield action


def with_bodies(guard: Guard, body: tuple[Action, ...], orelse: tuple[Action, ...]) -> Guard:
    """Return a guard that holds other statements."""
    return Guard(guard.kind, body, guard.where, guard.condition, orelse, guard.every)
