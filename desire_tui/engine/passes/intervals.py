"""A set of numbers' slots, kept as disjoint intervals in order."""

from __future__ import annotations

from bisect import bisect_left, bisect_right


class Intervals:
    """Slots in disjoint intervals `start … end-1`; all questions cost the logarithm of their number."""

    __slots__ = ("ends", "starts")

    def __init__(self) -> None:
        self.starts: list[int] = []
        self.ends: list[int] = []

    def copy(self) -> Intervals:
        """Return a copy that later additions leave alone."""
        made = Intervals()
        made.starts, made.ends = self.starts.copy(), self.ends.copy()
        return made

    def add(self, slot: int, count: int) -> None:
        """Add `count` slots from `slot` on."""
        end = slot + count
        first = bisect_left(self.ends, slot)
        last = bisect_right(self.starts, end)
        if first < last:
            slot, end = min(slot, self.starts[first]), max(end, self.ends[last - 1])
        self.starts[first:last] = [slot]
        self.ends[first:last] = [end]

    def covers(self, slot: int, count: int) -> bool:
        """Whether all of these slots are in the set."""
        at = bisect_right(self.starts, slot) - 1
        return at >= 0 and slot + count <= self.ends[at]

    def touches(self, slot: int, count: int) -> bool:
        """Whether one of these slots is in the set."""
        at = bisect_left(self.starts, slot + count) - 1
        return at >= 0 and self.ends[at] > slot

    def common(self, other: Intervals) -> Intervals:
        """Return the slots in both sets."""
        made = Intervals()
        for start, end in zip(self.starts, self.ends, strict=True):
            at = bisect_right(other.ends, start)
            while at < len(other.starts) and other.starts[at] < end:
                low, high = max(start, other.starts[at]), min(end, other.ends[at])
                made.add(low, high - low)
                at += 1
        return made
