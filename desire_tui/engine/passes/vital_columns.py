"""Which requested variables states depend on: where one of them is inf or nan, the run is over.

Others are only looked at (`sigma = x/0` for a plot): there a curve has a gap (language.md 9.8). A variable
that keeps its value from pass to pass - a difference equation's, a held one, what CLEARN learns - is a state
of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, writes
from desire_tui.engine.lowered.statements import (
    Assignment,
    Deriv,
    DerivVec,
    Guard,
    LearningStep,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action


def vital_columns(segment: Segment) -> list[int]:
    """Return the numbers of those of a segment's columns that are states, or that states are made of."""
    scalars = {states.slot for states in segment.states if states.count == 1}
    columns = segment.columns
    if scalars.issuperset([column.slot for column in columns]):
        return [*range(len(columns))]
    vital = SlotSet()
    for states in segment.states:
        vital.add(states.slot, states.count)
    slots = [column.slot for column in columns]
    if not all(vital.overlaps(slot, 1) for slot in slots):
        found: set[int] = set()
        while _collect(segment.body, vital, found):
            pass  # what a later line stores or delays may be read by an earlier one
    return [number for number, slot in enumerate(slots) if vital.overlaps(slot, 1)]


def _collect(actions: tuple[Action, ...], vital: SlotSet, found: set[int]) -> bool:
    """Go backward, adding what vital statements read; return whether there were any besides those `found`."""
    grown = False
    for action in reversed(actions):
        if id(action) in found:
            continue
        if isinstance(action, Guard):
            orelse = _collect(action.orelse, vital, found)
            if not (_collect(action.body, vital, found) or orelse):
                continue
        elif _is_state(action):
            found.add(id(action))
            for slot, count in writes(action):
                vital.add(slot, count)
        elif not isinstance(action, Terminate) and any(vital.overlaps(*piece) for piece in writes(action)):
            found.add(id(action))
        else:
            continue
        grown = True
        for slot, count in reads(action):  # of a guard the condition's
            vital.add(slot, count)
    return grown


def _is_state(action: Action) -> bool:
    """Whether a statement moves a state, or a variable that is one of its own."""
    if isinstance(action, Assignment):
        return action.persistent
    return isinstance(action, Deriv | DerivVec | UpdateTrackHold | LearningStep)
