"""Rolled-up statements as functions of data: with other slots, numbers or counts they find their code.

An edit among a thousand equations makes two loops of one. With slots and counts in their text LLVM compiled
both again, a quarter of the time to the next run. Here the text depends on the statements' shape alone, and
on where each operand comes from. The rest is the piece's data `%d`, cells of 8 bytes: how many statements,
the first target, then the operands in turn, as `_Source` says.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.ir.text import IrText, bits
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import PieceCall
from desire_tui.engine.codegen.pieces.pass_pieces import finished
from desire_tui.engine.codegen.scalar import templates
from desire_tui.engine.codegen.scalar.rerolling import Rolled, plain_shape
from desire_tui.engine.lowered.statements import Deriv, Set
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action

_Source = tuple[Literal["side", "slots", "numbers"], int]
"""Slots side by side: a cell with the first one. So many slots or numbers that come round: a cell each."""
_Cells = tuple[int, ...]


class _Kind(NamedTuple):
    """What statements have in common that one function serves."""

    sets: bool
    shape: tuple[object, ...]
    width: int
    sources: tuple[_Source, ...]


_ROOM = 500
_pieces: RecentlyUsed[_Kind, Piece] = RecentlyUsed(_ROOM)
_seen: RecentlyUsed[_Kind, frozenset[_Cells]] = RecentlyUsed(_ROOM)
"""What statements of these kinds had for data when they were written with it in their text."""


class FunctionsOfData:
    """Decides for the passes of a model which of their statements are called with data, and has the calls.

    The first model of a kind is not: its text holds all, and is a little quicker. Other data in the next one,
    most likely an edit's, make the function worth it.
    """

    def __init__(self) -> None:
        _pieces.age()
        _seen.age()
        self._calls: dict[int, tuple[_Kind, _Cells]] = {}
        self._written: dict[_Kind, set[_Cells]] = {}

    def is_one(self, action: Action | Rolled) -> bool:
        """Whether rolled-up statements, or one alone beside such, are to be called with data."""
        if not (self._calls or isinstance(action, Rolled)):
            return False
        found = _kind_and_cells(action)
        if found is None:
            return False
        kind, cells = found
        known = _seen[kind]
        if _pieces[kind] is None and (known is None or cells in known):
            self._written.setdefault(kind, set()).add(cells)
            return False
        self._calls[id(action)] = found
        return True

    def call(self, action: Action | Rolled) -> PieceCall:
        """Return the call of what is to be called with data."""
        kind, cells = self._calls[id(action)]
        piece = _pieces[kind]
        if piece is None:
            value = (action.first if isinstance(action, Rolled) else action).value  # type: ignore[union-attr]  # has a shape
            piece = _written(value, kind)
            _pieces.keep(kind, piece)
        return PieceCall(piece, (ctypes.c_uint64 * len(cells))(*cells))

    def remember(self) -> None:
        """Note what was written with its data in its text: the model's passes are complete."""
        for kind, cells in self._written.items():
            _seen.keep(kind, frozenset(cells))


def _kind_and_cells(action: Action | Rolled) -> tuple[_Kind, _Cells] | None:
    """Return what decides on a function, and its data; None: threads share it, or slots mix with numbers."""
    width = machine().width
    first, count = (action.first, action.count) if isinstance(action, Rolled) else (action, 1)
    found = plain_shape(first)
    if found is None or not isinstance(first, Set | Deriv) or is_large(count) or width == 1:
        return None
    sources: list[_Source] = []
    cells = [count, first.slot if isinstance(first, Set) else first.state]
    for operand in action.operands if isinstance(action, Rolled) else found[1]:
        if isinstance(operand, int):
            sources.append(("side", 1))
            cells.append(operand)
            continue
        leaves = operand if isinstance(operand, tuple) else (operand,)
        slots = [leaf for leaf in leaves if isinstance(leaf, int)]
        if slots and len(slots) < len(leaves):
            return None
        around = slots or [bits(leaf) for leaf in leaves]
        period = next(n for n in range(1, width + 1) if around == (around[:n] * width)[: len(around)])
        sources.append(("slots" if slots else "numbers", period))
        cells += around[:period]
    return _Kind(type(first) is Set, found[0], width, tuple(sources)), tuple(cells)


def forget() -> None:
    """Forget all functions."""
    _pieces.forget()
    _seen.forget()


def _written(value: Value, kind: _Kind) -> Piece:
    text = IrText()
    wide = Lanes(text, kind.width)
    cells = 0

    def cell(of: str = "i64") -> str:
        nonlocal cells
        cells += 1
        return text.op(f"load {of}, ptr {text.op(f'getelementptr i64, ptr %d, i64 {cells - 1}')}")

    def slot() -> str:
        return text.op(f"getelementptr double, ptr %v, i64 {cell()}")

    count = cell()
    target = text.op(f"getelementptr double, ptr {'%v' if kind.sets else '%dx'}, i64 {cell()}")
    operands = []
    for source, period in kind.sources:
        if source == "side":
            operands.append(slot())
        elif source == "slots":
            operands.append(wide.around([text.op(f"load double, ptr {slot()}") for _ in range(period)]))
        else:
            operands.append(wide.around([cell("double") for _ in range(period)]))

    def strip(index: str, flags: str | None) -> None:
        def address(base: str) -> str:
            return text.op(f"getelementptr double, ptr {base}, i64 {index}")

        leaves = []
        for operand, (source, _) in zip(operands, kind.sources, strict=True):
            if source != "side":
                leaves.append(operand)
            elif flags is None:
                leaves.append(text.op(f"load {wide.kind}, ptr {address(operand)}, align 8"))
            else:
                leaves.append(wide.load_some(address(operand), flags))
        made = templates.write_shape(wide, value, iter(leaves))
        if flags is None:
            text.do(f"store {wide.kind} {made}, ptr {address(target)}, align 8")
        else:
            wide.store_some(made, address(target), flags)

    rest = text.op(f"and i64 {count}, {kind.width - 1}")
    full = text.op(f"sub i64 {count}, {rest}")
    loop(text, "0", full, kind.width, lambda index: strip(index, None))
    flags = wide.first_lanes(rest)
    loop(text, full, count, kind.width, lambda index: strip(index, flags))  # once, if anything is left
    return finished(text)
