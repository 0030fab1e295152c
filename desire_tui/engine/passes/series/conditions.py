"""Events' conditions under rule 17: which have series, and which never come inside a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import expressions
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.statements import Guard, Set
from desire_tui.engine.lowered.switching import JUMPS, KINKS
from desire_tui.engine.lowered.walk import simple_actions, walk_values
from desire_tui.engine.passes.dead_code import needed_by
from desire_tui.engine.passes.moments import definitions

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowered.switching import Switching

Actions = tuple["Action", ...]
_NOT_SMOOTH = JUMPS | KINKS | {"comp"}


def conditions_of_time(switching: Switching | None) -> set[int]:
    """Return the ids of the conditions that depend on t alone: a step ends where one rises."""
    clocks = () if switching is None else switching.clocks
    return {id(value.args[0]) for value, _ in clocks if isinstance(value, Op) and value.name == "lim"}


def condition_pass(segment: Segment, number: int) -> Actions:
    """Return what computes the variables that an event's condition reads, and last the condition itself."""
    event = segment.events[number]
    assert event.condition is not None
    last = Set(-1, event.condition, event.where)
    return (*needed_by(definitions(segment.body), (last,)), last)


def is_smooth(actions: Actions, derivative: Actions) -> bool:
    """Whether nothing switches in statements unless derivatives do at the same place: a step ends there."""
    own = {id(action) for action in simple_actions(derivative)}
    for action in actions:
        if isinstance(action, Guard):
            if not all(id(inner) in own for inner in simple_actions((action,))):
                return False
        elif id(action) not in own:
            for node in walk_values(*expressions(action)):
                if isinstance(node, Op) and node.name in _NOT_SMOOTH:
                    return False
    return True
