"""Passes as tables of compiled pieces whose entries change to faster code while others call through them."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import PieceCall
from desire_tui.engine.codegen.pieces.kept_pieces import piece_of
from desire_tui.engine.codegen.pieces.pass_pieces import cut
from desire_tui.engine.codegen.scalar.rerolling import Rolled, roll

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.codegen.jit.cache import CodeCache, Compiled
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.codegen.pieces.rolled_pieces import FunctionsOfData
    from desire_tui.engine.lowered.statements import Action

    NamedCall = tuple[str, ctypes.Array[ctypes.c_uint64] | None]
    """A `PieceCall` by the piece's name."""

ENTRY_BYTES = 16


class PieceTables:
    """Tables of the addresses of pieces and of their data, each ended by 0, by the pass they belong to.

    `temps` is the scratch memory, in doubles, that the pieces want at `Context.temps`.
    """

    def __init__(self, store: CodeCache, passes: Mapping[str, tuple[Action, ...]]) -> None:
        self._store = store
        self._pieces: dict[str, Piece] = {}
        calls: dict[str, list[PieceCall]] = {}
        written: dict[tuple[int, ...], PieceCall] = {}  # passes share most statements
        rolled: dict[tuple[int, ...], list[list[Action | Rolled]]] = {}
        functions: FunctionsOfData | None = None
        for kind, actions in passes.items():
            calls[kind] = []
            whole = tuple(map(id, actions))
            if whole not in rolled:
                statements = roll(actions, machine().width)
                if functions is None and any(isinstance(statement, Rolled) for statement in statements):
                    functions = _functions_of_data()
                rolled[whole] = [*(cut(statements, functions.is_one) if functions else cut(statements))]
            for group in rolled[whole]:
                key = tuple(map(id, group))
                call = written.get(key)
                if call is None:
                    cancellation_point()
                    call = written[key] = _call_of(group, functions)
                    self._pieces[call.piece.name] = call.piece
                calls[kind].append(call)
        if functions is not None:
            functions.remember()
        temps = max((piece.temps for piece in self._pieces.values()), default=0)
        named = {kind: [(piece.name, data) for piece, data in listed] for kind, listed in calls.items()}
        self._lay_out(named, temps, store.quick(self._pieces.values()))

    def _lay_out(
        self, calls: Mapping[str, Sequence[NamedCall]], temps: int, found: Mapping[str, Compiled]
    ) -> None:
        """Write the tables of the passes' calls; `found` are the pieces by their names."""
        self.calls, self.temps = calls, temps
        self.kind = hash(tuple(name for listed in calls.values() for name, _ in listed))
        """The same for models whose pieces have the same texts."""
        self._kept: list[object] = list(found.values())
        self._entries: dict[str, list[ctypes.c_uint64]] = {}
        self.addresses: dict[str, int] = {}
        for kind, listed in calls.items():
            table = (ctypes.c_uint64 * (2 * len(listed) + 1))()
            self.addresses[kind] = ctypes.addressof(table)
            self._kept.append(table)
            for place, (name, data) in enumerate(listed):
                table[2 * place] = found[name].address
                if data is not None:
                    table[2 * place + 1] = ctypes.addressof(data)
                    self._kept.append(data)
                entry = ctypes.c_uint64.from_buffer(table, ENTRY_BYTES * place)
                self._entries.setdefault(name, []).append(entry)

    @property
    def pieces(self) -> Mapping[str, Piece]:
        """The pieces by name."""
        return self._pieces

    def improve(self) -> Iterator[None]:
        """Compile the pieces well, one at each step, and put them in use."""
        for name, entries in self._entries.items():
            better = self._fast(name)
            self._kept.append(better)
            for entry in entries:
                entry.value = better.address  # one aligned store: who calls sees the old or the new
            yield

    def _fast(self, name: str) -> Compiled:
        return self._store.fast(self.pieces[name])


def _functions_of_data() -> FunctionsOfData:
    from desire_tui.engine.codegen.pieces.rolled_pieces import FunctionsOfData  # few models are so large

    return FunctionsOfData()


def _call_of(group: Sequence[Action | Rolled], functions: FunctionsOfData | None) -> PieceCall:
    """Return a group of a pass as a call of its piece."""
    if functions is not None and len(group) == 1 and functions.is_one(group[0]):
        return functions.call(group[0])
    return PieceCall(piece_of(group))
