"""A segment with events as native code under a rule 0 … 8."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.work_memory import PASSES, WorkMemory
from desire_tui.engine.codegen.moments.moment_loop import moment_loop
from desire_tui.engine.codegen.moments.moment_routines import moment_functions
from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
from desire_tui.engine.codegen.pieces.piece_tables import PieceTables
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.codegen.switching.watch_routines import watch_functions
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.switching.setup import Watcher
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.passes.assigned_states import checked_state, stepped_segment
from desire_tui.engine.passes.moments import blocks_pass, conditions_pass, sources_pass
from desire_tui.engine.passes.switching import switching as switches
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.runtime.moments.memory import Compute, Depart, Limit, Look, Settle
from desire_tui.engine.runtime.moments.setup import Stepper
from desire_tui.engine.runtime.run_faults import first_not_finite
from desire_tui.engine.runtime.run_memory import Ended, Phase, RunMemory

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.values import Values

_RUN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)
_BEGIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)


class MomentModel:
    """Implements `runtime.backend.Model`."""

    def __init__(
        self, code: CodeCache, improver: Improver, segment: Segment, rule: int, values: Values
    ) -> None:
        self._values = values
        self._vital = np.array(vital_columns(segment), dtype=np.int64)
        variable = rule_numbered(rule).kind == "variable"
        segment, self._numbers = stepped_segment(segment, values.room, variable=variable)
        tableau = TABLEAUS.get(rule) if segment.order else None
        switching = None
        if variable:
            segment, switching = switches(segment, values.room)
        self._stepper = stepper = Stepper(segment, tableau, values)
        passes = passes_of(segment, variable=variable)
        inner = {
            "derivative": passes["derivative"],
            "conditions": conditions_pass(segment, stepper.moments.now),
            "blocks": blocks_pass(segment, stepper.moments.due),
            "sources": sources_pass(segment, stepper.moments.source),
        }
        if switching is not None:
            inner["modes"] = switching.live_pass
        self._functions = functions = PassFunctions(code, values, segment.order, inner, frozenset())
        for name in set(inner) - {"modes"}:
            setattr(stepper.moments, name, ctypes.cast(functions.address(name), Compute))
        self._watcher: Watcher | None = None
        if switching is not None:
            self._watch(switching, segment)
        self._tables = PieceTables(code, passes)
        self._natives = moment_functions()
        self._begin = _BEGIN(self._natives.begin)
        self._fill_context(segment)
        loop = moment_loop(tableau)
        self._loop = code.quick([loop])[loop.name]
        self._run = _RUN(self._loop.address)
        self._improver = improver
        improver.add(self._tables)
        improver.add(functions)

    def _watch(self, switching: Switching, segment: Segment) -> None:
        """Prepare what sees to the switches between events."""
        watching, moments, functions = watch_functions(), self._stepper.moments, self._functions
        ranges = [(s.slot, s.first, s.count) for s in segment.states]
        self._watching, self._watcher = watching, Watcher(switching, self._values, ranges)
        modes, derivative = functions.address("modes"), functions.address("derivative")
        watcher = self._watcher
        watcher.connect(watching.begin, modes, derivative, watching.place_on_step, watcher.address)
        watcher.take_step_from(*self._stepper.step_start)
        moments.watch = watcher.address
        moments.limit, moments.look, moments.depart, moments.settle = (
            ctypes.cast(function, kind)
            for function, kind in (
                (watching.limit, Limit), (watching.look_at_step, Look), (watching.depart, Depart),
                (watching.settle, Settle),
            )
        )  # fmt: skip

    def _fill_context(self, segment: Segment) -> None:
        slots = [np.arange(s.slot, s.slot + s.count) for s in segment.states]
        self._slots = np.concatenate([np.zeros(0), *slots]).astype(np.int64)
        self._columns = np.array([column.slot for column in segment.columns], dtype=np.int64)
        self._temps = np.zeros(self._tables.temps)
        self.context = context = WorkMemory(values=self._values.address, states=segment.order)
        for kind in PASSES:
            setattr(context, kind, self._tables.addresses[kind])
        context.temps, context.k1 = self._temps.ctypes.data, self._stepper.k.ctypes.data
        context.state_slots = self._slots.ctypes.data
        context.columns, context.column_count = self._columns.ctypes.data, self._columns.size
        self._vital_slots = self._columns[self._vital]
        context.vital, context.vital_count = self._vital_slots.ctypes.data, self._vital.size
        context.interval, context.problem = self._natives.step, self._stepper.address

    def advance(self, memory: RunMemory) -> Ended:
        """Run on (`runtime.run_memory`)."""
        at = self.context.memory = ctypes.addressof(memory)
        memory.histories, memory.look_up = self._stepper.address, self._natives.look_up
        if not memory.begun:
            memory.begun = 1
            self._stepper.prepare(memory, memory.times, memory.taus)
            if self._watcher is not None:
                self._watcher.begin(memory)
            if self._begin(self._stepper.address) > 1:
                memory.phase = Phase.ENDED
                return self._ended(memory, Ended.ZENO)
            if self._watcher is not None:
                self._watcher.begin(memory)  # behind the blocks at the run's start
        checked = memory.checked
        memory.checked = checked_state(checked, self._numbers)
        with self._improver.running(self._tables, self._functions):
            while (ended := Ended(self._run(at, ctypes.addressof(self.context)))) is Ended.FULL:
                self._stepper.grow()
        memory.checked = checked
        return self._ended(memory, ended)

    def _ended(self, memory: RunMemory, ended: Ended) -> Ended:
        if ended is Ended.ZENO:
            memory.which = self._stepper.moments.last_fired
        if ended is Ended.CHATTERS and self._watcher is not None:
            memory.culprit = self._watcher.culprit()
        if ended is Ended.NOT_FINITE:
            memory.which = first_not_finite(self._values.data, self._slots, self._columns, self._vital)
        if ended in {Ended.NOT_FINITE, Ended.DEADLOCK, Ended.STALLED} and memory.which >= 0:
            memory.which = self._numbers[memory.which]
        return ended
