"""A set of numbers in memory, scalars and parts of arrays."""

from __future__ import annotations

from desire_tui.engine.passes.intervals import Intervals
from desire_tui.engine.values import SCALAR_SLOTS


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

    def overlaps(self, slot: int, count: int) -> bool:
        """Whether any of `count` numbers from `slot` on belongs to the set."""
        if self._ranges.touches(slot, count):
            return True
        if count == 1:
            return slot in self._scalars
        return slot < SCALAR_SLOTS and any(slot <= s < slot + count for s in self._scalars)
