"""A segment compiled for runs in lock step."""

from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.lanes.lane_frame import LaneMemory
from desire_tui.engine.codegen.lanes.lane_loop import LaneLoop, LaneParts
from desire_tui.engine.codegen.lanes.lane_moments import moments_of
from desire_tui.engine.codegen.lanes.shared_values import SharedMemory
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.lowered.effects import count_draws, expressions
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.passes.assigned_states import stepped_segment
from desire_tui.engine.passes.replication import (
    LockStepError,
    differing,
    hindrance,
    histories,
    moved_apart,
)
from desire_tui.engine.passes.scalar_elements import TooManyError, scalar_elements
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.runtime.delays import Delays

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.passes.scalar_elements import WrittenOut
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.values import Values

    Floats = NDArray[np.float64]
    Integers = NDArray[np.int64]

_RUN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)
_REGISTERS = 4
"""That a number of all runs of a group takes: as many operations as are under way at a time."""
_STATES_MOST = 200
"""Larger models leave the registers anyway."""
_OPERATIONS_MOST = 600
"""Of elements of vectors and matrices: more take half a second to compile, and win less than a half."""


class LaneRows(NamedTuple):
    """What runs gave: `table` (1 + columns, samples, runs), t first; samples of each; which to make again.

    `numbers`: what is kept of each column, (runs, columns); then there is no table.
    """

    table: Floats
    counts: Integers
    flagged: NDArray[np.bool_]
    numbers: Floats | None = None


def _written_out(segment: Segment) -> WrittenOut:
    """Return a segment as statements over numbers. LockStepError: it is large."""
    try:
        made = scalar_elements(segment, _OPERATIONS_MOST)
    except TooManyError:
        raise LockStepError("the model is large") from None
    if segment.order > _STATES_MOST or len(made.segment.body) > _STATES_MOST:
        raise LockStepError("the model is large")
    return made


class LaneModel:
    """Runs side by side, `width` in a group. Lives on one thread at a time."""

    def __init__(
        self,
        code: CodeCache,
        improver: Improver,
        segment: Segment,
        rule: int,
        values: Values,
        given: Sequence[int],
        columns: Sequence[int],
        folds: Sequence[str],
        *,
        fast: bool,
    ) -> None:
        """`given` are the slots with a start for each run, `folds` what is kept of each column.

        LockStepError: what keeps runs from it.
        """
        if segment.order and rule_numbered(rule).kind != "fixed":
            raise LockStepError("the rule varies its steps")
        vital = [segment.columns[number].slot for number in vital_columns(segment)]
        faults = frozenset(fault.number for fault in segment.faults)
        segment, _ = stepped_segment(segment, values.room, variable=False)
        segment, over_elements = _written_out(segment)
        reason = hindrance(segment, given)
        if reason is not None:
            raise LockStepError(reason)
        tableau = TABLEAUS[rule] if segment.order else None
        states = [slot for s in segment.states for slot in range(s.slot, s.slot + s.count)]
        self.width = _REGISTERS * machine().width
        self._values, self._given, self._columns = values, list(given), list(columns)
        self.folds = bool(folds)
        self._moments = moments_of(segment, tableau, values, given, self.width)
        passes = passes_of(segment) | self._moments.passes
        self.draws = any(
            count_draws(*expressions(action))
            for actions in passes.values()
            for action in walk_actions(actions)
        )
        """Whether the model takes random numbers."""
        varies = differing(passes, segment, {*given, *self._moments.changed(passes)})
        reason = moved_apart(segment, varies)
        if reason is not None:
            raise LockStepError(reason)
        self._segment, self._delays = segment, Delays()
        arrays = histories(segment.body)
        self._histories = np.array(
            [slot for first, count in arrays.items() for slot in range(first, first + count)], dtype=np.intp
        )
        parts = LaneParts(
            passes, tableau, states, columns, folds, vital, given, varies, faults, arrays, segment.counters,
            over_elements, self._moments.slots(passes),
        )  # fmt: skip
        loop = LaneLoop(parts, self.width, machine().width if fast else 1)
        self._slots = np.array(loop.cells.slots, dtype=np.intp)
        self._moments.connect(code, improver, passes["derivative"], loop.own, varies)
        self._compiled = code.fast(loop.piece(), slp=False)
        self._shared = SharedMemory(loop.shared.words)
        self._run = _RUN(self._compiled.address)
        self.memory = LaneMemory(values=values.address, side=self._moments.address)
        self._samples = np.empty(0)

    def run(self, plan: RunPlan, starts: Floats, random: NDArray[np.uint64]) -> LaneRows:
        """Make runs; `starts` (runs, given slots), `random` where each one's random numbers begin.

        Everything else begins as the values say. The samples returned are gone with the next call.
        """
        runs, width = starts.shape[0], self.width
        groups = -(-runs // width)
        lanes = np.minimum(np.arange(groups * width), runs - 1)  # the last group is filled up
        own = np.ascontiguousarray(starts[lanes].reshape(groups, width, -1).transpose(0, 2, 1))
        seeds = random[lanes].astype(np.int64)
        shape = (1, len(self._columns)) if self.folds else (plan.rows_most, 1 + len(self._columns))
        rows = self._room((*shape, groups * width))
        counts, flagged = np.zeros(groups * width, dtype=np.int64), np.zeros(groups * width, dtype=np.int64)
        memory = self.memory
        memory.starts, memory.random, memory.rows = own.ctypes.data, seeds.ctypes.data, rows.ctypes.data
        memory.counts, memory.flagged = counts.ctypes.data, flagged.ctypes.data
        held = np.repeat(self._values.data[self._histories], width)
        arrays = np.tile(held, groups) if len(held) else np.zeros(1)
        lags = np.zeros(max(self._segment.counters, 1), dtype=np.int64)
        for counter, records in self._delays.lags(self._segment, plan, self._values).items():
            lags[counter] = records
        shared = self._shared.cleared(plan.t_max / plan.dt + 1.0 if self._segment.order else plan.nn)
        memory.shared, memory.kept = shared.ctypes.data, self._shared.kept
        base = self._values.data[self._slots]
        memory.base = base.ctypes.data
        failed = self._moments.prepare(plan, starts[lanes], self._given)[:runs]
        memory.arrays, memory.lags = arrays.ctypes.data, lags.ctypes.data
        memory.groups, memory.runs, memory.stop = groups, groups * width, 0
        memory.t_start, memory.t_max, memory.comint = plan.t0, plan.t_max, plan.comint
        memory.dt, memory.every, memory.nn = plan.dt, plan.every, plan.nn
        self._run(ctypes.addressof(memory))
        used = 1 if self.folds else max(int(counts.max()), 1)
        table = rows[:used].transpose(1, 0, 2)[:, :, :runs]
        left = failed | (flagged[:runs] != 0) | (counts[:runs] == 0)
        return LaneRows(table, counts[:runs], left, table[:, 0].T if self.folds else None)

    def _room(self, shape: tuple[int, ...]) -> Floats:
        """Return memory for samples, that of the last call if it is large enough: new pages take time."""
        wanted = math.prod(shape)
        if self._samples.size < wanted:
            self._samples = np.empty(wanted)
        return self._samples[:wanted].reshape(shape)
