"""Which slots a segment's statements touch, and how."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from desire_tui.engine.lowered import (
    Const,
    DelayLine,
    Deriv,
    DerivVec,
    Get,
    Guard,
    Learn,
    Load,
    MatVec,
    Op,
    Outer,
    RowOf,
    Set,
    SetDot,
    SetMat,
    SetVec,
    Shifted,
    Store,
    Table1,
    Table2,
    Terminate,
    TrackHold,
    Vec,
)  # fmt: skip
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered import Action, Value


@dataclass(slots=True)
class Scope:
    """Scalar slots read and written one by one; arrays (slot, count); `only_scalars`: no array operand."""

    read: set[int] = field(default_factory=set)
    written: set[int] = field(default_factory=set)
    arrays: set[tuple[int, int]] = field(default_factory=set)
    only_scalars: bool = True
    statements: int = 0
    guarded: bool = False

    @property
    def pinned(self) -> frozenset[int]:
        """Scalars that are elements of arrays which other statements reach by address."""
        return frozenset(
            s
            for s in self.read | self.written
            if any(slot <= s < slot + count for slot, count in self.arrays)
        )


def survey(passes: Iterable[Iterable[Action]]) -> Scope:
    """Look through all statements of all passes."""
    scope = Scope()
    seen: set[int] = set()
    for actions in passes:
        for action in actions:
            if id(action) not in seen:
                seen.add(id(action))
                _action(action, scope)
    return scope


def _action(action: Action, scope: Scope) -> None:
    scope.statements += 1
    match action:
        case Set():
            scope.written.add(action.slot)
            value(action.value, scope)
        case Deriv() | Terminate():
            value(action.value, scope)
        case Guard():
            scope.guarded = True
            if action.condition is not None:
                value(action.condition, scope)
            for inner in (*action.body, *action.orelse):
                _action(inner, scope)
        case Store():
            scope.read.add(action.slot)
            scope.arrays.add((action.array_slot, action.count))
        case Get():
            scope.written.add(action.slot)
            scope.arrays.add((action.array_slot, action.count))
        case DelayLine():
            scope.written.add(action.slot)
            scope.arrays.add((action.buffer_slot, action.count))
            value(action.source, scope)
            value(action.tau, scope)
        case TrackHold():
            scope.written.update((action.held_slot, action.tracked_slot))
            value(action.control, scope)
            value(action.value, scope)
        case _:
            scope.only_scalars = False
            _over_arrays(action, scope)


def _over_arrays(action: Action, scope: Scope) -> None:
    match action:
        case SetVec():
            scope.arrays.add((action.slot, action.count))
            value(action.value, scope)
        case SetMat():
            scope.arrays.add((action.slot, action.rows * action.cols))
            for part in (action.value, action.lower, action.upper):
                if part is not None:
                    value(part, scope)
        case DerivVec():
            value(action.value, scope)
        case SetDot():
            scope.written.add(action.slot)
            for term in action.terms:
                value(term.left, scope)
                if term.right is not None:
                    value(term.right, scope)
        case Learn():
            scope.arrays.add((action.out_slot, action.out_count))
            scope.arrays.add((action.in_slot, action.in_count))
            scope.arrays.add((action.weights_slot, action.in_count * action.out_count))


def value(node: Value, scope: Scope) -> None:
    """Look through a value."""
    match node:
        case Const():
            pass
        case Load():
            scope.read.add(node.slot)
        case Op():
            for arg in node.args:
                value(arg, scope)
        case Table1():
            scope.arrays.add((node.slot, 2 * node.count))
            value(node.x, scope)
        case Table2():
            scope.arrays.update(
                ((node.f_slot, node.rows * node.cols), (node.x_slot, node.rows), (node.y_slot, node.cols))
            )
            value(node.x, scope)
            value(node.y, scope)
        case Vec() | Shifted():
            scope.only_scalars = False
            scope.arrays.add((node.slot, node.count))
        case MatVec():
            scope.only_scalars = False
            scope.arrays.add((node.slot, node.rows * node.cols))
            scope.arrays.add((node.x_slot, node.rows if node.transposed else node.cols))
        case RowOf():
            scope.only_scalars = False
            scope.read.add(IROW)
            scope.arrays.add((node.slot, node.rows * node.cols))
        case Outer():
            scope.only_scalars = False
            scope.arrays.update(((node.u_slot, node.u_count), (node.v_slot, node.v_count)))
