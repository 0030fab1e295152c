"""What has surely been set at a point of the pass, and what is read before that.

A scalar that a statement reads before the pass has surely set it keeps its value from pass to pass: a
difference equation, a sample-hold variable, a relay. Every assignment to such a number is *persistent* and
must be carried out in every pass it belongs to (language.md 9.1, 9.2; book, sections 3.3.1 and 4.4).
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.lowered.statements import Set, SetDot, SetMat, SetVec
from desire_tui.engine.passes.intervals import Intervals
from desire_tui.engine.values import SYSTEM_SLOTS

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Load

Assignment = Set | SetVec | SetMat | SetDot
Key = TypeVar("Key")
Value = TypeVar("Value")


class Mark(NamedTuple):
    """How much was surely set at a point of the pass: only what comes behind it is undone, or compared."""

    ready: int
    slots: int
    ranges: Intervals


class Branch(NamedTuple):
    """What was set behind a mark; `ranges`: all that are set by then."""

    ready: dict[str, Load]
    slots: dict[int, None]
    ranges: Intervals


@dataclass
class Flow:
    """Bookkeeping along the statements of one segment.

    `ready`: names that can be read here without more ado, each with the `Load` that reads it.
    `set_slots`, `set_ranges`: numbers surely set by now; `early_slots`, `early_ranges`: read before that.
    What is ready and the slots stand in the order in which they came: a guard's end takes the last ones back.
    """

    ready: dict[str, Load] = field(default_factory=dict)
    set_slots: dict[int, None] = field(default_factory=dict)
    set_ranges: Intervals = field(default_factory=Intervals)
    early_slots: set[int] = field(default_factory=set)
    early_ranges: Intervals = field(default_factory=Intervals)
    assignments: list[Assignment] = field(default_factory=list)

    def mark(self) -> Mark:
        """Return a point to come back to when a guard ends."""
        return Mark(len(self.ready), len(self.set_slots), self.set_ranges.copy())

    def take_back(self, mark: Mark) -> Branch:
        """Forget what was set behind a mark; return it."""
        branch = Branch(_taken(self.ready, mark.ready), _taken(self.set_slots, mark.slots), self.set_ranges)
        self.set_ranges = mark.ranges.copy()
        return branch

    def keep_common(self, mark: Mark, then: Branch) -> None:
        """After if/else: surely set is what both branches set."""
        ready, slots, ranges = self.take_back(mark)
        self.ready.update((name, load) for name, load in ready.items() if name in then.ready)
        self.set_slots.update((slot, None) for slot in slots if slot in then.slots)
        self.set_ranges = ranges.common(then.ranges)

    def read_slot(self, slot: int) -> None:
        """Note that a number which the segment may assign is read."""
        if slot not in self.set_slots and not self.set_ranges.covers(slot, 1):
            self.early_slots.add(slot)

    def read_range(self, slot: int, count: int) -> None:
        """Note that a whole array is read."""
        if not self.set_ranges.covers(slot, count):
            self.early_ranges.add(slot, count)

    def mark_persistent(self, states: list[tuple[int, int]]) -> None:
        """Mark the assignments whose numbers are read early, or that move a state or system variable.

        `states`: slot and count of each range of states.
        """
        if not self.assignments:
            return
        slots, ranges = self.early_slots, self.early_ranges
        for slot, count in states:
            if count == 1:
                slots.add(slot)
            else:
                ranges.add(slot, count)
        early = sorted(slots)
        for made in self.assignments:
            slot = made.slot
            if isinstance(made, Set | SetDot):
                kept = slot in slots or slot < SYSTEM_SLOTS or ranges.touches(slot, 1)
            else:
                count = made.count if isinstance(made, SetVec) else made.rows * made.cols
                kept = made.mode == "add" or (isinstance(made, SetMat) and made.mask_slot is not None)
                at = bisect_left(early, slot)
                kept = kept or (at < len(early) and early[at] < slot + count) or ranges.touches(slot, count)
            if kept:
                made.persistent = True  # type: ignore[misc]  # nodes are frozen for the type checker only


def _taken(found: dict[Key, Value], left: int) -> dict[Key, Value]:
    """Take entries off the end of a dictionary until so many are left."""
    taken = {}
    while len(found) > left:
        key, value = found.popitem()
        taken[key] = value
    return taken
