"""What expressions and statements are made of and read: the one walk that every pass over a segment uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import (
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
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    GetHistory,
    Guard,
    LearningStep,
    Set,
    SetDot,
    SetMat,
    SetVec,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

Piece = tuple[int, int]
"""A stretch of memory: its first slot, its length."""

OVER_ELEMENTS = (Vec, ShiftedVec, MatVec, PatternRow, Outer)
"""Operands that have one number for each element."""


def operands(node: Value) -> tuple[Value, ...]:
    """Return the expressions that a node computes with, in the order in which they are evaluated."""
    if isinstance(node, Op):
        return node.args
    if isinstance(node, Table1):
        return (node.x,)
    if isinstance(node, Table2):
        return (node.x, node.y)
    return ()


def walk(*values: Value | None) -> Iterator[Value]:
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


def draws(*values: Value | None) -> int:
    """Count the random numbers that one element of some expressions takes."""
    return sum(DRAWS.get(node.name, 0) for node in walk(*values) if isinstance(node, Op))


def memory(node: Value) -> tuple[Piece, ...]:
    """Return the memory that a node itself reads, its operands' left out."""
    match node:
        case Load():
            return ((node.slot, 1),)
        case Vec() | ShiftedVec():
            return ((node.slot, node.count),)
        case MatVec():
            inner = node.rows if node.transposed else node.cols
            return ((node.slot, node.rows * node.cols), (node.x_slot, inner))
        case PatternRow():
            return ((node.slot, node.rows * node.cols), (IROW, 1))
        case Outer():
            return ((node.u_slot, node.u_count), (node.v_slot, node.v_count))
        case Table1():
            return ((node.slot, 2 * node.count),)
        case Table2():
            return ((node.f_slot, node.rows * node.cols), (node.x_slot, node.rows), (node.y_slot, node.cols))
    return ()


def expressions(action: Action) -> tuple[Value, ...]:
    """Return what a statement evaluates in a pass, in order; of a guard the condition.

    Not the time of a delay: that is found before the run.
    """
    every: tuple[Value | None, ...] = ()
    match action:
        case Set() | SetVec() | Deriv() | DerivVec() | Terminate():
            every = (action.value,)
        case SetMat():
            every = (action.value, action.lower, action.upper)
        case SetDot():
            every = tuple(side for term in action.terms for side in (term.left, term.right))
        case DelayLine():
            every = (action.source,)
        case UpdateTrackHold():
            every = (action.control, action.value)
        case LearningStep():
            every = (action.rate, action.criterion)
        case Guard():
            every = (action.condition,)
    return tuple(value for value in every if value is not None)


def reads(action: Action) -> Iterator[Piece]:
    """All memory that a statement reads, what it may leave as it was included; of a guard the condition's."""
    for node in walk(*expressions(action)):
        yield from memory(node)
    match action:
        case SetVec() | SetMat():
            if action.mask_slot is not None:
                yield action.mask_slot, _size(action)
            if action.mode == "add" or (action.mask_slot is not None and isinstance(action, SetMat)):
                yield action.slot, _size(action)
        case StoreHistory():
            yield action.slot, 1
        case GetHistory():
            yield action.array_slot, action.count
        case DelayLine():
            yield action.buffer_slot, action.count
        case UpdateTrackHold():
            yield action.held_slot, 1
            yield action.tracked_slot, 1
        case LearningStep():
            yield action.weights_slot, action.out_count * action.in_count
            yield action.in_slot, action.in_count
            yield action.out_slot, action.out_count
            if action.count_slot is not None:
                yield action.count_slot, action.out_count


def writes(action: Action) -> tuple[Piece, ...]:
    """Return the memory that a statement assigns; derivatives and what a guard holds left out."""
    match action:
        case Set() | SetDot() | GetHistory():
            return ((action.slot, 1),)
        case SetVec() | SetMat():
            return ((action.slot, _size(action)),)
        case StoreHistory():
            return ((action.array_slot, action.count),)
        case DelayLine():
            return ((action.slot, 1), (action.buffer_slot, action.count))
        case UpdateTrackHold():
            return ((action.held_slot, 1), (action.tracked_slot, 1))
        case LearningStep():
            own = (
                (action.weights_slot, action.out_count * action.in_count),
                (action.out_slot, action.out_count),
            )
            counts = () if action.count_slot is None else ((action.count_slot, action.out_count),)
            full = () if action.full_slot is None else ((action.full_slot, 1),)
            return (*own, *counts, *full)
    return ()


def _size(action: SetVec | SetMat) -> int:
    return action.count if isinstance(action, SetVec) else action.rows * action.cols
