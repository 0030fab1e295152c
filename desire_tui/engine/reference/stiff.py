"""Multistep rules in the reference back end: CVODE with Python callbacks, one step at a time."""

from __future__ import annotations

import ctypes
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.advice import Probe, advice
from desire_tui.engine.integration.bdf.solver import OwnSolver
from desire_tui.engine.integration.callbacks import PythonCallbacks
from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import is_own, plan
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
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.sliding import end_slide, follow_slide
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.integration.switching import watch as watching
from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.integration.system import ModelFunctions, StiffSystem
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.lowered.jacobian_array import checked_array, fill_array
from desire_tui.engine.passes.assigned_states import without_assigned_states
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.point_effects import changed_inputs, steps_are_free
from desire_tui.engine.passes.slices import acts_at_steps, derivative_slice, is_pure, jacobian_pass
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.switching import switching
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.reference.model import ReferenceModel
from desire_tui.engine.reference.rounding import watch_noise
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.reference.steps import chattering
from desire_tui.engine.reference.switches import Switches
from desire_tui.engine.reference.taylor_series import ReferenceSeries
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.runtime.taylor import expanded
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.passes.series.nodes import SeriesProgram
    from desire_tui.engine.reference.switches import Watching
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]


class StiffReferenceModel(ReferenceModel):
    """A segment under a multistep rule. DesireError 460, 461: SUNDIALS cannot be used here; 229, 230: J."""

    def __init__(self, segment: Segment, rule: int, values: Values, watch: Watching = watching) -> None:
        if rule_numbered(rule).corrector == "jacobian" and segment.jacobian is not None:
            checked_array(segment, values)
        self._given = segment.jacobian and (segment.jacobian.slot, segment.order)
        vital = vital_columns(segment)
        segment, numbers = without_assigned_states(segment, values.room)
        self._series: ReferenceSeries | None = None
        program: SeriesProgram | None = None
        if rule_numbered(rule).solver == "Taylor":
            segment, found, program = expanded(segment, values.room)
            self._series = ReferenceSeries(program, values.data)
        else:
            segment, found = switching(segment, values.room)
        switches = None if found is None else Switches(found, segment, values, self._state_at, watch)
        super().__init__(segment, EULER, values, numbers, vital, switches)
        inputs = changed_inputs(segment)
        self._inputs = np.array(inputs, dtype=np.int64)
        self._inputs_kept: Array = np.full(len(inputs), np.nan)
        self._inputs_before = self._inputs_kept
        self.values, self.data, self.order = values, values.data, segment.order
        self.ranges = [(s.slot, s.first, s.count) for s in segment.states]
        self._segment = segment
        self._directions = self._array = 0
        self._advised = False
        self._others = StatementClosures(values, segment.order)  # passes between steps write here
        self._stage = self._others.compile(derivative_slice(segment))
        self._acts = acts_at_steps(segment)
        self._callbacks = PythonCallbacks(self)
        way = self._plan(rule)
        natives = replace(self._callbacks.natives, own=self._is_own(rule, way))
        self.system = self._callbacks.system = StiffSystem(
            rule, way, values.address, self.ranges, ModelFunctions(), natives, layout=self._series
        )  # fmt: skip
        self.system.problem.is_free = not inputs and steps_are_free(segment)
        if isinstance(self.system.solver, OwnSolver):
            self.system.solver.connect(*self._callbacks.own)
        elif isinstance(self.system.solver, TaylorSolver):
            assert program is not None
            self._at_start = self._others.compile(program.values_pass)
            self.system.solver.connect(self._callbacks.expand)

    def _is_own(self, rule: int, way: SolverPlan) -> bool:
        """Whether our own BDF makes the steps."""
        return is_own(rule, self.order, way)

    def _plan(self, rule: int) -> SolverPlan:
        segment = self._segment
        order, kind, given = segment.order, rule_numbered(rule).corrector, segment.jacobian
        program = tangent = False
        if kind == "jacobian" and given is not None:
            self._array, program = given.slot, True
            self._jacobian = self._others.compile(jacobian_pass(segment, order))
            rows, columns = ([getattr(e, side) for e in given.entries] for side in ("row", "column"))
            pattern = Pattern.of(order, np.array(rows, np.int32), np.array(columns, np.int32))
        elif kind in {"jacobian", "differences"}:
            pattern = Pattern.of(order, *sparsity_pattern(segment))
        else:
            pattern = Pattern.of(order, np.zeros(0, np.int32), np.zeros(0, np.int32))
        if kind == "jacobian" and not program:
            try:
                found = differentiate(segment, self.values.room)
                self._directions, tangent = found.directions, True
                self._tangent = self._others.compile(found.body)
            except NotDifferentiable:
                pass
        return plan(rule, pattern, program=program, tangent=tangent)

    # ------------------------------------------------------------------ what the callbacks ask

    def derivatives(self, t: float, y: Array, out: Array) -> None:
        """Run the derivative pass."""
        self._place(t, y)
        self._stage()
        out[:] = self._others.derivatives

    def expand(self, t: float, y: Array) -> None:
        """Compute the Taylor coefficients (rule 17)."""
        solver = self.system.solver
        assert isinstance(solver, TaylorSolver)
        assert self._series is not None
        self._place(t, y)
        self._at_start()
        self._series.give(solver.taylor.order, solver.coefficients)

    def _taylor(self) -> Taylor | None:
        """Return rule 17's solver if the modes' arguments have series."""
        solver = self.system.solver
        known = isinstance(solver, TaylorSolver) and solver.taylor.argument_count
        return solver.taylor if isinstance(solver, TaylorSolver) and known else None

    def tangent(self, t: float, y: Array, direction: Array, out: Array) -> None:
        """Run the tangent pass."""
        self._place(t, y)
        place = self.data[self._directions : self._directions + self.order]
        place[:] = direction
        self._tangent()
        place[:] = 0.0
        out[:] = self._others.derivatives

    def jacobian(self, t: float, y: Array) -> Array:
        """Run the JACOBIAN segment."""
        self._place(t, y)
        self._jacobian()
        return self.data[self._array : self._array + self.order**2]

    def _place(self, t: float, y: Array) -> None:
        self.cells[T] = t
        for slot, first, count in self.ranges:
            self.data[slot : slot + count] = y[first : first + count]

    # ------------------------------------------------------------------ the run

    def advice(self, *, again: bool = False) -> tuple[Diagnostic, ...]:
        """Return warnings about the run that is to start here, once for a model unless `again`."""
        if (self._advised and not again) or not is_pure(derivative_slice(self._segment)):
            return ()
        self._advised = True
        t, kept, k = self.cells[T], self._states(), np.zeros(self.order)

        def derivatives(x: Array) -> Array:
            self.derivatives(t, x, k)
            self._place(t, kept)
            return k

        def jacobian() -> Array:
            return self.jacobian(t, kept).reshape(self.order, self.order).copy()

        sure = self._array and is_pure(jacobian_pass(self._segment, self.order))
        return advice(self.system.rule, self._segment, Probe(kept, derivatives, jacobian if sure else None))

    def advance(self, memory: RunMemory) -> Ended:
        """Run on; see `ReferenceModel`."""
        system = self.system
        self._others.memory = memory
        if memory.phase == Phase.AT_POINT and memory.point == 0:
            system.begin(memory, self.cells[DT])
            self._inputs_kept = self._inputs_before = np.full(len(self._inputs), np.nan)
            if self._array:
                self.data[self._array : self._array + self.order**2] = 0.0
        ended = super().advance(memory)
        if self._array and self._given and ended is not Ended.RUNNING:
            fill_array(self.values, *self._given, self._array, self.numbers)
        system.report(memory)
        if ended is Ended.SOLVER:
            memory.suspect = self.numbers[system.suspect()]
        return ended

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
        return np.ctypeslib.as_array((ctypes.c_double * self.order).from_address(self.system.problem.states))
