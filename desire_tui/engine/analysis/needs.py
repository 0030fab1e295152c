"""Which statements of a pass anybody needs: a pass computes nothing that nobody can see.

Left out is a defined variable that no derivative, no persistent variable and no statement of this pass needs.
Persistent assignments and random draws are never left out, so every back end changes the same numbers in
the same passes.
"""

from __future__ import annotations

from desire_tui.engine.analysis.intervals import Intervals
from desire_tui.engine.lowered import Action, Guard, Set, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.reading import draws as count_draws
from desire_tui.engine.lowered.reading import expressions, reads, writes
from desire_tui.engine.values import SCALAR_SLOTS

Actions = tuple["Action", ...]


def needed(actions: Actions) -> Actions:
    """Leave out what no derivative, no persistent variable and no other kept statement uses."""
    return _backward(actions, _Reads())


def draws(action: Action) -> bool:
    """Whether a statement draws random numbers."""
    return count_draws(*expressions(action)) > 0


def with_bodies(guard: Guard, body: Actions, orelse: Actions) -> Guard:
    """Return a guard that holds other statements."""
    return Guard(guard.kind, body, guard.where, guard.condition, orelse, guard.every)


class _Reads:
    """Numbers that kept statements read: scalars by slot, arrays and their elements as intervals."""

    def __init__(self) -> None:
        self._scalars: set[int] = set()
        self._ranges = Intervals()

    def add(self, action: Action) -> None:
        """Add what a kept statement reads (a guard: its condition)."""
        for slot, count in reads(action):
            if count == 1 and slot < SCALAR_SLOTS:
                self._scalars.add(slot)
            else:
                self._ranges.add(slot, count)

    def touch(self, slot: int, count: int) -> bool:
        """Whether any of `count` numbers from `slot` on is read."""
        if self._ranges.touches(slot, count):
            return True
        if count == 1:
            return slot in self._scalars
        return slot < SCALAR_SLOTS and any(slot <= s < slot + count for s in self._scalars)


def _backward(actions: Actions, seen: _Reads) -> Actions:
    kept: list[Action] = []
    for action in reversed(actions):
        if isinstance(action, Guard):
            orelse = _backward(action.orelse, seen)
            body = _backward(action.body, seen)
            if not (body or orelse):
                continue
            kept.append(with_bodies(action, body, orelse))
        elif _is_needed(action, seen):
            kept.append(action)
        else:
            continue
        seen.add(kept[-1])
    return tuple(reversed(kept))


def _is_needed(action: Action, seen: _Reads) -> bool:
    if not isinstance(action, Set | SetVec | SetMat | SetDot) or action.persistent or draws(action):
        return True
    return any(seen.touch(slot, count) for slot, count in writes(action))
