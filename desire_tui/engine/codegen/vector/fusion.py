"""What array statements read and write, element by element or otherwise, and which may share a loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.lowered.effects import memory, own_reads, writes
from desire_tui.engine.lowered.expressions import Vec
from desire_tui.engine.lowered.statements import DerivVec, SetVec
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.codegen.scalar.rerolling import Rolled
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

Range = tuple[int, int]
_FUSED_MOST = 16
"""Statements in one loop: more would only spill registers."""


@dataclass(slots=True)
class Footprint:
    """Ranges (slot, end). `elementwise`: read at the element's own index; `elsewhere`: read anyhow else."""

    elementwise: set[Range] = field(default_factory=set)
    elsewhere: set[Range] = field(default_factory=set)
    writes: set[Range] = field(default_factory=set)

    def merge(self, more: Footprint) -> None:
        """Add another statement's."""
        self.elementwise |= more.elementwise
        self.elsewhere |= more.elsewhere
        self.writes |= more.writes


def overlap(a: Range, b: Range) -> bool:
    """Whether two ranges share a slot."""
    return a[0] < b[1] and b[0] < a[1]


def any_overlap(ranges: Iterable[Range], others: Iterable[Range]) -> bool:
    """Whether any two overlap."""
    listed = list(others)
    return any(overlap(a, b) for a in ranges for b in listed)


def _partial_overlap(ranges: Iterable[Range], others: Iterable[Range]) -> bool:
    """Whether any two overlap without being the same range."""
    listed = list(others)
    return any(a != b and overlap(a, b) for a in ranges for b in listed)


def value_footprint(node: Value) -> Footprint:
    """Return what an expression reads."""
    footprint = Footprint()
    for part in walk_values(node):
        ranges = footprint.elementwise if isinstance(part, Vec) else footprint.elsewhere
        ranges.update((slot, slot + count) for slot, count in memory(part))
    return footprint


def statement_footprint(action: SetVec | DerivVec) -> Footprint:
    """Return what an elementwise statement reads and writes (no statement reads derivatives)."""
    footprint = value_footprint(action.value)
    footprint.elementwise.update((slot, slot + count) for slot, count in own_reads(action))
    footprint.writes.update((slot, slot + count) for slot, count in writes(action))
    return footprint


def needs_copy(footprint: Footprint) -> bool:
    """Whether a statement would read elements that it has already changed."""
    overwrites = any_overlap(footprint.writes, footprint.elsewhere)
    return overwrites or _partial_overlap(footprint.writes, footprint.elementwise)


def groups(actions: Iterable[Action | Rolled]) -> Iterator[list[Action | Rolled]]:
    """Group neighbouring statements that may share one loop; all others stand alone."""
    group: list[Action | Rolled] = []
    total = Footprint()
    count = 0
    for action in actions:
        if not isinstance(action, SetVec | DerivVec) or (
            isinstance(action, SetVec) and action.mode == "largest"
        ):
            if group:
                yield group
                group = []
            yield [action]
            continue
        footprint = statement_footprint(action)
        joins = (
            group
            and count == action.count
            and len(group) < _FUSED_MOST
            and not needs_copy(footprint)
            and not any_overlap(footprint.elsewhere, total.writes)
            and not any_overlap(footprint.writes, total.elsewhere)
            and not _partial_overlap(footprint.elementwise | footprint.writes, total.writes)
            and not _partial_overlap(footprint.writes, total.elementwise)
        )
        if joins:
            group.append(action)
            total.merge(footprint)
            continue
        if group:
            yield group
            group = []
        if needs_copy(footprint):
            yield [action]
            continue
        group, total, count = [action], footprint, action.count
    if group:
        yield group
