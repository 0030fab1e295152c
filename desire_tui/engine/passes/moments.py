"""What is computed at a moment: the conditions of events, and their blocks.

Both see defined variables as they are at the t and states in the values; what keeps its value from pass to
pass (difference equations, what stands behind OUT, SAMPLE and step) is read as it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import role, timing
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.statements import Guard, Set
from desire_tui.engine.lowered.walk import simple_actions, with_bodies
from desire_tui.engine.passes.dead_code import without_dead_code

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

Actions = tuple["Action", ...]


def conditions_pass(segment: Segment, now: int) -> Actions:
    """Return what puts the value of event i's condition into slot `now` + i."""
    computed = tuple(
        Set(now + number, event.condition, event.where)
        for number, event in enumerate(segment.events)
        if event.condition is not None
    )
    return without_dead_code(definitions(segment.body) + computed, frozenset(map(id, computed)))


def blocks_pass(segment: Segment, due: int) -> Actions:
    """Return what carries out the block of each event i where slot `due` + i is above 0."""
    blocks = tuple(
        Guard("if", event.body, event.where, Load(due + number))
        for number, event in enumerate(segment.events)
        if event.body
    )
    return without_dead_code(definitions(segment.body) + blocks, frozenset(map(id, simple_actions(blocks))))


def sources_pass(segment: Segment, source: int) -> Actions:
    """Return what puts the present value of what delay i remembers into slot `source` + i."""
    computed = tuple(
        Set(source + number, delayed.source, delayed.where) for number, delayed in enumerate(segment.delays)
    )
    return without_dead_code(definitions(segment.body) + computed, frozenset(map(id, computed)))


def definitions(actions: Iterable[Action]) -> Actions:
    """Return what only computes variables from others, in every pass."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "if":
                body, orelse = definitions(action.body), definitions(action.orelse)
                if body or orelse:
                    kept.append(with_bodies(action, body, orelse))
        elif role(action) == "definition" and timing(action) == "always":
            kept.append(action)
    return tuple(kept)
