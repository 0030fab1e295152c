"""The steps of a rule 9 … 17 in the reference back end, as `codegen.stiff.interval` makes them."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.memory_views import reals
from desire_tui.engine.integration.problem import (
    CHATTER_FLAG,
    CHATTER_PART,
    CHATTER_STEPS,
    SLIDE_STEPS,
    STUCK_AT_EDGE_FLAG,
    STUCK_FLAG,
    STUCK_MOST,
    TOO_NEAR,
)
from desire_tui.engine.integration.sliding import end_slide, follow_slide
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.rounding import watch_noise
from desire_tui.engine.reference.steps import chattering
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.integration.callbacks import PythonCallbacks
    from desire_tui.engine.integration.system import StiffSystem
    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.runtime.run_memory import RunMemory

    Array = NDArray[np.float64]


class StiffSteps(ReferenceModel):
    """What makes the steps; `StiffReferenceModel` makes the solver and what that asks of the segment."""

    system: StiffSystem
    data: Array
    ranges: Sequence[tuple[int, int, int]]
    order: int
    _callbacks: PythonCallbacks
    _inputs: NDArray[np.int64]
    _inputs_kept: Array
    _inputs_before: Array
    _acts: bool

    @abstractmethod
    def derivatives(self, t: float, y: Array, out: Array) -> None:
        """Run the derivative pass."""

    def _taylor(self) -> Taylor | None:
        """Return rule 17's solver if the modes' arguments have series."""
        solver = self.system.solver
        known = isinstance(solver, TaylorSolver) and solver.taylor.argument_count
        return solver.taylor if isinstance(solver, TaylorSolver) and known else None

    def _place(self, t: float, y: Array) -> None:
        self.cells[T] = t
        for slot, first, count in self.ranges:
            self.data[slot : slot + count] = y[first : first + count]

    def _chatters(self, memory: RunMemory, t: float) -> bool:
        """Whether steps fail about as often as they succeed and get nowhere; looked at now and then."""
        problem = self.system.problem
        problem.watch_steps += 1
        if problem.watch_steps < CHATTER_STEPS:
            return False
        failed = problem.failed + self.system.solver.counts().failed
        near = t - problem.watch_t < CHATTER_PART * memory.comint
        often = failed - problem.watch_failed >= CHATTER_STEPS // 2
        problem.watch_steps, problem.watch_t, problem.watch_failed = 0, t, failed
        return bool(near and often)

    def _depart(self, memory: RunMemory) -> Ended | None:
        """Go to the next communication point; what may switch is seen to by `_step`."""
        return self._step(memory)

    def _step(self, memory: RunMemory) -> Ended | None:
        """Go to the next communication point, as `codegen.stiff.interval` does."""
        memory.phase = Phase.IN_STEP
        problem = self.system.problem
        t_next = memory.t_start + memory.point * memory.comint
        self._synchronise()
        ended: Ended | None = None
        if self.switches is not None and problem.settled and problem.t == problem.t_step:
            ended = self._take_up(self.switches.depart(), memory)
        while ended is None:
            if problem.t_step > t_next:
                self._leave(t_next, self.system.interpolate(t_next))
                memory.phase = Phase.AT_POINT
                return None
            if problem.t != problem.t_step:
                self._leave(problem.t_step, self._solution())
            while not problem.settled and ended is None:
                ended = self._settle(memory, t_next)
            if ended is not None:
                break
            if problem.t_step >= t_next:
                memory.phase = Phase.AT_POINT
                return None
            if self._acts and problem.passed != problem.t_step:
                problem.passed = problem.t_step
                ended = self._inside(memory)
                if ended is not None:
                    break
                memory.phase = Phase.IN_STEP
                self._synchronise()
                if self.switches is not None and problem.anew:
                    ended = self._take_up(self.switches.depart(), memory)
                    if ended is not None:
                        break
            flag = self._advance(memory, t_next)
            if flag < 0:
                memory.which, memory.phase = flag, Phase.ENDED
                return Ended.SOLVER
            if memory.stop and problem.t_step < t_next:
                return Ended.STOPPED
        return ended

    def _advance(self, memory: RunMemory, t_next: float) -> int:
        """Take a step, to `t_next` at most unless steps are free; return the flag."""
        problem, solver, cells = self.system.problem, self.system.solver, self.cells
        t_from = problem.t_step
        stop = max(t_next, problem.t_end) if problem.is_free else t_next
        stop, near = self._limited(t_from, stop, t_next)
        if stop - t_from <= near:
            problem.t_step = stop
            self._leave(stop, self._solution())
            problem.anew, problem.settled = 1, int(not self._is_watched)
            return 0
        if problem.anew:
            self._begin_anew(t_from)
        problem.suspect = problem.suspect if problem.stuck else -1
        flag, t = self._solver_step(stop)
        problem.fresh += 1
        if problem.turns and problem.fresh > SLIDE_STEPS:
            end_slide(problem)
        if self._callbacks.failure is not None:
            failure, self._callbacks.failure = self._callbacks.failure, None
            raise failure
        t = stop if flag == TSTOP_RETURN or t >= stop else t
        flag = watch_noise(self.system, self.derivatives, memory, t, flag)
        problem.stuck = problem.stuck + 1 if t == problem.t_step else 0
        if problem.stuck > STUCK_MOST:
            flag = STUCK_AT_EDGE_FLAG if problem.suspect >= 0 else STUCK_FLAG
        if self._chatters(memory, t) and flag >= 0:
            flag = CHATTER_FLAG
        problem.t_step = t
        self._leave(t, self._solution())
        if flag < 0:
            return int(flag)
        cells[DT] = solver.last_step
        memory.dt_least = cells[DT] if memory.steps == 0 else min(memory.dt_least, cells[DT])
        memory.dt_most = max(memory.dt_most, cells[DT])
        memory.steps += 1
        self._look_back(t_from)
        return 0

    @property
    def _is_watched(self) -> bool:
        """Whether something may happen where a step ends."""
        return self.switches is not None

    def _limited(self, t: float, stop: float, t_next: float) -> tuple[float, float]:  # noqa: ARG002 - moments do
        """Return how far a step from t may go, and how near to t that is no step."""
        if self.switches is not None:
            stop = self.switches.limit(t, stop)
        return stop, TOO_NEAR * abs(stop)

    def _solver_step(self, stop: float) -> tuple[int, float]:
        """Take a step; return its flag and where it has ended."""
        return self.system.solver.step(stop)

    def _look_back(self, t0: float) -> None:
        """Look whether something has switched in the last step, which began at t0; it ends there then."""
        problem = self.system.problem
        if self.switches is None:
            return
        found = self.switches.look_back(t0, problem.t_step, self._taylor())
        if found > 0:
            self._end_step_here()
        if found >= 0:
            problem.settled = 0
            self._leave(problem.t_step, self._solution())

    def _end_step_here(self) -> None:
        """Let the last step end at the t and states in the values."""
        problem = self.system.problem
        self._solution()[:] = self._states()
        problem.t_step, problem.anew = self.cells[T], 1

    def _settle(self, memory: RunMemory, t_next: float) -> Ended | None:
        """Take up what has switched where the last step has ended."""
        self.system.problem.settled = 1
        return None if self.switches is None else self._take_up(self.switches.settle(t_next), memory)

    def _take_up(self, bits: int, memory: RunMemory) -> Ended | None:
        """Go on from the t and states in the values, behind a switching."""
        problem, t = self.system.problem, self.cells[T]
        if not bits and t == problem.t:
            return None
        self._solution()[:] = self._states()
        problem.t_step = t
        self._leave(t, self._solution())
        problem.anew = problem.anew or int(bits != 0)
        if bits >= CHATTERS:
            assert self.switches is not None
            return chattering(self.switches, memory)
        return None

    def _leave(self, t: float, y: Array) -> None:
        """Put t and states into the values, and remember them."""
        self._place(t, y)
        self.system.problem.t = t
        self.system.last[:] = y

    def _state_at(self, t: float) -> None:
        """Put t and the states that the last step has there into the values."""
        self._place(t, self.system.interpolate(t))

    def _synchronise(self) -> None:
        """Begin anew, at the next step, if t, a state or an input is not what it was left as."""
        problem, x, t = self.system.problem, self._states(), self.cells[T]
        inputs = self.data[self._inputs]
        changed = inputs != self._inputs_kept
        if changed.any():
            problem.returned = int(np.array_equal(inputs[changed], self._inputs_before[changed]))
            self._inputs_before = np.where(changed, self._inputs_kept, self._inputs_before)
            self._inputs_kept = inputs
        problem.passed = t
        same = np.array_equal(x, self.system.last)
        if problem.started and t == problem.t and same and not changed.any():
            return
        self._solution()[:] = x
        self.system.last[:] = x
        problem.anew = problem.settled = 1
        problem.t = problem.t_step = t

    def _begin_anew(self, t: float) -> None:
        """Let the solver forget its history."""
        problem = self.system.problem
        if problem.started:
            problem.failed += self.system.solver.counts().failed
            problem.restarts += 1
            follow_slide(problem, self.system.solver.last_step)
        size = problem.first_step
        if problem.started:
            size = 2.0 * self.system.solver.last_step if problem.fresh == 1 else 0.0
        self.system.solver.restart(t, size)
        problem.started, problem.anew, problem.fresh = 1, 0, 0

    def _states(self) -> Array:
        x = np.empty(self.order)
        for slot, first, count in self.ranges:
            x[first : first + count] = self.data[slot : slot + count]
        return x

    def _solution(self) -> Array:
        return reals(self.system.problem.states, self.order)
