"""What code at communication points and steps' starts does to what derivatives are computed from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, role, writes
from desire_tui.engine.lowered.statements import Terminate
from desire_tui.engine.lowered.walk import simple_actions, walk_actions
from desire_tui.engine.passes.assigned_states import without_assigned_states
from desire_tui.engine.passes.moments import conditions_pass
from desire_tui.engine.passes.slices import derivative_slice, full_pass, step_slice
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.values import DT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.segment import Segment

_NOWHERE = 2**40
"""A slot that is no quantity's."""
_LONGEST = 64
"""Longer arrays are not looked at for changes."""


def changed_inputs(segment: Segment) -> list[int]:
    """Return the slots of what points and steps set and derivative passes read: inputs that may jump.

    States are not among them.
    """
    states = _states(segment)
    found: dict[int, None] = {}
    for slot, count in _set_outside(segment):
        if count <= _LONGEST:
            found |= dict.fromkeys(s for s in range(slot, slot + count) if not states.overlaps(s, 1))
    return list(found)


def steps_are_free(segment: Segment) -> bool:
    """Whether steps need not end on communication points: nothing there moves what derivatives read.

    `term` acts at steps too, but steps end where it fires.
    """
    for action in simple_actions(step_slice(segment)):
        if role(action) == "effect" and (not isinstance(action, Terminate) or action.fault is not None):
            return False
    return not any(True for _ in _set_outside(segment, conditions=True))


def may_pass_points(segment: Segment) -> bool:
    """Whether steps of rules 4, 7 and 8 may go beyond communication points.

    No `delay(x, tau)` whose steps may be no longer than tau, and nobody else sets DT.
    """
    segment, _ = without_assigned_states(segment, lambda _: _NOWHERE)
    if segment.delays or not segment.order or changed_inputs(segment) or not steps_are_free(segment):
        return False
    return all(slot != DT for action in walk_actions(full_pass(segment)) for slot, _ in writes(action))


def _set_outside(segment: Segment, *, conditions: bool = False) -> Iterator[Piece]:
    """Yield states and what derivative passes (`conditions`: and conditions) read, where points set it."""
    derivative = derivative_slice(segment)
    own = {id(action) for action in simple_actions(derivative)}
    read = _states(segment)
    for action in walk_actions(derivative + (conditions_pass(segment, 0) if conditions else ())):
        for piece in reads(action):
            read.add(*piece)
    for simple in simple_actions(full_pass(segment)):
        if id(simple) not in own:
            yield from (piece for piece in writes(simple) if read.overlaps(*piece))


def _states(segment: Segment) -> SlotSet:
    found = SlotSet()
    for given in segment.states:
        found.add(given.slot, given.count)
    return found
