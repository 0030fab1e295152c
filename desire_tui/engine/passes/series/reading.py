"""Which series or constant stands in a slot where a statement reads it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.passes.series.graph import Graph
    from desire_tui.engine.passes.series.nodes import Operand


class Slots:
    """What statements have put into slots so far; everything else is a constant of the step."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._numbers: dict[int, Operand] = {}
        self._arrays: list[tuple[int, Operand, int]] = []
        """First slot, what stands there, its length; what came later covers what came before."""

    def copy(self) -> Slots:
        """Return the same once more, for one branch of an `if`."""
        made = Slots(self._graph)
        made._numbers, made._arrays = self._numbers.copy(), self._arrays.copy()
        return made

    def put(self, slot: int, operand: Operand, count: int | None) -> None:
        """Let an operand stand in `count` slots; None: a number."""
        if count is None:
            self._numbers[slot] = operand
            return
        if self._numbers:
            for inner in range(slot, slot + count):
                self._numbers.pop(inner, None)
        self._arrays = [a for a in self._arrays if not slot <= a[0] <= a[0] + a[2] <= slot + count]
        self._arrays.append((slot, operand, count))

    def number(self, slot: int) -> Operand:
        """Return what stands in a slot."""
        operand, at = self.lane(slot)
        if operand.count is None:
            return operand
        return self._graph.element(operand, at)

    def lane(self, slot: int) -> tuple[Operand, int]:
        """Return the operand whose element stands in a slot, and the element's number."""
        found = self._numbers.get(slot)
        if found is not None:
            return found, 0
        for first, operand, count in reversed(self._arrays):
            if first <= slot < first + count:
                return operand, 0 if operand.count is None else slot - first
        return self._graph.outside(slot, None), 0

    def array(self, slot: int, count: int) -> Operand:
        """Return what stands in a stretch of slots."""
        touching = [a for a in self._arrays if a[0] < slot + count and slot < a[0] + a[2]]
        inner = self._numbers and any(i in self._numbers for i in range(slot, slot + count))
        if not touching and not inner:
            return self._graph.outside(slot, count)
        first, operand, length = touching[-1] if touching else (0, None, 0)
        if operand is not None and (first, length) == (slot, count) and not inner:
            return operand
        return self._graph.gather(tuple(self.lane(i) for i in range(slot, slot + count)))

    def choose(self, condition: Operand, yes: Slots, no: Slots) -> None:
        """Take over what two branches have put: the first's where the condition is above 0."""
        held = self._graph.held(condition)
        numbers = {**yes._numbers, **no._numbers}
        changed = [
            s for s in numbers if not yes._numbers.get(s) is no._numbers.get(s) is self._numbers.get(s)
        ]
        both = [*yes._arrays, *no._arrays]
        arrays = {
            (first, count) for first, operand, count in both if (first, operand, count) not in self._arrays
        }
        for first, count in sorted(arrays):
            self.put(first, self._graph.select(held, yes.array(first, count), no.array(first, count)), count)
        for slot in changed:
            self.put(slot, self._graph.select(held, yes.number(slot), no.number(slot)), None)
