"""What an expression of a derivative pass depends on: nothing that moves, t alone, or states."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws, memory, role, writes
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.lowered.walk import operands, walk_actions
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import StateRange
    from desire_tui.engine.lowered.statements import Action


class Dependence(IntEnum):
    """The more the larger."""

    NOTHING = 0
    """What stays as it is between steps."""
    TIME = 1
    STATES = 2
    """Or anything else that moves within a step, or whose bounds cannot be told from t."""


class Dependences:
    """Over the statements of a derivative pass; `is_known` tells of which nodes bounds can be found."""

    def __init__(
        self, actions: Iterable[Action], states: Iterable[StateRange], is_known: Callable[[Value], bool]
    ) -> None:
        self._is_known = is_known
        self._known: dict[int, tuple[Value, Dependence]] = {}
        self._moving = SlotSet()
        for given in states:
            self._moving.add(given.slot, given.count)
        self.definitions: dict[int, Value] = {}
        """What scalars are that each pass computes once."""
        plain = {id(action) for action in actions}
        assigned: set[int] = set()
        for action in walk_actions(actions):
            for slot, count in writes(action):
                self._moving.add(slot, count)
                once = count == 1 and slot not in assigned and id(action) in plain
                if once and isinstance(action, Set) and role(action) == "definition":
                    self.definitions[slot] = action.value
                else:
                    self.definitions.pop(slot, None)
                if count == 1:
                    assigned.add(slot)

    def of(self, *values: Value) -> Dependence:
        """Return the largest dependence of some expressions."""
        return max(map(self._of, values), default=Dependence.NOTHING)

    def _of(self, value: Value) -> Dependence:
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = (value, self._find(value))
        return known[1]

    def _find(self, value: Value) -> Dependence:
        if count_draws(value):
            return Dependence.STATES
        if isinstance(value, Load):
            if value.slot == T:
                return Dependence.TIME
            if value.slot in self.definitions:
                return self._of(self.definitions[value.slot])
        moving = Dependence.STATES if any(self._moving.overlaps(*piece) for piece in memory(value)) else None
        if moving is not None:
            return moving
        found = self.of(*operands(value))
        if found is Dependence.TIME and not self._is_all_known(value):
            return Dependence.STATES
        return found

    def _is_all_known(self, value: Value) -> bool:
        """Whether bounds can be found of all that a node is made of, parts that never change included."""
        if isinstance(value, Load):
            definition = self.definitions.get(value.slot)
            return definition is None or self._is_part_known(definition)
        return self._is_known(value) and all(map(self._is_part_known, operands(value)))

    def _is_part_known(self, value: Value) -> bool:
        return self._of(value) is Dependence.TIME or self._is_all_known(value)
