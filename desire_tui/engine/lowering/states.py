"""The differential-equation states of a segment, numbered in the order of their `d/dt` lines."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.segment import StateRange

if TYPE_CHECKING:
    from collections.abc import Sequence


class StateTable:
    """Ranges of states. Targets that overlap (a vector and one of its elements, two views) are one range.

    `lines`: the target of each `d/dt` line, numbered as if there were scalars only.
    """

    def __init__(self, lines: Sequence[StateRange]) -> None:
        if {line.count for line in lines} <= {1} and len({line.slot for line in lines}) == len(lines):
            self.ranges = list(lines)
        else:
            self.ranges = _merged(lines)
        self.order = sum([r.count for r in self.ranges])
        self._long = sorted((r for r in self.ranges if r.count > 1), key=lambda r: r.slot)
        self._starts = [r.slot for r in self._long]

    @cached_property
    def _by_slot(self) -> dict[int, int]:
        return {r.slot: r.first for r in self.ranges}

    def number(self, slot: int) -> int | None:
        """Return the number of the state in a slot; None if there is none."""
        number = self._by_slot.get(slot)
        if number is not None:
            return number
        at = bisect_right(self._starts, slot) - 1
        if at < 0:
            return None
        found = self._long[at]
        return found.first + slot - found.slot if slot < found.slot + found.count else None


def _merged(lines: Sequence[StateRange]) -> list[StateRange]:
    order = sorted(range(len(lines)), key=lambda i: (lines[i].slot, -lines[i].count))
    merged: list[list[int]] = []  # first line, slot, end, line that gives the name
    for i in order:
        line = lines[i]
        end = line.slot + max(line.count, 1)
        if merged and line.slot < merged[-1][2]:
            last = merged[-1]
            last[0] = min(last[0], i)
            last[2] = max(last[2], end)
        else:
            merged.append([i, line.slot, end, i])
    merged.sort()
    ranges: list[StateRange] = []
    first = 0
    for _, slot, end, name_line in merged:
        named = lines[name_line]
        ranges.append(StateRange(named.name, slot, first, end - slot, named.where))
        first += end - slot
    return ranges
