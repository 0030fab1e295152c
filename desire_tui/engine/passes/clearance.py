"""Of which segments bounds can tell, over a box of t and states, that no mode switches there.

They serve where all modes are made of t, states, and numbers that nothing in the segment changes, by
operations whose bounds are known (`lowered.switching.has_bounds`), and where states are moved by integration
alone: what is inside the box at a step's end is then inside at the start of the next.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import memory, writes
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.switching import has_bounds
from desire_tui.engine.lowered.walk import operands, walk_actions
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.engine.lowered.expressions import Op, Value
    from desire_tui.engine.lowered.segment import Segment

_SIDES_MOST = 2
"""A box with more sides for each mode is not worth looking at."""


def moving_slots(segment: Segment, jumps: Sequence[Op], definitions: Mapping[int, Value]) -> tuple[int, ...]:
    """Return the slots of states and t that jumps are made of; none where bounds do not serve."""
    if segment.events:  # their blocks move states, and change numbers
        return ()
    search = _Search(segment, definitions)
    if not all(map(search.is_known, jumps)) or len(search.moving) > _SIDES_MOST * len(jumps):
        return ()
    return tuple(sorted(search.moving))


class _Search:
    def __init__(self, segment: Segment, definitions: Mapping[int, Value]) -> None:
        self.moving: set[int] = set()
        self._definitions = definitions
        self._known: dict[int, tuple[Value, bool]] = {}
        self._states, self._changed = SlotSet(), SlotSet()
        for state in segment.states:
            self._states.add(state.slot, state.count)
        for action in walk_actions(segment.body):
            for slot, count in writes(action):
                if slot not in definitions:
                    self._changed.add(slot, count)

    def is_known(self, value: Value) -> bool:
        """Whether bounds of an expression are known; the states in it are then among `moving`."""
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = (value, self._find(value))
        return known[1]

    def _find(self, value: Value) -> bool:
        if not has_bounds(value):
            return False
        if not isinstance(value, Load):
            return not any(self._changed.overlaps(*piece) for piece in memory(value)) and all(
                map(self.is_known, operands(value))
            )
        definition = self._definitions.get(value.slot)
        if definition is not None:
            return self.is_known(definition)
        if value.slot == T or self._states.overlaps(value.slot, 1):
            self.moving.add(value.slot)
        return not self._changed.overlaps(value.slot, 1)
