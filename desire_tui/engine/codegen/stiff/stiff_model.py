"""A segment as native code under a rule with an interpolant: compiled passes and steps, no Python between."""

from __future__ import annotations

import ctypes
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.ir.work_memory import PASSES, WorkMemory
from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
from desire_tui.engine.codegen.pieces.piece_tables import PieceTables
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.codegen.stiff.dense_factors import factorise_address
from desire_tui.engine.codegen.stiff.stiff_loop import stiff_loop
from desire_tui.engine.codegen.stiff.stiff_moments import StiffMoments
from desire_tui.engine.codegen.switching.watch_routines import watch_functions
from desire_tui.engine.codegen.taylor.series_code import SeriesCode, share_steps
from desire_tui.engine.integration.advice import Probe, advice
from desire_tui.engine.integration.explicit.solver import ExplicitSolver
from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import is_own, plan
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.switching.setup import Watcher
from desire_tui.engine.integration.system import ModelFunctions, Natives, StiffSystem
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.lowered.jacobian_array import checked_array, fill_array
from desire_tui.engine.lowered.state_ranges import state_ranges
from desire_tui.engine.passes.assigned_states import checked_state, without_assigned_states
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.point_effects import changed_inputs, steps_are_free
from desire_tui.engine.passes.series.expanded import expanded
from desire_tui.engine.passes.slices import acts_at_steps, is_pure, jacobian_pass, without_derivatives
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.switching import switching as switches
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.passes.vital_columns import vital_columns
from desire_tui.engine.runtime.free_step_faults import leave_step
from desire_tui.engine.runtime.run_faults import first_not_finite
from desire_tui.engine.runtime.run_memory import Ended, Phase, RunMemory
from desire_tui.engine.values import DT

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.codegen.stiff.solver_routines import SolverRoutines, StiffFunctions
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.values import Values

_ENDED = tuple(Ended)
"""By their numbers: to look one up takes a twentieth of the time that `Ended(…)` does."""
_RUN = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)


STEPS_WORTH_OWN_CODE = 100_000
"""Steps of our solver, some 50 ms, behind which a second of LLVM's work for just this number of states may
pay, a tenth of each step; a process that ends before keeps nothing of it."""


class StiffModel:
    """Implements `runtime.backend.Model`: rules 9 … 17, and 4, 7, 8 where their steps go beyond points.

    DesireError 460, 461: SUNDIALS cannot be used here; 229, 230: J.
    """

    def __init__(
        self,
        code: CodeCache,
        improver: Improver,
        routines: SolverRoutines,
        segment: Segment,
        rule: int,
        values: Values,
    ) -> None:
        self.rule, self._values = rule, values
        if rule_numbered(rule).reads_jacobian and segment.jacobian is not None:
            checked_array(segment, values)
        self._given = segment.jacobian and (segment.jacobian.slot, segment.order)
        self._vital = np.array(vital_columns(segment), dtype=np.int64)
        segment, self._numbers = without_assigned_states(segment, values.room)
        self._series: SeriesCode | None = None
        extra: dict[str, tuple[Action, ...]] = {}
        if rule_numbered(rule).solver == "Taylor":
            segment, switching, program = expanded(segment, values.room)
            self._series = SeriesCode(code, program)
            extra = {"at_start": self._series.values_pass}
        else:
            segment, switching = switches(segment, values.room)
        self._segment = segment
        self._passes = passes = passes_of(segment)
        passes |= {kind: without_derivatives(passes[kind]) for kind in ("full", "step")}
        self._advised = False
        found, directions, array = _jacobian_passes(segment, rule, values)
        extra |= found
        self._extra = extra
        self._array = array
        inner = {"derivative": passes["derivative"]} | extra
        if acts_at_steps(segment):
            inner["step"] = passes["step"]
        self._moments: StiffMoments | None = None
        if segment.events or segment.delays:
            self._moments = StiffMoments(segment, values)
            inner |= self._moments.passes
            if self._series is not None:
                self._moments.follow_series(self._series.layout.conditions)
        own = frozenset({"step", "jacobian"})
        if switching is not None:
            inner["modes"] = switching.live_pass
        self._functions = functions = PassFunctions(code, values, segment.order, inner, own)
        if self._moments is not None:
            self._moments.take(functions)
        others = () if self._moments is None else self._moments.passes
        addresses = {name: functions.address(name) for name in inner if name not in others}
        addresses["derivatives"] = addresses.pop("derivative")
        self._ranges = state_ranges(segment.states)
        self._watcher: Watcher | None = None
        if switching is not None:
            self._watcher = Watcher(switching, values, self._ranges)
            self._watcher.keep_box()
            self._modes = addresses.pop("modes")
            self._derivatives = addresses["derivatives"]
        self._at_start = addresses.pop("at_start", 0)
        self._inputs = np.array(changed_inputs(segment), dtype=np.int64)
        self._inputs_kept, self._inputs_before = np.full((2, max(self._inputs.size, 1)), np.nan)
        self._is_free = not self._inputs.size and not segment.delays and steps_are_free(segment)
        happens = switching is not None or self._moments is not None or "step" in inner
        self._is_smooth = not (happens or self._inputs.size)
        way = _plan(segment, rule, extra)
        self._own = is_own(rule, segment.order, way)
        if way.linear.kind == "dense" and not self._own:
            way = replace(way, linear=replace(way.linear, factorise=factorise_address(segment.order)))
        self._system = partial(
            StiffSystem,
            rule,
            way,
            values.address,
            self._ranges,
            ModelFunctions(**addresses),
            directions=directions,
            array=array,
            layout=self._series.layout if self._series is not None else None,
        )
        self._tables = PieceTables(code, passes)
        self._fill_context(segment)
        self._routines = routines
        self._better: StiffFunctions | None = None
        self._use(self._first_routines())
        loop = stiff_loop()  # does little between two intervals: quick code is good enough
        self._loop = code.quick([loop])[loop.name]
        self._run = _RUN(self._loop.address)
        self._runs = self._steps = 0
        self._is_to_improve, self._improver = True, improver
        self._parts = [work for work in (self._series, self._tables, functions) if work is not None]
        for part in self._parts:
            improver.add(part)

    def _first_routines(self) -> StiffFunctions:
        match rule_numbered(self.rule).solver:
            case "Taylor":
                return self._routines.series()
            case "tableau":
                return self._routines.variable()
        return self._routines.first(self._slots.size, own=self._own, smooth=self._is_smooth)

    def _use(self, natives: StiffFunctions) -> None:
        """Connect the solver's callbacks and the interval loop."""
        self._natives = natives  # owns the code
        self.system = self._system(Natives(natives.rhs, natives.weights, natives.jacobian, self._own))
        problem = self.system.problem
        problem.is_free = self._is_free
        if self._series is not None and isinstance(self.system.solver, TaylorSolver):
            self.system.solver.taylor.at_start = self._at_start
            self._series.give(self.system.solver.taylor)
            share_steps(self.system.solver.taylor, natives.keep)
        problem.inputs, problem.input_count = self._inputs.ctypes.data, self._inputs.size
        problem.inputs_kept = self._inputs_kept.ctypes.data
        problem.inputs_before = self._inputs_before.ctypes.data
        if self._watcher is not None:
            watching = watch_functions()
            problem.watch = self._watcher.address
            problem.limit, problem.look = watching.limit, watching.look_back
            problem.settle, problem.depart = watching.settle, watching.depart
            if self._moments is not None:
                self._moments.watch(self._watcher, watching.settle)
            self._watcher.connect(
                watching.begin, self._modes, self._derivatives, natives.state_at, ctypes.addressof(problem)
            )
        if self._moments is not None:
            self._moments.connect(problem, natives.state_at)
        self.context.interval = natives.interval
        self.context.problem = ctypes.addressof(self.system.problem)

    def _fill_context(self, segment: Segment) -> None:
        order = segment.order
        self._slots = np.concatenate([np.arange(s.slot, s.slot + s.count) for s in segment.states]).astype(
            np.int64
        )
        self._columns = np.array([column.slot for column in segment.columns], dtype=np.int64)
        self._temps, self._k1 = np.zeros(self._tables.temps), np.zeros(order)
        self.context = context = WorkMemory(values=self._values.address, states=order)
        for kind in PASSES:
            setattr(context, kind, self._tables.addresses[kind])
        context.temps, context.k1 = self._temps.ctypes.data, self._k1.ctypes.data
        context.x0 = self._k1.ctypes.data  # saved by the loop, never used: k1 is not either
        context.state_slots = self._slots.ctypes.data
        context.columns, context.column_count = self._columns.ctypes.data, self._columns.size
        self._vital_slots = self._columns[self._vital]
        context.vital, context.vital_count = self._vital_slots.ctypes.data, self._vital.size

    def improve(self) -> Iterator[None]:
        """Compile a fast solver (`background.Improvable`)."""
        if rule_numbered(self.rule).kind == "multistep":
            smooth = self._is_smooth
            self._better = self._routines.fast(self._slots.size, own=self._own, smooth=smooth)
        yield

    def advice(self, *, again: bool = False) -> tuple[Diagnostic, ...]:
        """Return warnings about the run that is to start here, once for a model unless `again`."""
        if (self._advised and not again) or not is_pure(self._passes["derivative"]):
            return ()
        self._advised = True
        values, slots, order = self._values.data, self._slots, self._slots.size
        memory, kept, k = (
            RunMemory(values=self._values.address),
            self._values.data[self._slots].copy(),
            np.zeros(order),
        )

        if self._moments is not None:
            self._moments.remember(memory)

        def derivatives(x: NDArray[np.float64]) -> NDArray[np.float64]:
            values[slots] = x
            self._functions.call("derivative", memory, k.ctypes.data)
            values[slots] = kept
            return k

        def jacobian() -> NDArray[np.float64]:
            self._clear_array()
            self._functions.call("jacobian", memory)
            return values[self._array : self._array + order * order].reshape(order, order).copy()

        sure = self._array and is_pure(self._extra["jacobian"])  # what it draws or remembers must stay
        return advice(self.rule, self._segment, Probe(kept, derivatives, jacobian if sure else None))

    def _pays_to_improve(self) -> bool:
        """Whether a run that begins follows others: one alone would only wait for fast code at its end."""
        return self._runs > 1 and (not self._own or self._steps > STEPS_WORTH_OWN_CODE)

    def advance(self, memory: RunMemory) -> Ended:
        """Run on (`runtime.run_memory`)."""
        moments = self._moments
        if moments is not None:
            moments.remember(memory)
            if not memory.begun and (ended := moments.begin(memory, self._watcher)) is not None:
                return ended
        if memory.phase == Phase.AT_POINT and memory.point == 0:
            self._runs += 1
            if self._is_to_improve and self._pays_to_improve():
                self._is_to_improve = False
                self._improver.add(self)
            better, self._better = self._better, None
            if better is not None:
                self._use(better)
            self.system.begin(memory, self._values.cells[DT], checked_state(memory.checked, self._numbers))
            self._clear_array()
            if self._inputs.size:
                self._inputs_kept[:] = self._inputs_before[:] = np.nan
            if self._watcher is not None:
                self._watcher.begin(memory)
        system = self.system
        system.problem.memory = self.context.memory = ctypes.addressof(memory)
        steps_before = memory.steps
        with self._improver.running(self, *self._parts):
            while (
                ended := _ENDED[self._run(ctypes.addressof(memory), ctypes.addressof(self.context))]
            ) is Ended.FULL:
                assert moments is not None
                moments.grow()
        self._steps += memory.steps - steps_before
        if self._array and self._given and ended is not Ended.RUNNING:
            fill_array(self._values, *self._given, self._array, self._numbers)
        system.report(memory)
        if isinstance(system.solver, ExplicitSolver):
            ended = leave_step(system.solver, memory, self._values, ended)
        if ended is Ended.ZENO and moments is not None:
            moments.too_fast(memory)
        elif ended is Ended.SOLVER:
            memory.suspect = self._numbers[system.suspect()]
        elif ended is Ended.CHATTERS and self._watcher is not None:
            memory.culprit = self._watcher.culprit()
        elif ended is Ended.NOT_FINITE:
            which = first_not_finite(self._values.data, self._slots, self._columns, self._vital)
            memory.which = which if which < 0 else self._numbers[which]
        elif ended in {Ended.DEADLOCK, Ended.STALLED}:
            memory.which = self._numbers[memory.which]
        return ended

    def _clear_array(self) -> None:
        """Elements of J that JACOBIAN does not assign are 0, whatever the script left there."""
        if self._array:
            self._values.data[self._array : self._array + self.system.n**2] = 0.0


def _jacobian_passes(
    segment: Segment, rule: int, values: Values
) -> tuple[dict[str, tuple[Action, ...]], int, int]:
    """Return the pass that a rule with a Jacobian needs, and the slots of the directions and of the array."""
    if not rule_numbered(rule).reads_jacobian:
        return {}, 0, 0
    if segment.jacobian is not None:
        return {"jacobian": jacobian_pass(segment, segment.order)}, 0, segment.jacobian.slot
    try:
        tangent = differentiate(segment, values.room)
    except NotDifferentiable:
        return {}, 0, 0
    return {"tangent": tangent.body}, tangent.directions, 0


def _plan(segment: Segment, rule: int, extra: Mapping[str, object]) -> SolverPlan:
    order = segment.order
    if rule_numbered(rule).corrector in (None, "fixed-point", "diagonal"):
        pattern = Pattern.of(order, np.zeros(0, np.int32), np.zeros(0, np.int32))
    elif "jacobian" in extra:
        assert segment.jacobian is not None
        rows, columns = ([getattr(e, side) for e in segment.jacobian.entries] for side in ("row", "column"))
        pattern = Pattern.of(order, np.array(rows, np.int32), np.array(columns, np.int32))
    else:
        pattern = Pattern.of(order, *sparsity_pattern(segment))
    return plan(rule, pattern, program="jacobian" in extra, tangent="tangent" in extra)
