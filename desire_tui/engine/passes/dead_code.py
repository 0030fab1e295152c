"""Which statements of a pass anybody needs: a pass computes nothing that nobody can see.

Left out is a defined variable that no derivative, no persistent variable and no statement of this pass needs.
Persistent assignments and random draws are never left out, so every back end changes the same numbers in
the same passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, role, writes
from desire_tui.engine.lowered.statements import Guard
from desire_tui.engine.lowered.walk import with_bodies
from desire_tui.engine.passes.intervals import Intervals
from desire_tui.engine.values import SCALAR_SLOTS

if TYPE_CHECKING:
    from desire_tui.engine.lowered.statements import Action, SimpleAction

Actions = tuple["Action", ...]


def needed(actions: Actions, wanted: frozenset[int] = frozenset()) -> Actions:
    """Leave out what no derivative, no persistent variable and no other kept statement uses.

    `wanted` are the ids of statements that are kept in any case.
    """
    return _backward(actions, SlotSet(), wanted)


class SlotSet:
    """A set of numbers: scalars by slot, arrays and their elements as intervals."""

    def __init__(self) -> None:
        self._scalars: set[int] = set()
        self._ranges = Intervals()

    def add(self, slot: int, count: int) -> None:
        """Add `count` numbers from `slot` on."""
        if count == 1 and slot < SCALAR_SLOTS:
            self._scalars.add(slot)
        else:
            self._ranges.add(slot, count)

    def touch(self, slot: int, count: int) -> bool:
        """Whether any of `count` numbers from `slot` on belongs to the set."""
        if self._ranges.touches(slot, count):
            return True
        if count == 1:
            return slot in self._scalars
        return slot < SCALAR_SLOTS and any(slot <= s < slot + count for s in self._scalars)


def _backward(actions: Actions, seen: SlotSet, wanted: frozenset[int]) -> Actions:
    kept: list[Action] = []
    for action in reversed(actions):
        if isinstance(action, Guard):
            orelse = _backward(action.orelse, seen, wanted)
            body = _backward(action.body, seen, wanted)
            if not (body or orelse):
                continue
            kept.append(with_bodies(action, body, orelse))
        elif id(action) in wanted or _is_needed(action, seen):
            kept.append(action)
        else:
            continue
        for slot, count in reads(kept[-1]):  # of a guard the condition's
            seen.add(slot, count)
    return tuple(reversed(kept))


def _is_needed(action: SimpleAction, seen: SlotSet) -> bool:
    return role(action) != "definition" or any(seen.touch(slot, count) for slot, count in writes(action))
