"""What has surely been set at a point of the pass, and what is read before that.

A scalar that a statement reads before the pass has surely set it keeps its value from pass to pass: a
difference equation, a sample-hold variable, a relay. Every assignment to such a number is *persistent* and
must be carried out in every pass it belongs to (language.md 9.1, 9.2; book, sections 3.3.1 and 4.4).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from desire_tui.engine.analysis.scope import SYSTEM_SLOTS
from desire_tui.engine.lowered import Load, Set, SetDot, SetMat, SetVec

if TYPE_CHECKING:
    from desire_tui.engine.lowered import Action

Assignment = Set | SetVec | SetMat | SetDot
Interval = tuple[int, int]


@dataclass
class Flow:
    """Bookkeeping along the statements of one segment.

    `ready`: names that can be read here without more ado, each with the `Load` that reads it.
    `set_slots`, `set_ranges`: numbers surely set by now; `early_slots`, `early_ranges`: read before that.
    """

    ready: dict[str, Load] = field(default_factory=dict)
    set_slots: set[int] = field(default_factory=set)
    set_ranges: set[Interval] = field(default_factory=set)
    early_slots: set[int] = field(default_factory=set)
    early_ranges: set[Interval] = field(default_factory=set)
    assignments: list[Assignment] = field(default_factory=list)

    def snapshot(self) -> tuple[dict[str, Load], set[int], set[Interval]]:
        """Return what is surely set here, to come back to when a guard ends."""
        return dict(self.ready), set(self.set_slots), set(self.set_ranges)

    def restore(self, saved: tuple[dict[str, Load], set[int], set[Interval]]) -> None:
        """Forget what was set inside a guard."""
        self.ready, self.set_slots, self.set_ranges = saved

    def keep_common(self, other: tuple[dict[str, Load], set[int], set[Interval]]) -> None:
        """After if/else: surely set is what both branches set."""
        ready, slots, ranges = other
        self.ready = {name: load for name, load in self.ready.items() if name in ready}
        self.set_slots &= slots
        self.set_ranges &= ranges

    def read_slot(self, slot: int) -> None:
        """Note that a number which the segment may assign is read."""
        if slot not in self.set_slots and not any(a <= slot < a + n for a, n in self.set_ranges):
            self.early_slots.add(slot)

    def read_range(self, slot: int, count: int) -> None:
        """Note that a whole array is read."""
        if not any(a <= slot and slot + count <= a + n for a, n in self.set_ranges):
            self.early_ranges.add((slot, count))

    def mark_persistent(self, states: list[Interval]) -> None:
        """Mark the assignments whose numbers are read early, or that move a state or system variable."""
        early, ranges = self.early_slots, sorted(self.early_ranges | set(states))
        for made in self.assignments:
            slot = made.slot
            if isinstance(made, Set | SetDot):
                kept = slot in early or slot < SYSTEM_SLOTS or _overlaps(ranges, slot, 1)
            else:
                count = made.count if isinstance(made, SetVec) else made.rows * made.cols
                kept = made.mode == "add" or (isinstance(made, SetMat) and made.mask_slot is not None)
                kept = kept or any(slot <= s < slot + count for s in early) or _overlaps(ranges, slot, count)
            if kept:
                made.persistent = True  # type: ignore[misc]  # nodes are frozen for the type checker only


def _overlaps(ranges: list[Interval], slot: int, count: int) -> bool:
    return any(a < slot + count and slot < a + n for a, n in ranges)


def walk(actions: tuple[Action, ...] | list[Action]) -> list[Action]:
    """Return all actions, those inside guards included, in order."""
    found: list[Action] = []
    for action in actions:
        found.append(action)
        body = getattr(action, "body", None)
        if body is not None:
            found.extend(walk(body))
            found.extend(walk(action.orelse))  # type: ignore[union-attr]
    return found
