"""The run loop: advances a model block by block, keeps the samples, pauses, says why it ended."""

from __future__ import annotations

from math import inf, nan
from time import perf_counter
from typing import TYPE_CHECKING, Protocol

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.memory_views import address_of
from desire_tui.engine.integration.rules import DUMMY
from desire_tui.engine.runtime.block_start import BlockStart
from desire_tui.engine.runtime.defaults import Defaults
from desire_tui.engine.runtime.delays import Delays
from desire_tui.engine.runtime.event_times import delay_times, event_times
from desire_tui.engine.runtime.headway import Headway
from desire_tui.engine.runtime.heartbeat import Heartbeat
from desire_tui.engine.runtime.history import RunHistory
from desire_tui.engine.runtime.run_faults import fault, watched_fault
from desire_tui.engine.runtime.run_memory import Ended, Phase, RunMemory
from desire_tui.engine.runtime.tables import check_tables
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.history import Positions
    from desire_tui.engine.runtime.pause_and_stop import Control
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.runtime.run_record import EndedWord, RunRecord
    from desire_tui.engine.values import Values

BLOCK_SECONDS = 0.02
"""How long a block of samples should take: short enough to look alive, long enough to cost nothing."""
BLOCK_FIRST = 1
"""Samples of the first block: a curve is seen at once, however slow."""
BLOCK_GROWTH = 64
"""A block may have so many times the samples of the one before it, if that was quick."""
ROWS_BYTES_MAX = 1 << 30
"""Samples one run may keep: 10 million of 12 variables."""
PICTURES_BYTES_MAX = 1 << 28
"""What SHOW may keep of one run; then every second picture goes, but for the first and the newest."""

_WORDS: dict[Ended, EndedWord] = {Ended.TMAX: "tmax", Ended.TERM: "term", Ended.STOPPED: "stopped"}


class Observer(Protocol):
    """Hears of a run's progress, on the run's thread."""

    def block(self, record: RunRecord, first_row: int) -> None:
        """Note that samples `first_row … record.count - 1` have come."""


class Simulator:
    """Makes runs one after the other over the same values; keeps what connects them."""

    def __init__(self, values: Values, control: Control) -> None:
        self.defaults = Defaults(values)
        self.history = RunHistory(values)
        self._values = values
        self._control = control
        self._heartbeat = Heartbeat(control)
        self._delays = Delays()
        self.memory: RunMemory | None = None
        """The run's memory while one goes on."""
        self.block_start: BlockStart | None = None
        """Where the run, or a late block of it, began; its failure can be looked at again from there."""
        self.direction = 1.0
        """-1 while a run goes backward: t is then what the program calls -t (`passes.backward`)."""
        self._began = 0.0
        """When the run began that goes on, later by what it was paused; 0: none does."""
        self._held_at = 0.0

    def reset(self) -> None:
        """Restore t, DT and the states to the start of the last run; rewind store, get, delay and SAMPLE."""
        self.history.reset()
        self.defaults.follow()

    def cut_delays(self) -> list[Diagnostic]:
        """Return warnings about the last run's delays that are cut to whole steps."""
        return self._delays.cut

    def pace(self, steps: int, record: RunRecord | None) -> float:
        """Return steps per second, without pauses: of the present run, or of `record`. From any thread."""
        began = self._began
        now = self._held_at or perf_counter()
        seconds = now - began if began > 0.0 else record.seconds if record is not None else 0.0
        return steps / seconds if seconds > 0.0 else 0.0

    def run(
        self, model: Model, segment: Segment, plan: RunPlan, record: RunRecord, observer: Observer
    ) -> bool:
        """Run to the end; False if the user ended it. DesireError: a fault; the record then says `failed`."""
        check_tables(segment, self._values)
        lag = np.zeros(max(segment.counters, 1), dtype=np.int64)
        for counter, records in self._delays.lags(segment, plan, self._values).items():
            lag[counter] = records
        start = plan.t0 if plan.backward else None
        times = event_times(segment, self._values, backward_from=start)
        taus = delay_times(segment, self._values, backward=plan.backward)
        record.rows = _rows(plan, record)
        self._began = perf_counter()
        positions = self.history.begin(segment)
        memory = self._set_up(segment, plan, positions, lag)
        memory.rows = address_of(record.rows)
        memory.times, memory.taus, memory.past = times, taus, positions
        self.memory = memory
        self._turn_time(plan, segment)
        self._control.attach(memory)
        self._heartbeat.begin()
        ended = Ended.STOPPED
        try:
            ended = self._advance(model, segment, plan, memory, record, observer)
        finally:
            self._heartbeat.end()
            self._control.attach(None)
            self.memory = None
            self._turn_time(plan, segment)
            self._settle(plan, memory, positions, record, sampled=ended in {Ended.TMAX, Ended.TERM})
            record.seconds = perf_counter() - self._began
            self._began = 0.0
        own = watched_fault(ended, segment, memory, self._values)
        if ended in _WORDS and own is None:
            record.ended = _WORDS[ended]
            return ended is not Ended.STOPPED
        record.ended = "failed"
        error = own or fault(ended, segment, plan, memory, self._values)
        record.message = error.diagnostics[0].message
        raise error

    def _turn_time(self, plan: RunPlan, segment: Segment) -> None:
        """At both ends of a run backward: turn t round, and what was differentiated over it."""
        if plan.backward:
            self._values.cells[T] = 0.0 - self._values.cells[T]
            self.direction = -self.direction
            matrix = _matrix(segment)
            elements = self._values.data[matrix.start : matrix.stop]
            elements[:] = 0.0 - elements

    def _set_up(
        self, segment: Segment, plan: RunPlan, positions: Positions, lag: NDArray[np.int64]
    ) -> RunMemory:
        values = self._values
        joined = positions.end == values.cells[T]
        if joined:
            positions.points -= 1  # the joint is the same communication point
        start = 0.0 - plan.t0 if plan.backward else plan.t0
        memory = RunMemory(
            values=values.address, counters=address_of(positions.counters), lags=address_of(lag),
            random=values.random_address, t_start=start, t_max=plan.t_max, comint=plan.comint,
            t_base=start, dt_base=plan.dt, dt_max=plan.dt_max, dt_min=plan.dt_min, error_max=plan.error_max,
            error_min=plan.error_min, error_absolute=plan.error_absolute, error_one=plan.error_one,
            points_before=positions.points, joined=int(joined), nn=plan.nn,
            every=plan.every, checked=plan.checked, phase=Phase.AT_POINT,
        )  # fmt: skip
        for level in segment.levels:
            above = values.cells[level] > 0.0  # at the end of the run before
            values.cells[level] = 0.0 if positions.runs == 1 else inf if above else nan
        memory.keep = (positions.counters, lag)  # ctypes holds addresses only
        for states in segment.states:
            if states.count == 1 and states.slot < len(values.defined):
                values.defined[states.slot] = 1  # states start at 0 (an array's elements always are defined)
        for slot in (T, *segment.scalars):
            values.defined[slot] = 1  # who looks while the run goes on finds them
        return memory

    def _advance(
        self,
        model: Model,
        segment: Segment,
        plan: RunPlan,
        memory: RunMemory,
        record: RunRecord,
        observer: Observer,
    ) -> Ended:
        """Blocks of about BLOCK_SECONDS until the run ends; one sample each where SHOW wants pictures."""
        block = float(BLOCK_FIRST)
        headway = Headway(plan.rule)
        while True:
            first = int(memory.row)
            if first >= len(record.rows):
                _grow(record, memory)
            limit = min(first + (1 if segment.pictures else int(block)), len(record.rows))
            memory.row_limit = limit
            if first == 0 or (self.block_start and self.block_start.is_far(memory, self._values)):
                self.block_start = BlockStart.taken(memory, memory.keep[0], self._values)
            began = perf_counter()
            self._heartbeat.block()
            ended = model.advance(memory) if self._control.clear_to_run(memory) else Ended.STOPPED
            took = perf_counter() - began
            if self.direction < 0.0:
                _turn_samples(record, first, int(memory.row), _matrix(segment))
            _note(memory, record)
            if segment.pictures and record.count > first:
                self._keep_pictures(segment, record)
            if record.count > first:
                observer.block(record, first)
            if ended in {Ended.STOPPED, Ended.RUNNING} and self._stands_still(headway, segment, memory):
                return Ended.NO_HEADWAY
            if ended is Ended.STOPPED:
                cells, direction = self._values.cells, self.direction
                cells[T], self.direction = direction * cells[T], 1.0  # commands may read t
                may_go_on = self._held()
                cells[T], self.direction = direction * cells[T], direction
                if not may_go_on:
                    return ended
            elif ended is not Ended.RUNNING:
                return ended
            done = max(int(memory.row) - first, 1) / max(limit - first, 1)  # the heartbeat ends long blocks
            block *= min(BLOCK_GROWTH, done * BLOCK_SECONDS / max(took, 1e-6))
            block = max(1.0, min(block, float(len(record.rows))))

    def _stands_still(self, headway: Headway, segment: Segment, memory: RunMemory) -> bool:
        """Whether the run gets nowhere; looked at once in half a million steps."""
        if not headway.is_due(memory.steps):
            return False
        values, t = self._values, self._values.cells[T]
        states = [values.data[s.slot : s.slot + s.count] for s in segment.states]
        left = memory.t_start + memory.t_max - t
        memory.standstill = headway.look(
            memory.steps, memory.rejected, t, left, np.concatenate(states) if states else np.zeros(0)
        )
        return memory.standstill is not None

    def _held(self) -> bool:
        """Wait while the user pauses the run, whose clock stands still; return whether it may go on."""
        self._held_at = perf_counter()
        may_go_on = self._control.wait()
        self._began += perf_counter() - self._held_at
        self._held_at = 0.0
        return may_go_on

    def _settle(
        self, plan: RunPlan, memory: RunMemory, positions: Positions, record: RunRecord, *, sampled: bool
    ) -> None:
        """Make the run's results the script's; `sampled`: it ended with a sample."""
        values = self._values
        if plan.rule != DUMMY:
            values.defined[DT] = 1
        positions.points = int(memory.points_before + memory.point)
        _note(memory, record)
        if memory.steps and not memory.dt_most:  # a constant step need not be measured
            record.dt_least = record.dt_most = plan.dt
        positions.end = values.cells[T] if sampled else nan
        self.defaults.follow()
        record.end_time = values.cells[T]
        if plan.rule == DUMMY and record.count:
            record.end_time = float(record.rows[record.count - 1, 0])
        if record.count < len(record.rows) // 2:
            record.rows = record.rows[: record.count].copy()

    def _keep_pictures(self, segment: Segment, record: RunRecord) -> None:
        """Keep each sample's picture while there is room, then each second, fourth … one; and the newest."""
        data, every = self._values.data, record.picture_every
        newest = tuple(data[p.slot : p.slot + p.count].copy() for p in segment.pictures)
        sample = record.count - 1
        if sample and (sample - 1) % every:  # the one before was kept as the newest only
            record.pictures[-1] = newest
        else:
            record.pictures.append(newest)
        if len(record.pictures) * sum(p.count for p in segment.pictures) * 8 > PICTURES_BYTES_MAX:
            kept = record.pictures[: sample // every + 1][::2]
            record.picture_every = 2 * every
            record.pictures = [*kept, newest] if sample % record.picture_every else kept


def _rows(plan: RunPlan, record: RunRecord) -> NDArray[np.float64]:
    """Room for all samples at once: pages cost memory only when they are written. DesireError 470."""
    columns = 1 + len(record.columns)
    size = plan.rows_most * columns * 8
    if size > ROWS_BYTES_MAX:
        facts = {"nn": plan.nn, "columns": columns, "gigabytes": size / 1e9, "most": ROWS_BYTES_MAX / 1e9}
        raise DesireError(Diagnostic("too-many-samples", facts=facts))
    return np.empty((plan.rows_most, columns))


def _grow(record: RunRecord, memory: RunMemory) -> None:
    """Make room where a rule took more samples than planned."""
    record.rows = np.concatenate([record.rows, np.empty_like(record.rows)])
    memory.rows = record.rows.ctypes.data


def _matrix(segment: Segment) -> range:
    """Return the slots of a JACOBIAN segment's array."""
    given = segment.jacobian
    return range(given.slot, given.slot + segment.order**2) if given is not None else range(0)


def _turn_samples(record: RunRecord, first: int, last: int, matrix: range) -> None:
    """Turn the times of new samples round: t, and t or an element of the Jacobian where they are shown."""
    shown = enumerate(record.columns, 1)
    times = [0, *(number for number, column in shown if column.slot == T or column.slot in matrix)]
    rows = record.rows[first:last]
    rows[:, times] = 0.0 - rows[:, times]


def _note(memory: RunMemory, record: RunRecord) -> None:
    record.steps = int(memory.steps)
    record.rejected = int(memory.rejected)
    record.derivative_calls = int(memory.derivative_calls)
    record.jacobian_calls = int(memory.jacobian_calls)
    record.dt_least, record.dt_most = memory.dt_least, memory.dt_most
    record.order = int(memory.order)
    record.count = int(memory.row)
    record.gap = int(memory.gap)
