"""Which slots a segment's statements touch, and how."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import OVER_ELEMENTS, expressions, memory, walk
from desire_tui.engine.lowered.expressions import Load
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

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.statements import Action


@dataclass(slots=True)
class SlotUsage:
    """Scalar slots read and written one by one; arrays (slot, count), complete where `only_scalars`.

    `only_scalars`: no statement over arrays, no array operand.
    """

    read: set[int] = field(default_factory=set)
    written: set[int] = field(default_factory=set)
    arrays: set[tuple[int, int]] = field(default_factory=set)
    only_scalars: bool = True
    statements: int = 0

    @property
    def pinned(self) -> frozenset[int]:
        """Scalars that are elements of arrays which other statements reach by address."""
        return frozenset(
            s
            for s in self.read | self.written
            if any(slot <= s < slot + count for slot, count in self.arrays)
        )


def survey(passes: Iterable[Iterable[Action]]) -> SlotUsage:
    """Look through all statements of all passes."""
    scope = SlotUsage()
    seen: set[int] = set()
    for actions in passes:
        for action in actions:
            if id(action) not in seen:
                seen.add(id(action))
                _action(action, scope)
    return scope


def _action(action: Action, scope: SlotUsage) -> None:
    scope.statements += 1
    for node in walk(*expressions(action)):
        if isinstance(node, Load):
            scope.read.add(node.slot)
        else:
            scope.arrays.update(memory(node))
            scope.only_scalars &= not isinstance(node, OVER_ELEMENTS)
    match action:
        case Set():
            scope.written.add(action.slot)
        case Deriv() | Terminate():
            pass
        case Guard():
            for inner in (*action.body, *action.orelse):
                _action(inner, scope)
        case StoreHistory():
            scope.read.add(action.slot)
            scope.arrays.add((action.array_slot, action.count))
        case GetHistory():
            scope.written.add(action.slot)
            scope.arrays.add((action.array_slot, action.count))
        case DelayLine():
            scope.written.add(action.slot)
            scope.arrays.add((action.buffer_slot, action.count))
        case UpdateTrackHold():
            scope.written.update((action.held_slot, action.tracked_slot))
        case _:
            scope.only_scalars = False
