"""Passes as tables of compiled pieces whose entries change to faster code while others call through them."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.pieces.kept_pieces import piece_of
from desire_tui.engine.codegen.pieces.pass_pieces import cut
from desire_tui.engine.codegen.scalar.rerolling import roll

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.codegen.scalar.rerolling import Rolled
    from desire_tui.engine.lowered.statements import Action


class PieceTables:
    """Tables of function addresses, each ended by 0, by the pass they belong to.

    `temps` is the scratch memory, in doubles, that the pieces want at `Context.temps`.
    """

    def __init__(self, store: CodeCache, passes: Mapping[str, tuple[Action, ...]]) -> None:
        self._store = store
        self._pieces: dict[str, Piece] = {}
        names: dict[str, list[str]] = {}
        written: dict[tuple[int, ...], Piece] = {}  # passes share most statements
        rolled: dict[tuple[int, ...], list[list[Action | Rolled]]] = {}
        for kind, actions in passes.items():
            names[kind] = []
            whole = tuple(map(id, actions))
            if whole not in rolled:
                rolled[whole] = list(cut(roll(actions, machine().width)))
            for group in rolled[whole]:
                key = tuple(map(id, group))
                piece = written.get(key)
                if piece is None:
                    cancellation_point()
                    piece = written[key] = piece_of(group)
                    self._pieces[piece.name] = piece
                names[kind].append(piece.name)
        self.temps = max((piece.temps for piece in self._pieces.values()), default=0)
        found = store.quick(self._pieces.values())
        self._kept: list[object] = list(found.values())
        self._entries: dict[str, list[ctypes.c_uint64]] = {}
        self.addresses: dict[str, int] = {}
        for kind, listed_names in names.items():
            table = (ctypes.c_uint64 * (len(listed_names) + 1))()
            self.addresses[kind] = ctypes.addressof(table)
            self._kept.append(table)
            for place, name in enumerate(listed_names):
                table[place] = found[name].address
                entry = ctypes.c_uint64.from_buffer(table, 8 * place)
                self._entries.setdefault(name, []).append(entry)

    def improve(self) -> Iterator[None]:
        """Compile the pieces well, one at each step, and put them in use."""
        for name, piece in self._pieces.items():
            better = self._store.fast(piece)
            self._kept.append(better)
            for entry in self._entries[name]:
                entry.value = better.address  # one aligned store: who calls sees the old or the new
            yield
