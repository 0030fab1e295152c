"""What array statements read and write, element by element or otherwise, and which may share a loop."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

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
class Reach:
    """Ranges (slot, end). `same`: read at the element's own index; `other`: read anyhow else."""

    same: set[Range] = field(default_factory=set)
    other: set[Range] = field(default_factory=set)
    writes: set[Range] = field(default_factory=set)

    def absorb(self, more: Reach) -> None:
        """Add another statement's."""
        self.same |= more.same
        self.other |= more.other
        self.writes |= more.writes


def overlap(a: Range, b: Range) -> bool:
    """Whether two ranges share a slot."""
    return a[0] < b[1] and b[0] < a[1]


def touches(ranges: Iterable[Range], others: Iterable[Range]) -> bool:
    """Whether any two overlap."""
    listed = list(others)
    return any(overlap(a, b) for a in ranges for b in listed)


def _crosses(ranges: Iterable[Range], others: Iterable[Range]) -> bool:
    """Whether any two overlap without being the same range."""
    listed = list(others)
    return any(a != b and overlap(a, b) for a in ranges for b in listed)


def value_reach(node: Value) -> Reach:
    """Return what an expression reads."""
    reach = Reach()
    for part in walk_values(node):
        ranges = reach.same if isinstance(part, Vec) else reach.other
        ranges.update((slot, slot + count) for slot, count in memory(part))
    return reach


def statement_reach(action: SetVec | DerivVec) -> Reach:
    """Return what an elementwise statement reads and writes (derivatives are nobody's operand)."""
    reach = value_reach(action.value)
    reach.same.update((slot, slot + count) for slot, count in own_reads(action))
    reach.writes.update((slot, slot + count) for slot, count in writes(action))
    return reach


def needs_copy(reach: Reach) -> bool:
    """Whether a statement would read elements that it has already changed."""
    return touches(reach.writes, reach.other) or _crosses(reach.writes, reach.same)


def groups(actions: Iterable[Action | Rolled]) -> Iterator[list[Action | Rolled]]:
    """Group neighbouring statements that may share one loop; all others stand alone."""
    group: list[Action | Rolled] = []
    total = Reach()
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
        reach = statement_reach(action)
        joins = (
            group
            and count == action.count
            and len(group) < _FUSED_MOST
            and not needs_copy(reach)
            and not touches(reach.other, total.writes)
            and not touches(reach.writes, total.other)
            and not _crosses(reach.same | reach.writes, total.writes)
            and not _crosses(reach.writes, total.same)
        )
        if joins:
            group.append(action)
            total.absorb(reach)
            continue
        if group:
            yield group
            group = []
        if needs_copy(reach):
            yield [action]
            continue
        group, total, count = [action], reach, action.count
    if group:
        yield group
