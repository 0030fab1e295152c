"""A segment as native code under one rule."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.ir.work_memory import PASSES, WorkMemory
from desire_tui.engine.codegen.loop.compiled_loops import array_loop, register_loop
from desire_tui.engine.codegen.loop.state_blocks import state_blocks
from desire_tui.engine.codegen.loop.switched_steps import NOTHING, Watched
from desire_tui.engine.codegen.pieces.piece_tables import PieceTables
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.passes.assigned_states import checked_state, stepped_segment
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.runtime.run_faults import first_not_finite
from desire_tui.engine.runtime.run_memory import Ended, Phase, RunMemory

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache, Compiled
    from desire_tui.engine.codegen.loop.looks import Looks
    from desire_tui.engine.integration.switching.setup import Watcher
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.values import Values

_RUN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)
_ARRAYS = 5  # states at the step's start and four stages' derivatives
SMALL = 200
"""Segments with at most this many statements and states run out of registers."""
PAIRED_LEAST = 16
"""States from which such a segment gains by being computed two at a time.

With fewer, each step waits for the packing: Van der Pol's equation 13 % longer, coupled oscillators 27 %.
"""


class NativeModel:
    """A compiled segment: starts on quick code, goes over to fast code when that is ready.

    Quick code is a table of pieces compiled without optimisation, run by the loop over arrays that all models
    of a rule share. Fast code is the same well compiled or, for small models, one function that keeps
    everything in registers. All compute the same bits: none reassociates, contracts or replaces anything.
    """

    def __init__(
        self, code: CodeCache, improver: Improver, segment: Segment, rule: int, values: Values
    ) -> None:
        self._store = code
        given = segment
        known = _found_again(code, segment, rule) if segment.noted is not None else None
        switching = None
        self._is_found = known is not None
        if known is not None:
            vital, self._passes, self._tables = known
            self._numbers: Sequence[int] = range(segment.order)
        else:
            vital = vital_columns(segment)
            variable = rule_numbered(rule).kind == "variable"
            segment, self._numbers = stepped_segment(segment, values.room, variable=variable)
            if variable:
                from desire_tui.engine.passes.switching import switching as switches  # 2 ms

                segment, switching = switches(segment, values.room)
            self._passes = passes_of(segment, variable=variable)
            if switching is not None:
                self._passes |= {"watch_stage": switching.stage_pass, "watch_end": switching.end_pass}
            self._tables = PieceTables(self._store, self._passes)
        self._is_as_given = segment is given and switching is None
        self._segment = segment
        self._rule = rule
        self._values = values
        self._states = _state_slots(segment)
        self._columns = np.array([column.slot for column in segment.columns], dtype=np.int64)
        self._vital = np.array(vital, dtype=np.int64)
        self._vital_slots = self._columns[self._vital]
        self._temps = np.zeros(self._tables.temps)
        self.context = WorkMemory(values=values.address, temps=self._temps.ctypes.data)
        for kind in PASSES:
            setattr(self.context, kind, self._tables.addresses[kind])
        self._kept: list[object] = []
        self._no_pass = ctypes.c_uint64(0)
        self._stage_memory()
        self._watcher: Watcher | None = None
        self._watched = NOTHING
        self._looks: Looks | None = None
        if switching is not None:
            self._watch(switching)
        contiguous = bool((np.diff(self._states) == 1).all())
        self._loop = array_loop(rule, contiguous=contiguous, watched=self._watched, share=self._share())
        self._use(self._store.quick([self._loop])[self._loop.name])
        self._better: Compiled | None = None
        self.improved = self._small = False
        self._improver = improver
        self.kind = hash((rule, self._tables.kind))
        improver.add(self)

    # ------------------------------------------------------------------ making

    def _stage_memory(self) -> None:
        order = max(self._states.size, 1)
        room = -(-order // 8) * 8 + 8  # whole cache lines, and no two arrays at the same place of a page
        flat = np.zeros(_ARRAYS * room + 8)
        aligned = flat[-(flat.ctypes.data // 8) % 8 :]
        arrays = [aligned[i * room :] for i in range(_ARRAYS)]
        context = self.context
        context.states = self._states.size
        context.state_slots = self._states.ctypes.data
        context.x = self._values.address + 8 * int(self._states[0]) if self._states.size else 0
        context.columns = self._columns.ctypes.data
        context.column_count = self._columns.size
        context.vital, context.vital_count = self._vital_slots.ctypes.data, self._vital.size
        for name, array in zip(("x0", "k1", "k2", "k3", "k4"), arrays, strict=False):
            setattr(context, name, array.ctypes.data)
        self._kept.append(flat)

    def _share(self) -> int:
        """Return what shares loops over the states among threads; 0: there are too few of them."""
        if not is_large(self._states.size):
            return 0
        blocks = state_blocks((s.slot, s.first, s.count) for s in self._segment.states)
        if blocks is None:
            return 0
        from desire_tui.engine.codegen.threads.pool import thread_pool  # few models are so large

        partial = np.zeros(2 * len(blocks))
        context = self.context
        context.blocks, context.block_count = blocks.ctypes.data, len(blocks)
        context.partial = partial.ctypes.data
        self._kept += [partial, blocks]
        return thread_pool().share

    def _watch(self, switching: Switching) -> None:
        """Prepare what sees to the segment's switches, with modules that few programs need."""
        from desire_tui.engine.codegen.loop.looks import looks
        from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
        from desire_tui.engine.codegen.switching.watch_routines import watch_functions
        from desire_tui.engine.integration.switching.memory import Watch
        from desire_tui.engine.integration.switching.setup import Watcher

        values, segment, context = self._values, self._segment, self.context
        self._watched = Watched(bool(switching.clocks), bool(switching.modes))
        slots = switching.slots
        self._looks = looks(switching)
        context.mode_count = switching.count
        for row in ("frozen", "first", "second"):
            setattr(context, f"modes_{row}", values.address + 8 * getattr(slots, row))
        ranges = [(s.slot, s.first, s.count) for s in segment.states]
        inner = {"modes": switching.live_pass, "derivative": self._passes["derivative"]}
        functions = PassFunctions(self._store, values, segment.order, inner, frozenset())
        watching = watch_functions()
        self._watcher = watcher = Watcher(switching, values, ranges)
        modes, derivative = functions.address("modes"), functions.address("derivative")
        watcher.connect(watching.begin, modes, derivative, watching.place_on_step, watcher.address)
        watcher.take_step_from(context.x0, context.k1)
        context.watch, context.limit = watcher.address, watching.limit
        context.follow, context.depart = watching.follow, watching.depart
        for side in ("box_low", "box_high"):
            setattr(context, side, ctypes.cast(getattr(watcher.watch, side), ctypes.c_void_p).value)
        context.box_wait = watcher.address + Watch.box_wait.offset
        self._kept += [functions, watching]

    def _use(self, compiled: Compiled) -> None:
        self._kept.append(compiled)
        self._run = _RUN(compiled.address)

    def improve(self) -> Iterator[None]:
        """Compile fast code and put it in use, piece by piece."""
        small = self._small = self._is_small()
        if small:
            states, columns = self._states.tolist(), self._columns.tolist()
            self._loop = register_loop(self._passes, self._rule, states, columns, self._vital_slots.tolist(),
                                       watched=self._watched, looks=self._looks)  # fmt: skip
        self._better = self._store.fast(self._loop, slp=not small or self._segment.order >= PAIRED_LEAST)
        self.context.hurry = 1
        yield
        if not small:
            yield from self._tables.improve()
            yield from self._take_whole_steps()
        self.improved = True

    def _take_whole_steps(self) -> Iterator[None]:
        """Compile the whole step of a model of replicas, and put it in the place of passes."""
        if self._segment.order == 0 or rule_numbered(self._rule).kind != "fixed":
            return
        from desire_tui.engine.passes.replicas import replicated

        model = replicated(self._passes, self._segment.states)
        if model is None:
            return
        from desire_tui.engine.codegen.lanes.replica_steps import replica_steps

        step = self._store.fast(replica_steps(model, TABLEAUS[self._rule]), slp=False)
        self._kept.append(step)
        self.context.whole_step = (
            step.address
        )  # first: who still finds a pass in the table computes it in vain
        self.context.step = ctypes.addressof(self._no_pass)
        yield

    def _is_small(self) -> bool:
        if self._is_found or self._segment.order > SMALL or len(self._segment.body) > SMALL:
            return False
        from desire_tui.engine.codegen.scalar.slot_usage import survey  # short runs are over before that

        usage = survey(self._passes.values())
        return usage.only_scalars and usage.statements <= SMALL

    def noted(self) -> tuple[object, ...] | None:
        """Return what makes this model quickly in another process, as plain data; None: nothing does."""
        if not self._is_as_given or self._is_small():  # then fast code is one function made of the statements
            return None
        from desire_tui.engine.codegen.pieces.noted_code import noted_code

        return noted_code(self._store, self._rule, self._vital.tolist(), self._tables)

    # ------------------------------------------------------------------ running

    def advance(self, memory: RunMemory) -> Ended:
        """Run on (`runtime.run_memory`)."""
        self.context.memory = ctypes.addressof(memory)
        at, context = ctypes.addressof(memory), ctypes.addressof(self.context)
        if self._watcher is not None:
            self._watcher.forget_box()
        if self._watcher is not None and memory.phase == Phase.AT_POINT and memory.point == 0:
            self._watcher.begin(memory)
        checked = memory.checked
        memory.checked = checked_state(checked, self._numbers)
        while True:
            self.context.hurry = 0  # before looking: who raises it has put the better code there first
            better, self._better = self._better, None
            if better is not None:
                self._use(better)
                if self._watcher is not None and self._small:
                    self._watcher.keep_box()
            with self._improver.running(self):
                ended = Ended(self._run(at, context))
            if ended is not Ended.RUNNING or memory.row >= memory.row_limit:
                break
        memory.checked = checked
        if ended is Ended.CHATTERS and self._watcher is not None:
            memory.culprit = self._watcher.culprit()
        if ended is Ended.NOT_FINITE:
            memory.which = first_not_finite(self._values.data, self._states, self._columns, self._vital)
        if ended in {Ended.NOT_FINITE, Ended.DEADLOCK, Ended.STALLED} and memory.which >= 0:
            memory.which = self._numbers[memory.which]
        return ended


def _found_again(
    store: CodeCache, segment: Segment, rule: int
) -> tuple[Sequence[int], Mapping[str, tuple[Action, ...]], PieceTables] | None:
    from desire_tui.engine.codegen.pieces.noted_code import found_again  # few models are so large

    return found_again(store, segment, rule)


def _state_slots(segment: Segment) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    if all(piece.count == 1 for piece in segment.states):
        return np.array([piece.slot for piece in segment.states], dtype=np.int64)
    slots = np.zeros(segment.order, dtype=np.int64)
    for piece in segment.states:
        slots[piece.first : piece.first + piece.count] = np.arange(piece.slot, piece.slot + piece.count)
    return slots
