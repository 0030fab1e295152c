"""The run loop of language.md 8.2, written down plainly.

Each turn is at a communication point (`_point`) or at a step's start inside a communication interval (`_inside`); both
end with a step of the rule. `memory` says where to go on, so a run can be left and taken up at any return.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.analysis.slices import derivative_slice, full_pass, step_slice, tail_pass
from desire_tui.engine.reference.statements import Statements
from desire_tui.engine.runtime.memory import Ended, Phase
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.tableaus import Row, Tableau
    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.reference.statements import Run
    from desire_tui.engine.runtime.memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]

TOLERANCE = 1e-9
"""Relative to DT: a step that ends this little before a communication point has reached it."""
_CHECK_EVERY = 1024


class ReferenceModel:
    """A segment under rule 0 (`tableau` None) or an explicit rule."""

    def __init__(self, segment: Segment, tableau: Tableau | None, values: Values) -> None:
        self.values = values
        self.cells, self.data = values.cells, values.data
        self.tableau = tableau
        self.order = segment.order
        self.columns = [c.slot for request in segment.requests for c in request.columns]
        self.columns += [c.slot for c in segment.stash]
        self.statements = Statements(values, segment.order)
        compile_ = self.statements.compile
        self.full = compile_(full_pass(segment))
        self.step = compile_(step_slice(segment))
        self.stage = compile_(derivative_slice(segment))
        self.tail = compile_(tail_pass(segment))
        self.ranges = _joined([(r.slot, r.first, r.count) for r in segment.states])
        self.k = [np.zeros(segment.order) for _ in range(tableau.stages if tableau else 1)]

    def advance(self, memory: RunMemory) -> Ended:
        """Run on until the rows are full, `stop` is set, the run ends or a fault shows."""
        self.statements.memory = memory
        with np.errstate(all="ignore"):
            if memory.row >= memory.row_limit:
                return Ended.RUNNING
            if memory.phase == Phase.ENDED:
                return Ended.TMAX
            if memory.phase == Phase.AFTER_POINT:
                ended = self._step(memory)
                if ended is not None:
                    return ended
            while True:
                ended = self._point(memory) if memory.phase == Phase.AT_POINT else self._inside(memory)
                if ended is not None:
                    return ended
                if self.tableau is not None:
                    ended = self._step(memory)
                    if ended is not None:
                        return ended

    # ------------------------------------------------------------------------------------------ the turns

    def _point(self, memory: RunMemory) -> Ended | None:
        if memory.stop:
            return Ended.STOPPED
        cells = self.cells
        self._pass(self.full, memory, 0)
        if self._wild(memory):
            return Ended.NOT_FINITE
        fired = self.statements.fired
        if self.tableau is None:
            over = memory.point >= memory.nn - 1
        else:
            over = cells[T] >= memory.t_start + memory.t_max - TOLERANCE * cells[DT]
        last = over or fired is not None
        if (last or memory.point % memory.every == 0) and not self._sample(memory):
            return Ended.NOT_FINITE
        memory.point += 1
        if self.tableau is None:
            cells[T] = memory.t_start + memory.point * memory.comint
        if last:
            memory.phase = Phase.ENDED
            memory.which = fired or 0
            return Ended.TMAX if fired is None else Ended.TERM
        if memory.row >= memory.row_limit:
            if self.tableau is not None:
                memory.phase = Phase.AFTER_POINT
            return Ended.RUNNING
        return None

    def _inside(self, memory: RunMemory) -> Ended | None:
        if memory.stop:
            return Ended.STOPPED
        assert self.tableau is not None
        if (self.tableau.variable or memory.steps % _CHECK_EVERY == 0) and self._wild(memory):
            return Ended.NOT_FINITE
        self._pass(self.step, memory, 0)
        fired = self.statements.fired
        if fired is None:
            return None
        for run in self.tail:
            run()
        memory.phase = Phase.ENDED
        if self._wild(memory) or not self._sample(memory):
            return Ended.NOT_FINITE
        memory.which = fired
        return Ended.TERM

    def _pass(self, statements: list[Run], memory: RunMemory, stage: int) -> None:
        self.statements.fired = None
        for run in statements:
            run()
        memory.derivative_calls += 1
        self.k[stage][:] = self.statements.derivatives

    def _sample(self, memory: RunMemory) -> bool:
        """Write a row; False if a requested variable is inf or nan."""
        cells = self.cells
        width = 1 + len(self.columns)
        row = (ctypes.c_double * width).from_address(memory.rows + memory.row * width * 8)
        row[0] = cells[T]
        for number, slot in enumerate(self.columns):
            value = cells[slot]
            if value - value != 0.0:
                memory.which = -1 - number
                memory.phase = Phase.ENDED
                return False
            row[1 + number] = value
        memory.row += 1
        return True

    def _wild(self, memory: RunMemory) -> bool:
        """Whether a state is inf or nan; `which` is the first."""
        x = self._states()
        finite = np.isfinite(x)
        if finite.all():
            return False
        memory.which = int(np.argmin(finite))
        memory.phase = Phase.ENDED
        return True

    # ------------------------------------------------------------------------------------------ the rule

    def _step(self, memory: RunMemory) -> Ended | None:
        assert self.tableau is not None
        memory.phase = Phase.IN_STEP
        if self.tableau.variable:
            return self._variable_step(memory, self.tableau)
        cells, tableau = self.cells, self.tableau
        if tableau.dt_may_change and cells[DT] != memory.dt_base:
            memory.t_base, memory.dt_base, memory.k = cells[T], cells[DT], 0
        dt, base, k = memory.dt_base, memory.t_base, memory.k
        start = self._states()
        for stage in range(1, tableau.stages):
            self._put(start + dt * self._weighted(tableau.a[stage]))
            cells[T] = base + (k + float(tableau.c[stage])) * dt
            self._pass(self.stage, memory, stage)
        self._put(start + dt * self._weighted(tableau.b))
        memory.k = k + 1
        memory.steps += 1
        cells[T] = base + (k + 1) * dt
        _note_extremes(memory, dt)
        if cells[T] >= memory.t_start + memory.point * memory.comint - TOLERANCE * dt:
            memory.phase = Phase.AT_POINT
        return None

    def _variable_step(self, memory: RunMemory, tableau: Tableau) -> Ended | None:
        """Try, judge, halve or double; a step ends on every communication point."""
        cells = self.cells
        assert tableau.test is not None
        here, start = cells[T], self._states()
        next_point = memory.t_start + memory.point * memory.comint
        left = next_point - here
        lands = cells[DT] >= left * (1.0 - TOLERANCE)
        cut = cells[DT] > left * (1.0 + TOLERANCE)
        dt = left if lands else cells[DT]
        while True:
            for stage in range(1, tableau.stages):
                self._put(start + dt * self._weighted(tableau.a[stage]))
                cells[T] = here + float(tableau.c[stage]) * dt
                self._pass(self.stage, memory, stage)
            difference, state = self._difference(tableau.test, dt, start, memory.checked)
            if not difference > memory.error_max:
                break
            dt = 0.5 * dt
            if dt < memory.dt_min:
                self._put(start)
                cells[T], cells[ERRMAX] = here, difference
                memory.which, memory.phase = state, Phase.ENDED
                return Ended.DEADLOCK
            memory.rejected += 1
            cells[DT] = dt
            lands = cut = False
        self._put(start + dt * self._weighted(tableau.b))
        memory.steps += 1
        cells[T] = next_point if lands else here + dt
        _note_extremes(memory, dt)
        if difference < memory.error_min and not cut:
            cells[DT] = min(2.0 * cells[DT], memory.dt_max)
        if lands:
            memory.phase = Phase.AT_POINT
        return None

    def _difference(self, test: Row, dt: float, start: Array, checked: int) -> tuple[float, int]:
        """Return the largest test difference, and the number of its state."""
        absolute = dt * np.abs(self._weighted(test))
        if checked:
            return float(absolute[checked - 1]), checked - 1
        relative = absolute / (np.abs(start) + 1.0)
        largest = int(np.argmax(relative))
        return float(relative[largest]), largest

    def _weighted(self, row: Row) -> Array:
        total = np.zeros(self.order)
        for weight, k in zip(row, self.k, strict=False):
            if weight:
                total = total + float(weight) * k
        return total

    def _states(self) -> Array:
        if len(self.ranges) == 1:
            slot, _, count = self.ranges[0]
            return self.data[slot : slot + count].copy()
        x = np.empty(self.order)
        for slot, first, count in self.ranges:
            x[first : first + count] = self.data[slot : slot + count]
        return x

    def _put(self, x: Array) -> None:
        for slot, first, count in self.ranges:
            self.data[slot : slot + count] = x[first : first + count]


def _note_extremes(memory: RunMemory, dt: float) -> None:
    """Keep the smallest and largest step so far; 0 means none yet."""
    if memory.dt_least == 0.0 or dt < memory.dt_least:
        memory.dt_least = dt
    memory.dt_most = max(memory.dt_most, dt)


def _joined(ranges: list[tuple[int, int, int]]) -> list[tuple[int, int, int]]:
    """Join neighbours: (slot, first state, count)."""
    joined: list[tuple[int, int, int]] = []
    for slot, first, count in ranges:
        if joined and joined[-1][0] + joined[-1][2] == slot and joined[-1][1] + joined[-1][2] == first:
            joined[-1] = (joined[-1][0], joined[-1][1], joined[-1][2] + count)
        else:
            joined.append((slot, first, count))
    return joined
