"""Which memory a lowered expression or assignment touches, as pieces (slot, count)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered import (
    Deriv,
    DerivVec,
    Load,
    MatVec,
    Op,
    Outer,
    RowOf,
    Set,
    SetDot,
    SetMat,
    SetVec,
    Shifted,
    Table1,
    Table2,
    Vec,
)  # fmt: skip

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.lowered import Action, Value

Piece = tuple[int, int]


def ranges_of(value: Value | None) -> Iterator[Piece]:
    """List what an expression reads; tables' breakpoints and values left out."""
    if isinstance(value, Load):
        yield value.slot, 1
    elif isinstance(value, Op):
        for argument in value.args:
            yield from ranges_of(argument)
    elif isinstance(value, Vec | Shifted):
        yield value.slot, value.count
    elif isinstance(value, MatVec):
        yield value.slot, value.rows * value.cols
        yield value.x_slot, value.rows if value.transposed else value.cols
    elif isinstance(value, RowOf):
        yield value.slot, value.rows * value.cols
    elif isinstance(value, Outer):
        yield value.u_slot, value.u_count
        yield value.v_slot, value.v_count
    elif isinstance(value, Table1):
        yield from ranges_of(value.x)
    elif isinstance(value, Table2):
        yield from ranges_of(value.x)
        yield from ranges_of(value.y)


def reads(action: Action) -> list[Piece]:
    """List what an assignment or derivative statement reads (not: its mask)."""
    if isinstance(action, Set | SetVec | Deriv | DerivVec):
        return list(ranges_of(action.value))
    if isinstance(action, SetMat):
        return [*ranges_of(action.value), *ranges_of(action.lower), *ranges_of(action.upper)]
    if isinstance(action, SetDot):
        return [piece for t in action.terms for side in (t.left, t.right) for piece in ranges_of(side)]
    return []


def writes(action: Action) -> list[Piece]:
    """List what an assignment writes."""
    if isinstance(action, Set | SetDot):
        return [(action.slot, 1)]
    if isinstance(action, SetVec):
        return [(action.slot, action.count)]
    if isinstance(action, SetMat):
        return [(action.slot, action.rows * action.cols)]
    return []
