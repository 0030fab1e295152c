"""Rolled-up statements as functions of data: what is rolled up with other slots, numbers or counts finds its code.

An edit among a thousand equations makes two loops of one. With slots and counts in their text LLVM compiled
both again, a quarter of the time to the next run. Here the text depends on the statements' shape alone, and on
where each operand comes from. The rest is the piece's data `%d`, cells of 8 bytes: how many statements, the
first target, then the operands in turn, as `_Source` says.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.ir.text import IrText, bits
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.pieces.pass_pieces import finished
from desire_tui.engine.codegen.scalar import templates
from desire_tui.engine.codegen.scalar.rerolling import Rolled, plain_shape
from desire_tui.engine.lowered.statements import Deriv, Set
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.lowered.statements import Action

_Source = Literal["side", "same", "numbers", "slots"]
"""Slots side by side: a cell with the first one. The same slot for all: a cell. Numbers or slots that come
round: a cell for each lane."""


class PieceCall(NamedTuple):
    """A piece and the data it is called with, if any."""

    piece: Piece
    data: ctypes.Array[ctypes.c_uint64] | None = None


class _Kind(NamedTuple):
    """What statements have in common that one function serves."""

    sets: bool
    shape: tuple[object, ...]
    width: int


_ROOM = 500
_pieces: RecentlyUsed[tuple[_Kind, tuple[_Source, ...]], Piece] = RecentlyUsed(_ROOM)
_sources: RecentlyUsed[_Kind, tuple[_Source, ...]] = RecentlyUsed(_ROOM)
"""Of the last function of a kind."""
_seen: RecentlyUsed[_Kind, bool] = RecentlyUsed(_ROOM)
"""Kinds of which a statement stood alone."""


def is_function_of_data(rolled: Rolled) -> bool:
    """Whether rolled-up statements become one; not those that threads share, nor slots mixed with numbers."""
    return not is_large(rolled.count) and None not in [_source(operand) for operand in rolled.operands]


def rolled_call(rolled: Rolled) -> PieceCall:
    """Return rolled-up statements that are a function of data as one, with their data."""
    found = plain_shape(rolled.first)
    assert found is not None  # or it would not have been rolled up
    sources = tuple([source for operand in rolled.operands if (source := _source(operand)) is not None])
    kind = _Kind(type(rolled.first) is Set, found[0], machine().width)
    return _call(kind, sources, rolled)


def lone_call(action: Action) -> PieceCall | None:
    """Return a statement beside rolled-up ones as a run of one, where such a function is there or worth it.

    The second statement of a kind is worth it: then whatever it is edited to has its code.
    """
    found = plain_shape(action)
    if found is None or not isinstance(action, Set | Deriv):
        return None
    shape, leaves = found
    kind = _Kind(type(action) is Set, shape, machine().width)
    sources = _sources[kind] or _sources_of_second(kind, leaves)
    if sources is None:
        return None
    operands: list[int | tuple[int | float, ...]] = []
    for leaf, source in zip(leaves, sources, strict=True):
        if isinstance(leaf, int) is (source == "numbers"):
            return None
        operands.append(leaf if source == "side" and isinstance(leaf, int) else (leaf,) * kind.width)
    return _call(kind, sources, Rolled(action, 1, tuple(operands)))


def _sources_of_second(kind: _Kind, leaves: Sequence[int | float]) -> tuple[_Source, ...] | None:
    if not _seen[kind]:
        _seen.keep(kind, True)
        return None
    return tuple(["side" if isinstance(leaf, int) else "numbers" for leaf in leaves])


def age() -> None:
    """Between two programs: forget functions that no program of late had."""
    _pieces.age()
    _sources.age()
    _seen.age()


def forget() -> None:
    """Forget all functions."""
    _pieces.forget()
    _sources.forget()
    _seen.forget()


def _source(operand: int | tuple[int | float, ...]) -> _Source | None:
    if isinstance(operand, int):
        return "side"
    kinds = {*map(type, operand)}
    if kinds == {float}:
        return "numbers"
    if kinds == {int}:
        return "same" if len({*operand}) == 1 else "slots"
    return None


def _call(kind: _Kind, sources: tuple[_Source, ...], rolled: Rolled) -> PieceCall:
    piece = _pieces[kind, sources]
    if piece is None:
        piece = _written(rolled.first, kind.width, sources)
        _pieces.keep((kind, sources), piece)
    _sources.keep(kind, sources)
    first = rolled.first
    cells = [rolled.count, first.slot if isinstance(first, Set) else first.state]
    for operand, source in zip(rolled.operands, sources, strict=True):
        if isinstance(operand, int):
            cells.append(operand)
        elif source == "same":
            cells.append(int(operand[0]))
        else:
            cells += [leaf if isinstance(leaf, int) else bits(leaf) for leaf in operand]
    return PieceCall(piece, (ctypes.c_uint64 * len(cells))(*cells))


def _written(first: Set | Deriv, width: int, sources: Sequence[_Source]) -> Piece:
    text = IrText()
    wide = Lanes(text, width)
    cells = 0

    def cell() -> str:
        nonlocal cells
        cells += 1
        return text.op(f"load i64, ptr {text.op(f'getelementptr i64, ptr %d, i64 {cells - 1}')}")

    def slot() -> str:
        return text.op(f"getelementptr double, ptr %v, i64 {cell()}")

    count = cell()
    target = text.op(f"getelementptr double, ptr {'%v' if isinstance(first, Set) else '%dx'}, i64 {cell()}")
    operands: list[str] = []
    for source in sources:
        if source == "side":
            operands.append(slot())
        elif source == "same":
            operands.append(wide.splat(text.op(f"load double, ptr {slot()}")))
        elif source == "numbers":
            operands.append(fetch(wide, "%d", str(cells)))
            cells += width
        else:
            value = "poison"
            for lane in range(width):
                one = text.op(f"load double, ptr {slot()}")
                value = text.op(f"insertelement {wide.kind} {value}, double {one}, i64 {lane}")
            operands.append(value)

    def strip(index: str, mask: str | None) -> None:
        leaves = []
        for operand, source in zip(operands, sources, strict=True):
            if source != "side":
                leaves.append(operand)
            elif mask is None:
                leaves.append(fetch(wide, operand, index))
            else:
                at = text.op(f"getelementptr double, ptr {operand}, i64 {index}")
                leaves.append(wide.load_some(at, mask))
        value = templates.write_shape(wide, first.value, iter(leaves))
        if mask is None:
            put(wide, target, index, value)
        else:
            wide.store_some(value, text.op(f"getelementptr double, ptr {target}, i64 {index}"), mask)

    rest = text.op(f"and i64 {count}, {width - 1}")
    whole = text.op(f"sub i64 {count}, {rest}")
    loop(text, "0", whole, width, lambda index: strip(index, None))
    flags = wide.first_lanes(rest)
    loop(text, whole, count, width, lambda index: strip(index, flags))  # once, if anything is left
    return finished(text)
