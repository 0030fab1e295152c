"""Segments with events or delays under rules 9 … 17: `runtime.moments` as it is, asked between the steps."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.integration.sundials.library import is_there
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.reference.moments import connect
from desire_tui.engine.reference.stiff import StiffReferenceModel
from desire_tui.engine.runtime.moments.along import look_along_series
from desire_tui.engine.runtime.moments.blocks import begin, cut_short
from desire_tui.engine.runtime.moments.inside import PLACES, SAME, happen, limit_step, remember_step
from desire_tui.engine.runtime.moments.locate import look_inside
from desire_tui.engine.runtime.moments.memory import Place
from desire_tui.engine.runtime.moments.setup import Stepper
from desire_tui.engine.runtime.moments.steps import SPLITS_MOST
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values


class StiffMomentModel(StiffReferenceModel):
    """A segment with events or delays under a rule 9 … 17; native code does the same in `stiff.interval`."""

    def __init__(self, segment: Segment, rule: int, values: Values) -> None:
        super().__init__(segment, rule, values)
        self._stepper = stepper = Stepper(self._segment, EULER, values)
        self._moments = moments = stepper.moments
        moments.places, moments.place = PLACES, Place(self._place_inside)
        moments.owner = ctypes.addressof(self.system.problem)
        self.statements.histories.append(moments)
        connect(stepper, self._segment, self._others, self._stage)
        if self.switches is not None:
            self.switches.remember(moments)
        if self._series is not None:
            stepper.follow_series(self._series.conditions)
        if segment.delays:
            self.system.problem.is_free = 0

    def _is_own(self, rule: int, way: SolverPlan) -> bool:
        """Only where there is no CVODE: as Python our BDF makes the same steps in three times the time."""
        return not is_there() and super()._is_own(rule, way)

    def _place_inside(self, _owner: int, t: float) -> int:
        self._state_at(t)
        return 0

    def advance(self, memory: RunMemory) -> Ended:
        """Run on; see `ReferenceModel`."""
        if not memory.begun:
            memory.begun = 1
            self._others.memory = memory
            self._stepper.prepare(memory, memory.times, memory.taus)
            if self.switches is not None:
                self.switches.begin(memory)  # conditions may read what switches
            if begin(self._moments) > 1:
                return self._too_fast(memory)
        return super().advance(memory)

    def _step(self, memory: RunMemory) -> Ended | None:
        self._moments.near = SAME * memory.comint
        return super()._step(memory)

    @property
    def _is_watched(self) -> bool:
        return True

    def _limited(self, t: float, stop: float, t_next: float) -> tuple[float, float]:
        m = self._moments
        if m.delay_count and m.knots + SPLITS_MOST > m.room:
            self._stepper.grow()
        stop, near = super()._limited(t, limit_step(m, t, stop, t_next), t_next)
        return stop, max(near, m.near)

    def _solver_step(self, stop: float) -> tuple[int, float]:
        self._moments.is_inside = 1
        result = super()._solver_step(stop)
        self._moments.is_inside = 0
        return result

    def _look_back(self, t0: float) -> None:
        problem = self.system.problem
        solver = self.system.solver
        if isinstance(solver, TaylorSolver):
            found = look_along_series(solver.taylor, self._moments, t0, problem.t_step)
        else:
            found = look_inside(self._moments, t0, problem.t_step)
        if found:
            self._end_step_here()
        t1 = problem.t_step
        super()._look_back(t0)
        if problem.t_step < t1:
            cut_short(self._moments)
        remember_step(self._moments, t0, problem.t_step)
        problem.settled = 0
        self._leave(problem.t_step, self._solution())

    def _settle(self, memory: RunMemory, t_next: float) -> Ended | None:
        ended = super()._settle(memory, t_next)
        if ended is not None:
            return ended
        problem = self.system.problem
        came = happen(self._moments, problem.anew)
        if came > 1:
            return self._too_fast(memory)
        if came:
            passed = problem.passed
            self._synchronise()
            problem.passed = passed
            problem.anew = 1
            if self.switches is not None:
                return self._take_up(self.switches.depart(), memory)
        return None

    def _take_up(self, bits: int, memory: RunMemory) -> Ended | None:
        if self.cells[T] > self.system.problem.t:
            self.system.problem.settled = 0  # an event may come behind a switch of t
        return super()._take_up(bits, memory)

    def _too_fast(self, memory: RunMemory) -> Ended:
        memory.which, memory.phase = self._moments.last_fired, Phase.ENDED
        return Ended.ZENO
