"""Which slots a segment's statements touch, and how."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.lowered.effects import ArrayPiece, expressions, reads, writes
from desire_tui.engine.lowered.expressions import ElementOperand
from desire_tui.engine.lowered.statements import ArrayAction
from desire_tui.engine.lowered.walk import walk_actions, walk_values

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.effects import Piece
    from desire_tui.engine.lowered.statements import Action


@dataclass(slots=True)
class SlotUsage:
    """Scalar slots read and written one by one; arrays (slot, count).

    `only_scalars`: no statement over arrays, no array operand.
    """

    read: set[int] = field(default_factory=set)
    written: set[int] = field(default_factory=set)
    arrays: set[Piece] = field(default_factory=set)
    only_scalars: bool = True
    statements: int = 0

    @property
    def pinned(self) -> frozenset[int]:
        """Scalars that are elements of arrays which other statements reach by address."""
        return frozenset(
            s
            for s in self.read | self.written
            if any(slot <= s < slot + count for slot, count in self.arrays)
        )


def survey(passes: Iterable[Iterable[Action]]) -> SlotUsage:
    """Look through all statements of all passes; one that stands in several passes counts once."""
    usage = SlotUsage()
    seen: set[int] = set()
    for actions in passes:
        for outer in actions:
            if id(outer) not in seen:
                seen.add(id(outer))
                for action in walk_actions((outer,)):
                    _add(action, usage)
    return usage


def _add(action: Action, usage: SlotUsage) -> None:
    usage.statements += 1
    usage.only_scalars &= not isinstance(action, ArrayAction)
    usage.only_scalars &= not any(isinstance(n, ElementOperand) for n in walk_values(*expressions(action)))
    for pieces, scalars in ((reads(action), usage.read), (writes(action), usage.written)):
        for piece in pieces:
            if isinstance(piece, ArrayPiece):
                usage.arrays.add(piece)
            else:
                scalars.add(piece[0])
