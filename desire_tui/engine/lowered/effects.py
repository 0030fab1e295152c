"""What expressions and statements read, write and do besides: everything that passes and back ends ask.

A new class of expression or statement is described here once; code that asks these functions instead of
looking at classes need not change for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, assert_never

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
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    EffectAction,
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
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action, SimpleAction


class ArrayPiece(NamedTuple):
    """An array that is reached by its address, whatever its length: its first slot, its length."""

    slot: int
    length: int


Piece = tuple[int, int] | ArrayPiece
"""A stretch of memory: its first slot, its length. Scalars are plain tuples of length 1."""

Role = Literal["derivative", "definition", "effect"]
"""A statement gives a derivative, or computes a defined variable from others and nothing else, or does more:
remembers, draws, learns, ends the run."""

Timing = Literal["always", "point", "step"]
"""A statement runs in every pass, or only at communication points (COMM), or only at steps' starts (STEP)."""


def count_draws(*values: Value | None) -> int:
    """Count the random numbers that one element of some expressions takes."""
    return _facts(values).draws


class _Facts(NamedTuple):
    """The memory that expressions read, and how many random numbers they take."""

    reads: tuple[Piece, ...]
    draws: int


def _facts(values: Sequence[Value | None]) -> _Facts:
    """Look through expressions; one that is alone remembers."""
    value = values[0] if len(values) == 1 else None
    if not isinstance(value, Op):
        return _found_facts(*values)
    known = value.facts
    if known is None:
        if value.outline is not None:  # numbers and slots under exact operations
            known = _Facts(tuple([(leaf, 1) for leaf in value.leaves if type(leaf) is int]), 0)
        else:
            known = _found_facts(value)
        value.facts = known
    assert isinstance(known, _Facts)
    return known


def _found_facts(*values: Value | None) -> _Facts:
    nodes = [*walk_values(*values)]
    draws = sum([DRAWS.get(node.name, 0) for node in nodes if isinstance(node, Op)])
    return _Facts(tuple([piece for node in nodes for piece in memory(node)]), draws)


def memory(node: Value) -> tuple[Piece, ...]:
    """Return the memory that a node itself reads, its operands' left out."""
    match node:
        case Op() | Const():
            return ()
        case Load():
            return ((node.slot, 1),)
        case Vec() | ShiftedVec():
            return (ArrayPiece(node.slot, node.count),)
        case MatVec():
            inner = node.rows if node.transposed else node.cols
            return (ArrayPiece(node.slot, node.rows * node.cols), ArrayPiece(node.x_slot, inner))
        case PatternRow():
            return (ArrayPiece(node.slot, node.rows * node.cols), (IROW, 1))
        case Outer():
            return (ArrayPiece(node.u_slot, node.u_count), ArrayPiece(node.v_slot, node.v_count))
        case Table1():
            return (ArrayPiece(node.slot, 2 * node.count),)
        case Table2():
            return (
                ArrayPiece(node.f_slot, node.rows * node.cols),
                ArrayPiece(node.x_slot, node.rows),
                ArrayPiece(node.y_slot, node.cols),
            )
        case _:
            assert_never(node)


def expressions(action: Action) -> tuple[Value, ...]:
    """Return what a statement evaluates in a pass, in order; of a guard the condition.

    Not the time of a delay: that is found before the run.
    """
    every: tuple[Value | None, ...]
    match action:
        case Set() | SetVec() | Deriv() | DerivVec() | Terminate():
            return (action.value,)
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
        case StoreHistory() | GetHistory():
            every = ()
        case _:
            assert_never(action)
    return tuple(value for value in every if value is not None)


def own_reads(action: Action) -> tuple[Piece, ...]:
    """Return the memory that a statement reads besides what its expressions read."""
    match action:
        case Set() | Deriv() | DerivVec() | SetDot() | Guard():
            return ()
        case Terminate():
            return () if action.level is None else ((action.level, 1),)
        case SetVec() | SetMat():
            count = _size(action)
            mask = () if action.mask_slot is None else (ArrayPiece(action.mask_slot, count),)
            keeps = action.mode == "add" or (action.mask_slot is not None and isinstance(action, SetMat))
            return (*mask, ArrayPiece(action.slot, count)) if keeps else mask
        case StoreHistory():
            return ((action.slot, 1),)
        case GetHistory():
            return (ArrayPiece(action.array_slot, action.count),)
        case DelayLine():
            return (ArrayPiece(action.buffer_slot, action.count),)
        case UpdateTrackHold():
            return ((action.held_slot, 1), (action.tracked_slot, 1))
        case LearningStep():
            h = () if action.h_slot is None else (ArrayPiece(action.h_slot, action.out_count),)
            return (
                ArrayPiece(action.weights_slot, action.out_count * action.in_count),
                ArrayPiece(action.in_slot, action.in_count),
                ArrayPiece(action.out_slot, action.out_count),
                *h,
            )
        case _:
            assert_never(action)


def reads(action: Action) -> Iterator[Piece]:
    """All memory that a statement reads, what it may leave as it was included; of a guard the condition's."""
    yield from _facts(expressions(action)).reads
    yield from own_reads(action)


def writes(action: Action) -> tuple[Piece, ...]:
    """Return the memory that a statement assigns; derivatives and what a guard holds left out."""
    match action:
        case Set() | SetDot() | GetHistory():
            return ((action.slot, 1),)
        case Deriv() | DerivVec() | Guard():
            return ()
        case Terminate():
            return () if action.level is None else ((action.level, 1),)
        case SetVec() | SetMat():
            return (ArrayPiece(action.slot, _size(action)),)
        case StoreHistory():
            return (ArrayPiece(action.array_slot, action.count),)
        case DelayLine():
            return ((action.slot, 1), ArrayPiece(action.buffer_slot, action.count))
        case UpdateTrackHold():
            return ((action.held_slot, 1), (action.tracked_slot, 1))
        case LearningStep():
            h = () if action.h_slot is None else (ArrayPiece(action.h_slot, action.out_count),)
            full = () if action.full_slot is None else (ArrayPiece(action.full_slot, 1),)
            return (
                ArrayPiece(action.weights_slot, action.out_count * action.in_count),
                ArrayPiece(action.out_slot, action.out_count),
                *h,
                *full,
            )
        case _:
            assert_never(action)


def role(action: SimpleAction) -> Role:
    """Return what a statement is for."""
    match action:
        case Deriv() | DerivVec():
            return "derivative"
        case Set() | SetVec() | SetMat() | SetDot():
            remembers = action.persistent or count_draws(*expressions(action))
            return "effect" if remembers else "definition"
        case _:
            if isinstance(action, EffectAction):
                return "effect"
            assert_never(action)


def timing(action: SimpleAction) -> Timing:
    """Return in which passes a statement runs (language.md 8.2)."""
    match action:
        case (
            Set() | SetVec() | SetMat() | SetDot() | Deriv() | DerivVec() | UpdateTrackHold() | LearningStep()
        ):
            return "always"
        case StoreHistory() | GetHistory():
            return "point"
        case DelayLine():
            return "step" if action.per_step else "point"
        case Terminate():
            return "step"
        case _:
            assert_never(action)


def reads_replaced(action: Action) -> bool:
    """Whether elements of an array are computed from such as the statement has assigned before them.

    Elements are assigned in place, from the last to the first (compatibility.md).
    """
    if not isinstance(action, SetVec | SetMat) or _size(action) == 1:
        return False
    slot, end = action.slot, action.slot + _size(action)
    for node in walk_values(*expressions(action)):
        for start, count in memory(node):
            if start >= end or start + count <= slot:
                continue
            match node:
                case Load() | Vec():
                    ahead = start > slot
                case ShiftedVec():
                    ahead = start + node.by > slot
                case _:
                    ahead = True
            if ahead:
                return True
    return False


def _size(action: SetVec | SetMat) -> int:
    return action.count if isinstance(action, SetVec) else action.rows * action.cols
