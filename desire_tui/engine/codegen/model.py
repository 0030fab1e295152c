"""A segment as native code under one rule."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.analysis.slices import derivative_slice, full_pass, step_slice, tail_pass
from desire_tui.engine.codegen.context import PASSES, Context
from desire_tui.engine.codegen.loopcode import register_loop
from desire_tui.engine.codegen.pieces import cut, write
from desire_tui.engine.codegen.scope import survey
from desire_tui.engine.runtime.memory import Ended, RunMemory

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.codegen.backend import NativeBackend
    from desire_tui.engine.codegen.pieces import Piece
    from desire_tui.engine.codegen.store import Compiled
    from desire_tui.engine.lowered import Action, Segment
    from desire_tui.engine.values import Values

_RUN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)
SMALL = 200
"""Segments with at most this many statements and states run out of registers."""


class NativeModel:
    """A compiled segment: starts on quick code, goes over to fast code when that is ready.

    Both compute the same bits: neither reassociates, contracts or replaces anything.
    """

    def __init__(self, backend: NativeBackend, segment: Segment, rule: int, values: Values) -> None:
        self._store = backend.store
        self._segment = segment
        self._values = values
        self._states = _state_slots(segment)
        self._columns = np.array([column.slot for column in segment.columns], dtype=np.int64)
        self.context = Context(values=values.address)
        self._kept: list[object] = []
        self._pieces: list[Piece] = []
        self._tables: dict[str, list[str]] = {}
        passes = _passes(segment)
        scope = survey(passes.values())
        self._small = scope.only_scalars and scope.statements <= SMALL and segment.order <= SMALL
        self._stage_memory(4 if not self._small else 1)
        if self._small:
            self._loop = register_loop(passes, rule, self._states.tolist(), self._columns.tolist())
            self._use(self._store.quick([self._loop])[self._loop.name])
        else:
            self._make_tables(passes)
            self._use(backend.loops.get(rule, contiguous=self._contiguous))
        self._better: Compiled | None = None
        backend.improver.add(self)

    # ------------------------------------------------------------------ making

    @property
    def _contiguous(self) -> bool:
        states = self._states
        return not states.size or bool(states[-1] - states[0] == states.size - 1 and (np.diff(states) == 1).all())

    def _stage_memory(self, stages: int) -> None:
        order = max(self._states.size, 1)
        arrays = np.zeros((1 + stages, order))
        context = self.context
        context.states = self._states.size
        context.state_slots = self._states.ctypes.data
        context.x = self._values.address + 8 * int(self._states[0]) if self._states.size else 0
        context.columns = self._columns.ctypes.data
        context.column_count = self._columns.size
        for name, array in zip(("x0", "k1", "k2", "k3", "k4"), arrays, strict=False):
            setattr(context, name, array.ctypes.data)
        self._kept.append(arrays)

    def _make_tables(self, passes: dict[str, tuple[Action, ...]]) -> None:
        """Compile all pieces quickly and point the context's tables at them."""
        for kind in PASSES:
            pieces = [write(group) for group in cut(passes[kind])]
            self._pieces += pieces
            self._tables[kind] = [piece.name for piece in pieces]
        found = self._store.quick(self._pieces)
        self._addresses: dict[str, list[ctypes.c_uint64]] = {}
        for kind, names in self._tables.items():
            table = (ctypes.c_uint64 * (len(names) + 1))(*(found[name].address for name in names), 0)
            setattr(self.context, kind, ctypes.addressof(table))
            self._kept.append(table)
            for place, name in enumerate(names):
                entry = ctypes.c_uint64.from_buffer(table, 8 * place)
                self._addresses.setdefault(name, []).append(entry)
        self._kept.extend(found.values())

    def _use(self, compiled: Compiled) -> None:
        self._kept.append(compiled)
        self._run = _RUN(compiled.address)

    def improve(self) -> Iterator[None]:
        """Compile fast code and put it in use, piece by piece."""
        if self._small:
            self._better = self._store.fast(self._loop)
            self.context.hurry = 1
            yield
            return
        for piece in {p.name: p for p in self._pieces}.values():
            better = self._store.fast(piece)
            self._kept.append(better)
            for entry in self._addresses[piece.name]:
                entry.value = better.address  # one aligned store: the running loop sees the old or the new
            yield

    # ------------------------------------------------------------------ running

    def advance(self, memory: RunMemory) -> Ended:
        """Run on (`runtime.memory`)."""
        self.context.memory = ctypes.addressof(memory)
        at, context = ctypes.addressof(memory), ctypes.addressof(self.context)
        while True:
            self.context.hurry = 0  # before looking: who raises it has put the better code there first
            better, self._better = self._better, None
            if better is not None:
                self._use(better)
            ended = Ended(self._run(at, context))
            if ended is not Ended.RUNNING or memory.row >= memory.row_limit:
                break
        if ended is Ended.NOT_FINITE:
            memory.which = self._first_wild()
        return ended

    def _first_wild(self) -> int:
        """Return the number of the first state that is inf or nan, or -1 - that of the first column."""
        data = self._values.data
        for number, slots in enumerate((self._states, self._columns)):
            wild = np.flatnonzero(~np.isfinite(data[slots]))
            if wild.size:
                return int(wild[0]) if number == 0 else -1 - int(wild[0])
        return 0


def _passes(segment: Segment) -> dict[str, tuple[Action, ...]]:
    return {
        "derivative": derivative_slice(segment),
        "step": step_slice(segment),
        "full": full_pass(segment),
        "tail": tail_pass(segment),
    }


def _state_slots(segment: Segment) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    slots = np.zeros(segment.order, dtype=np.int64)
    for piece in segment.states:
        slots[piece.first : piece.first + piece.count] = np.arange(piece.slot, piece.slot + piece.count)
    return slots
