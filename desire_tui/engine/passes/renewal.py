"""Derivatives computed anew where code further down in a pass has changed what they read.

In one pass the derivatives come where their lines stand; what code behind `step`, `SAMPLE` or `OUT`, a
difference equation or `get` assigns afterwards they see in the next pass. A rule that tests its steps would
judge such a step by a derivative of what was before, halve it for ever, or be of first order. So rules 4, 7
and 8 make one more pass then, of defined variables and derivatives alone; nothing is remembered or drawn
twice. The other explicit rules keep the order of the original (docs/rules.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws, expressions, reads, role, writes
from desire_tui.engine.lowered.statements import Assignment, Guard
from desire_tui.engine.lowered.walk import simple_actions, walk_actions, with_bodies
from desire_tui.engine.passes.dead_code import without_dead_code
from desire_tui.engine.passes.slices import derivative_slice, full_pass, step_slice
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, SimpleAction

    Actions = tuple[Action, ...]


def renewals(segment: Segment) -> tuple[Actions, Actions]:
    """Return what is computed anew behind a communication point, and behind a step's start between two."""
    every = derivative_slice(segment)
    anew = without_dead_code(_computed(every))
    own = {id(action) for action in simple_actions(anew)}
    point, step = (_is_stale(made, own) for made in (full_pass(segment), step_slice(segment)))
    return anew if point or step else (), anew if step else ()


def _computed(actions: Actions) -> Actions:
    """Leave out what remembers or draws; an assignment that gives the same again is none of that."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            kept.append(with_bodies(action, _computed(action.body), _computed(action.orelse)))
        elif role(action) != "effect" or _is_repeatable(action):
            kept.append(action)
    return tuple(kept)


def _is_repeatable(action: SimpleAction) -> bool:
    if not isinstance(action, Assignment) or count_draws(*expressions(action)):
        return False
    own = SlotSet()
    for piece in writes(action):
        own.add(*piece)
    return not any(own.overlaps(*piece) for piece in reads(action))


def _is_stale(made: Actions, own: set[int]) -> bool:
    """Whether a pass assigns something behind a line of `own` that reads it."""
    read = SlotSet()
    for action in walk_actions(made):
        if id(action) not in own and any(read.overlaps(*piece) for piece in writes(action)):
            return True
        if id(action) in own or isinstance(action, Guard):
            for piece in reads(action):
                read.add(*piece)
    return False
