"""Pieces of earlier programs: after an edit only the piece with the edited line is written anew.

Lowering gives the same value for the same text, so that a piece of scalar statements is known by
what they set and by their values' ids.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.pieces.pass_pieces import write
from desire_tui.engine.lowered.statements import Deriv, Set
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.codegen.scalar.rerolling import Rolled
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

    Key = tuple[tuple[bool, int, int], ...]

_STATEMENTS_ROOM = 5_000
"""Statements of earlier programs: some 500 bytes of text each."""
_pieces: RecentlyUsed[Key, tuple[Piece, list[Value]]] = RecentlyUsed(_STATEMENTS_ROOM, cost=len)
"""With the values, whose ids stay taken."""


def piece_of(actions: Sequence[Action | Rolled]) -> Piece:
    """Return a pass's piece, written now or earlier."""
    statements = [action for action in actions if type(action) is Deriv or type(action) is Set]
    if len(statements) < len(actions):
        return write(actions)
    key = tuple([(type(action) is Deriv, _target(action), id(action.value)) for action in statements])
    known = _pieces[key]
    if known is None:
        known = write(actions), [action.value for action in statements]
        _pieces.keep(key, known)
    return known[0]


def _target(action: Set | Deriv) -> int:
    return action.slot if isinstance(action, Set) else action.state


def age() -> None:
    """Between two programs: forget pieces that no program of late had."""
    _pieces.age()


def forget() -> None:
    """Forget all pieces."""
    _pieces.forget()
