"""Rules with an interpolant in the reference back end: a solver with Python callbacks, step by step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.integration.advice import Probe, advice
from desire_tui.engine.integration.bdf.solver import OwnSolver
from desire_tui.engine.integration.callbacks import PythonCallbacks
from desire_tui.engine.integration.explicit.solver import ExplicitSolver
from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import is_own, plan
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.system import ModelFunctions, StiffSystem
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.lowered.jacobian_array import checked_array, fill_array
from desire_tui.engine.passes.assigned_states import checked_state, without_assigned_states
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.point_effects import changed_inputs, steps_are_free
from desire_tui.engine.passes.series.expanded import expanded
from desire_tui.engine.passes.slices import acts_at_steps, derivative_slice, is_pure, jacobian_pass
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.switching import switching
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.reference.stiff_steps import StiffSteps
from desire_tui.engine.reference.switches import Switches
from desire_tui.engine.reference.taylor_series import ReferenceSeries
from desire_tui.engine.runtime.free_step_faults import leave_step
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.passes.series.nodes import SeriesProgram
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]


class StiffReferenceModel(StiffSteps):
    """A segment under rules 9 … 17, or 4, 7, 8 with steps that go beyond points; see `codegen.stiff`.

    DesireError 460, 461: SUNDIALS cannot be used here; 229, 230: J.
    """

    def __init__(self, segment: Segment, rule: int, values: Values) -> None:
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
        switches = None if found is None else Switches(found, segment, values, self._state_at)
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
        elif isinstance(self.system.solver, ExplicitSolver):
            self.system.solver.connect(self._callbacks.own[0])
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
            system.begin(memory, self.cells[DT], checked_state(memory.checked, self.numbers))
            self._inputs_kept = self._inputs_before = np.full(len(self._inputs), np.nan)
            if self._array:
                self.data[self._array : self._array + self.order**2] = 0.0
        ended = super().advance(memory)
        if self._array and self._given and ended is not Ended.RUNNING:
            fill_array(self.values, *self._given, self._array, self.numbers)
        system.report(memory)
        if isinstance(system.solver, ExplicitSolver):
            ended = leave_step(system.solver, memory, self.values, ended)
        if ended is Ended.NOT_FINITE:
            self._not_finite(memory)
        elif ended in {Ended.DEADLOCK, Ended.STALLED}:
            memory.which = self.numbers[memory.which]
        elif ended is Ended.SOLVER:
            memory.suspect = self.numbers[system.suspect()]
        return ended
