"""Where the tangents live: for each piece of memory that depends on the states, another of the same size."""

from __future__ import annotations

from bisect import bisect_right
from itertools import groupby
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, writes
from desire_tui.engine.lowered.expressions import Table1, Vec
from desire_tui.engine.lowered.walk import simple_actions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.expressions import Table2
    from desire_tui.engine.lowered.segment import StateRange
    from desire_tui.engine.lowered.statements import Action


class NotDifferentiable(Exception):  # noqa: N818 - the caller's cue to take differences, no error
    """The statement or expression that has no derivative."""


class Tangents:
    """Tangent slots.

    Memory is divided into regions: stretches that the segment's arrays and scalars overlap. A region is
    *active* if it holds a state, or if a statement that reads an active region writes into it. States'
    tangents are the direction v: `directions` and on, in the order of the states. Where a region holds more
    than states, or holds them in another order, the pass copies them into room of its own: `copies` (slot
    there, states).

    `seeds` (slot, count) are further numbers that are given tangents, parameters for instance. `in_place`:
    states' tangents are numbers like the others, each region's in one piece; there are no `directions`.
    """

    def __init__(
        self,
        states: Sequence[StateRange],
        actions: Sequence[Action],
        allocate: Callable[[int], int],
        seeds: Iterable[tuple[int, int]] = (),
        *,
        in_place: bool = False,
    ) -> None:
        flat = list(simple_actions(actions))
        given = list(seeds)
        pieces = [*given, *((s.slot, s.count) for s in states)]
        for action in flat:
            pieces += reads(action)
            pieces += writes(action)
        self._starts, self._ends = _regions(pieces)
        self._base: list[int | None] = [None] * len(self._starts)
        self.copies: list[tuple[int, StateRange]] = []
        self.directions = 0
        for slot, _ in given:
            self._base[self._region(slot)] = -1
        if in_place:
            for s in states:
                self._base[self._region(s.slot)] = -1
        else:
            self._place_directions(states, allocate)
        self._propagate(flat)
        for region, known in enumerate(self._base):
            if known == -1:
                self._base[region] = allocate(self._size(region))

    def _place_directions(self, states: Sequence[StateRange], allocate: Callable[[int], int]) -> None:
        self.directions = allocate(max(sum(s.count for s in states), 1))
        for region, group in groupby(
            sorted(states, key=lambda s: s.slot), key=lambda s: self._region(s.slot)
        ):
            self._place_states(region, list(group), allocate)

    def _place_states(self, region: int, states: list[StateRange], allocate: Callable[[int], int]) -> None:
        start = self._starts[region]
        bases = {self.directions + s.first - (s.slot - start) for s in states}
        if len(bases) == 1 and sum(s.count for s in states) == self._size(region):
            self._base[region] = bases.pop()
            return
        base = self._base[region] = allocate(self._size(region))
        self.copies += [(base + s.slot - start, s) for s in states]

    def slot(self, slot: int) -> int | None:
        """Return the slot of a number's tangent; None if it does not depend on the states."""
        region = self._region(slot)
        if region < 0 or slot >= self._ends[region]:
            return None
        base = self._base[region]
        return None if base is None else base + slot - self._starts[region]

    def pieces(self) -> Iterator[tuple[int, int, int]]:
        """Yield what has tangents: first slot, first slot of the tangents, how many numbers."""
        for region, base in enumerate(self._base):
            if base is not None:
                yield self._starts[region], base, self._size(region)

    def vector(self, value: Vec) -> Vec | None:
        """Return the tangent of an array."""
        slot = self.slot(value.slot)
        return None if slot is None else Vec(slot, value.count)

    def refuse_table(self, table: Table1 | Table2) -> None:
        """NotDifferentiable if a table's own numbers depend on the states."""
        slots = (table.slot,) if isinstance(table, Table1) else (table.f_slot, table.x_slot, table.y_slot)
        if any(self.slot(slot) is not None for slot in slots):
            raise NotDifferentiable(table)

    def _propagate(self, actions: Sequence[Action]) -> None:
        """Mark what depends on the states, until nothing new is found; -1: active, no room yet."""
        changed = True
        while changed:
            changed = False
            for action in actions:
                targets = [self._region(slot) for slot, _ in writes(action)]
                if all(self._base[target] is not None for target in targets):
                    continue
                if any(self._base[self._region(slot)] is not None for slot, _ in reads(action)):
                    for target in targets:
                        if self._base[target] is None:
                            self._base[target] = -1
                            changed = True

    def _region(self, slot: int) -> int:
        return bisect_right(self._starts, slot) - 1

    def _size(self, region: int) -> int:
        return self._ends[region] - self._starts[region]


def _regions(pieces: Iterable[tuple[int, int]]) -> tuple[list[int], list[int]]:
    """Join overlapping (slot, count) pieces; return where the regions start and end."""
    starts: list[int] = []
    ends: list[int] = []
    for slot, count in sorted(set(pieces)):
        if ends and slot < ends[-1]:
            ends[-1] = max(ends[-1], slot + count)
        else:
            starts.append(slot)
            ends.append(slot + count)
    return starts, ends
