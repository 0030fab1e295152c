"""What runs in lock step need for `event` and `delay(x, tau)` besides code: a memory for each of a group."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.lanes.clock_moments import ClockMoments, NoMoments
from desire_tui.engine.codegen.lanes.lane_events import EventSlots
from desire_tui.engine.codegen.moments.moment_routines import moment_functions
from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.effects import role, writes
from desire_tui.engine.lowered.walk import simple_actions
from desire_tui.engine.passes.moments import blocks_pass, conditions_pass, sources_pass
from desire_tui.engine.passes.replication import LockStepError, changed_apart, differing
from desire_tui.engine.runtime.event_times import delay_times, event_times, moment_slots
from desire_tui.engine.runtime.moments.memory import Compute, SideBySide
from desire_tui.engine.runtime.moments.setup import SPAN, Stepper, first_tick
from desire_tui.engine.runtime.moments.steps import SPLITS_MOST
from desire_tui.engine.runtime.run_memory import RunMemory

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.codegen.lanes.clock_moments import Passes
    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.values import Values

    Floats = NDArray[np.float64]

_KNOTS_MOST = 1 << 20
"""Longer runs with delays are made alone."""
_ROUTINES = ("begin_runs", "step_runs", "record_runs", "look_up_runs")


class LaneMoments(NoMoments):
    """A group's memory: one run after the other is handed over in it."""

    def __init__(self, segment: Segment, tableau: Tableau, values: Values, width: int) -> None:
        self._segment, self._values, self._width = segment, values, width
        first = Stepper(segment, tableau, values)
        self._steppers = [first, *(Stepper(segment, tableau, values, like=first) for _ in range(width - 1))]
        m = first.moments
        self.passes = {
            "conditions": conditions_pass(segment, m.now),
            "sources": sources_pass(segment, m.source),
            "blocks": blocks_pass(segment, m.due),
        }
        self._apart = False
        self._kept: list[np.ndarray[Any, Any]] = []
        natives = moment_functions()
        for name in _ROUTINES:
            machine().add_symbol(f"moments.{name}", getattr(natives, name))
        self._random = np.zeros(1, dtype=np.int64)
        self._memory = RunMemory(
            values=values.address, random=self._array(self._random), look_up=natives.look_up
        )
        self._counters = np.zeros(max(segment.counters, 1), dtype=np.int64)
        self._memory.counters = self._memory.lags = self._array(self._counters)
        self._side = SideBySide(
            memory=ctypes.addressof(self._memory), width=width, count=m.count, n=m.n,
            delay_count=m.delay_count, source=m.source,
        )  # fmt: skip
        self.address = ctypes.addressof(self._side)

    def changed(self, passes: Passes) -> set[int]:
        """Return the states, and everything that is no definition."""
        return changed_apart(passes, self._segment)

    def slots(self, passes: Passes) -> EventSlots:
        """Return what the code has to know."""
        m = self._steppers[0].moments
        conditions = [n for n, event in enumerate(self._segment.events) if event.condition is not None]
        kept = {
            slot
            for action in simple_actions(passes["derivative"])
            if role(action) == "effect"
            for slot, _ in writes(action)
        }
        return EventSlots(conditions, m.now, m.delay_count, m.source, sorted(kept))

    def connect(
        self,
        code: CodeCache,
        improver: Improver,
        derivative: tuple[Action, ...],
        own: Sequence[int],
        varies: Container[int],
    ) -> None:
        """Compile what single runs need."""
        self._apart = any(slot in varies for slot in moment_slots(self._segment))
        passes = {"derivative": derivative, **self.passes}
        self._functions = PassFunctions(code, self._values, self._segment.order, passes, frozenset())
        improver.add(self._functions)
        side, m, width = self._side, self._steppers[0].moments, self._width
        for stepper in self._steppers:
            for name in passes:
                setattr(stepper.moments, name, ctypes.cast(self._functions.address(name), Compute))
            stepper.moments.memory = ctypes.addressof(self._memory)
        addresses = np.array([stepper.address for stepper in self._steppers], dtype=np.uint64)
        self._point("moments", addresses)
        self._point("values", self._values.data)
        side.own_count = len(own)
        self._point("own_slots", np.array([*own, 0], dtype=np.int64))
        for name, rows in (
            ("own", len(own)), ("k1", m.n), ("sources", m.delay_count), ("before", m.count), ("soon", 1),
            ("s", 1), ("past", 1), ("found", 1),
        ):  # fmt: skip
            self._point(name, np.zeros((max(rows, 1), width)))
        for name, rows in (
            ("armed", m.count),
            ("in_doubt", m.count),
            ("random", 1),
            ("wanted", 1),
            ("failed", 1),
        ):
            self._point(name, np.zeros((max(rows, 1), width), dtype=np.int64))

    def prepare(self, plan: RunPlan, starts: Floats, given: Sequence[int]) -> NDArray[np.bool_]:
        """Find the times, of each run if they differ, and make room for what is remembered."""
        runs, memory = len(starts), self._memory
        memory.t_start = memory.t_base = plan.t0
        memory.t_max, memory.comint, memory.dt_base, memory.nn = plan.t_max, plan.comint, plan.dt, plan.nn
        m = self._steppers[0].moments
        times = np.empty((4 * m.count + m.delay_count, runs))
        failed = np.zeros(runs, dtype=np.bool_)
        if self._apart:
            cells = self._values.cells
            for run, row in enumerate(starts.tolist()):
                for slot, value in zip(given, row, strict=True):
                    cells[slot] = value
                try:
                    times[:, run] = self._times(plan)
                except DesireError:
                    failed[run], times[:, run] = True, 1.0
        else:
            times[:] = np.array(self._times(plan))[:, None]
        self._times_kept = np.ascontiguousarray(
            times.reshape(-1, runs // self._width, self._width).transpose(1, 0, 2)
        )
        self._side.times = ctypes.cast(self._times_kept.ctypes.data, ctypes.POINTER(ctypes.c_double))
        knots = min(round(plan.t_max / plan.dt) + 3 * SPLITS_MOST, _KNOTS_MOST)
        for stepper in self._steppers:
            stepper.moments.goes_on = stepper.moments.has_past = 0
            stepper.moments.span = SPAN * plan.comint
            while stepper.delay_count and stepper.moments.room < knots:
                stepper.grow()
        return failed

    def _times(self, plan: RunPlan) -> list[float]:
        """Return period, start, ticks so far, next time of each event, then each delay."""
        events, delays = event_times(self._segment, self._values), delay_times(self._segment, self._values)
        found: list[float] = []
        for period, start in events:
            ticks = first_tick(period, start, plan.t0) if period else 0.0
            found += (period, start, ticks, start + ticks * period)
        return found + delays

    def _point(self, name: str, numbers: np.ndarray[Any, Any]) -> None:
        kind: Any = dict(self._side._fields_)[name]
        setattr(self._side, name, ctypes.cast(self._array(numbers), kind))

    def _array(self, numbers: np.ndarray[Any, Any]) -> int:
        self._kept.append(numbers)
        return int(numbers.ctypes.data)


def moments_of(
    segment: Segment, tableau: Tableau | None, values: Values, given: Sequence[int], width: int
) -> NoMoments:
    """Return what happens at moments in runs that differ in the `given` slots. LockStepError."""
    if not segment.events and not segment.delays:
        return NoMoments()
    if not segment.delays and all(event.condition is None for event in segment.events):
        clocks = ClockMoments(segment, values)
        if differing(passes_of(segment) | clocks.passes, segment, given).isdisjoint(moment_slots(segment)):
            return clocks
    if tableau is None:
        raise LockStepError("times of 'every' differ, and there are no states")
    return LaneMoments(segment, tableau, values, width)
