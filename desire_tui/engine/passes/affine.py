"""Which expressions are sums of t and states with constant factors, while no switch switches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws
from desire_tui.engine.lowered.expressions import Const, Load, Op, ShiftedVec, Vec
from desire_tui.engine.lowered.switching import JUMPS
from desire_tui.engine.passes.dependence import Dependence
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import StateRange
    from desire_tui.engine.passes.dependence import Dependences

_CURVED = 2


class Affinity:
    """Over the statements of a derivative pass."""

    def __init__(self, dependences: Dependences, states: Iterable[StateRange]) -> None:
        self._dependences = dependences
        self._states = tuple(states)
        self._known: dict[int, tuple[Value, int]] = {}

    def is_affine(self, value: Value) -> bool:
        """Whether an expression is one."""
        return self._degree(value) < _CURVED

    def _degree(self, value: Value) -> int:
        """Return 0 for what is constant between switchings, 1 for affine, else 2."""
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = (value, min(self._find(value), _CURVED))
        return known[1]

    def _find(self, value: Value) -> int:
        if count_draws(value):
            return _CURVED
        if self._dependences.of(value) is Dependence.NOTHING:
            return 0
        match value:
            case Const():
                return 0
            case Load():
                return self._of_slot(value.slot)
            case Vec() | ShiftedVec():
                return 1 if self._is_state(value.slot, value.count) else _CURVED
            case Op():
                return self._of_operation(value)
            case _:
                return _CURVED

    def _of_slot(self, slot: int) -> int:
        if slot == T or self._is_state(slot, 1):
            return 1
        definition = self._dependences.definitions.get(slot)
        return _CURVED if definition is None else self._degree(definition)

    def _is_state(self, slot: int, count: int) -> bool:
        return any(given.slot <= slot and slot + count <= given.slot + given.count for given in self._states)

    def _of_operation(self, value: Op) -> int:
        if value.name in JUMPS and value.name != "comp":  # constant until it is a mode that switches
            return 0
        degrees = [self._degree(argument) for argument in value.args]
        match value.name:
            case "comp":  # one of its other arguments
                return max(degrees[1:])
            case "add" | "sub" | "neg":
                return max(degrees)
            case "mul":
                return sum(degrees)
            case "div" if degrees[1] == 0:
                return degrees[0]
            case _:
                return 0 if max(degrees, default=0) == 0 else _CURVED
