"""Dead code: what a pass would compute although nothing visible depends on it.

Left out is a defined variable that no derivative, no persistent variable and no statement of this pass needs.
Persistent assignments and random draws are never left out, so every back end changes the same numbers in
the same passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, role, writes
from desire_tui.engine.lowered.statements import Guard
from desire_tui.engine.lowered.walk import walk_actions, with_bodies
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.statements import Action, SimpleAction

Actions = tuple["Action", ...]


def without_dead_code(actions: Actions, always: frozenset[int] = frozenset()) -> Actions:
    """Leave out what no derivative, no persistent variable and no other kept statement uses.

    `always` are the ids of statements that are kept in any case.
    """
    return _keep_live(actions, SlotSet(), always)


def needed_by(actions: Actions, then: Actions) -> Actions:
    """Leave out what the statements `then` do not use."""
    live = SlotSet()
    for action in walk_actions(then):
        for slot, count in reads(action):
            live.add(slot, count)
    return _keep_live(actions, live, frozenset())


def needed_for(actions: Actions, pieces: Iterable[Piece]) -> Actions:
    """Leave out what no number of `pieces` (slot, count) is computed from."""
    live = SlotSet()
    for slot, count in pieces:
        live.add(slot, count)
    return _keep_live(actions, live, frozenset())


def _keep_live(actions: Actions, live: SlotSet, always: frozenset[int]) -> Actions:
    kept: list[Action] = []
    for action in reversed(actions):
        if isinstance(action, Guard):
            orelse = _keep_live(action.orelse, live, always)
            body = _keep_live(action.body, live, always)
            if not (body or orelse):
                continue
            kept.append(with_bodies(action, body, orelse))
        elif id(action) in always or _is_live(action, live):
            kept.append(action)
        else:
            continue
        for slot, count in reads(kept[-1]):  # of a guard the condition's
            live.add(slot, count)
    return tuple(reversed(kept))


def _is_live(action: SimpleAction, live: SlotSet) -> bool:
    return role(action) != "definition" or any(live.overlaps(slot, count) for slot, count in writes(action))
