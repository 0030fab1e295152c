"""What of a segment differs between runs whose parameters, initial values and random numbers differ.

Model replication (Korn's central idea) done by the compiler: what depends on these gets a number for each
run, what does not is computed once for all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import (
    ArrayPiece,
    count_draws,
    expressions,
    memory,
    reads,
    role,
    writes,
)
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    GetHistory,
    Guard,
    Set,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.engine.lowered.walk import simple_actions, walk_actions, walk_values
from desire_tui.engine.values import SYSTEM_SLOTS

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action


class LockStepError(Exception):
    """What keeps runs from going in lock step."""


HISTORIES = (StoreHistory, GetHistory, DelayLine)
"""Statements whose arrays hold a number for each run; where they stand in them is the same for all."""
_PLAIN_STATEMENTS = (Set, Deriv, Guard, Terminate, UpdateTrackHold, *HISTORIES)
_PLAIN_NODES = (Const, Load, Op, Table1, Table2)


def hindrance(segment: Segment, varied: Iterable[int]) -> str | None:
    """Return what keeps runs of a segment from going in lock step; None: nothing does.

    `varied` are the slots whose values differ at the start.
    """
    differs = set(varied)
    if segment.recover:
        return "recovered values"
    if not segment.order and (segment.delays or any(event.condition for event in segment.events)):
        return "events or delays without states"
    if any(slot < SYSTEM_SLOTS for slot in differs):
        return "times or settings of the run vary"
    written, tables, scalars = set[int](), set[int](), set[int]()
    kept = histories(segment.body)
    actions = tuple(
        walk_actions((*segment.body, *(action for event in segment.events for action in event.body)))
    )
    for action in actions:
        if not isinstance(action, _PLAIN_STATEMENTS):
            return f"{type(action).__name__} statements"
        written.update(slot for slot, _ in writes(action))
    for node in walk_values(
        *(value for action in actions for value in expressions(action)), *moment_values(segment)
    ):
        if not isinstance(node, _PLAIN_NODES):
            return f"{type(node).__name__} operands"
        for piece in memory(node):
            if isinstance(piece, ArrayPiece):
                tables.update(range(piece.slot, piece.slot + piece.length))
            else:
                scalars.add(piece[0])
    if any(slot < SYSTEM_SLOTS for slot in written):
        return "the program sets times or settings"
    if tables & (differs | written):
        return "tables vary"
    inside = [slot for first, count in kept.items() for slot in range(first, first + count)]
    others = differs.union(tables, scalars, written - kept.keys())
    if len(inside) != len(set(inside)) or not others.isdisjoint(inside):
        return "a stored history is used in another way, too"
    return None


def moment_values(segment: Segment) -> Iterator[Value]:
    """Yield the conditions of events, and what delays remember."""
    for event in segment.events:
        if event.condition is not None:
            yield event.condition
    for delayed in segment.delays:
        yield delayed.source


def histories(actions: Iterable[Action]) -> dict[int, int]:
    """Return the arrays that hold histories: their lengths by first slots."""
    found: dict[int, int] = {}
    for action in walk_actions(actions):
        if isinstance(action, HISTORIES):
            slot = action.buffer_slot if isinstance(action, DelayLine) else action.array_slot
            found[slot] = max(found.get(slot, 0), action.count)
    return found


def moved_apart(segment: Segment, found: Container[int]) -> str | None:
    """Return what gives the histories of some runs other places or delays; None: nothing does.

    `found` are the slots that differ between the runs.
    """
    return _moved_apart(segment.body, found, under=False)


def _moved_apart(actions: Iterable[Action], found: Container[int], *, under: bool) -> str | None:
    for action in actions:
        if isinstance(action, Guard):
            inner = under or (action.condition is not None and _differs(action, found))
            reason = _moved_apart((*action.body, *action.orelse), found, under=inner)
            if reason is not None:
                return reason
        elif isinstance(action, HISTORIES) and under:
            return "histories under a condition that differs"
        elif isinstance(action, DelayLine) and any(
            slot in found for node in walk_values(action.tau) for slot, _ in memory(node)
        ):
            return "times of delays differ"
    return None


def differing(
    passes: Mapping[str, Iterable[Action]], segment: Segment, varied: Iterable[int]
) -> frozenset[int]:
    """Return the slots of numbers that differ between the runs."""
    states, found = _states(segment), set(varied)
    while True:
        before = len(found)
        for kind, actions in passes.items():
            for action in actions:  # `tail`: only runs that end carry it out
                _spread(action, states, found, under=kind == "tail")
        if len(found) == before:
            return frozenset(found)


def changed_apart(passes: Mapping[str, Iterable[Action]], segment: Segment) -> set[int]:
    """Return the slots that differ as soon as runs take their steps in parts of their own.

    These are the states, what events set, and everything that is no definition.
    """
    found = set(_states(segment))
    for actions in passes.values():
        for action in simple_actions(actions):
            if role(action) == "effect":
                found.update(slot for slot, _ in writes(action))
    for event in segment.events:
        found.update(slot for action in walk_actions(event.body) for slot, _ in writes(action))
    return found


def _states(segment: Segment) -> list[int]:
    """Return the states' slots by number."""
    return [slot for states in segment.states for slot in range(states.slot, states.slot + states.count)]


def _spread(action: Action, states: Sequence[int], found: set[int], *, under: bool) -> None:
    """Add what a statement makes different; `under`: it stands under a condition that differs."""
    if isinstance(action, Guard):
        inner = under or (action.condition is not None and _differs(action, found))
        for held in (*action.body, *action.orelse):
            _spread(held, states, found, under=inner)
    elif under or _differs(action, found):
        found.update(slot for slot, _ in writes(action))
        if isinstance(action, Deriv):
            found.add(states[action.state])


def _differs(action: Action, found: Container[int]) -> bool:
    values = expressions(action)
    if count_draws(*values) or any(slot in found for slot, _ in reads(action)):
        return True
    return any(isinstance(node, Op) and node.name == "delayed" for node in walk_values(*values))
