"""Segments with events or delays under rules 9 … 16: steps located by the solver's interpolant."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.bdf.memory import Bdf
from desire_tui.engine.integration.bdf.solver import OwnSolver
from desire_tui.engine.integration.halving import RESOLUTION
from desire_tui.engine.integration.problem import STUCK_AT_EDGE_FLAG, STUCK_FLAG, STUCK_MOST
from desire_tui.engine.integration.sundials.library import is_there, libraries
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.integration.switching import watch as watching
from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.reference.moments import connect
from desire_tui.engine.reference.steps import chattering
from desire_tui.engine.reference.stiff import StiffReferenceModel
from desire_tui.engine.runtime.moments.blocks import any_doubt, any_falls, any_rises, arrive, begin, next_time
from desire_tui.engine.runtime.moments.histories import record
from desire_tui.engine.runtime.moments.locate import PROBES
from desire_tui.engine.runtime.moments.setup import Stepper
from desire_tui.engine.runtime.moments.steps import SPLITS_MOST, note_extremes
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.integration.sundials.solver import Solver
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.reference.switches import Watching
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]

_PLACES = 4
"""A step is looked at in so many places, its end included; histories have as many knots in it."""
_PLACES_OF_SERIES = 64
"""The same for events under rule 17, whose steps are many times as long."""
_SAME = 1e-10
"""Part of COMINT by which two moments are the same."""


class StiffMomentModel(StiffReferenceModel):
    """A segment with events or delays under a multistep rule."""

    def __init__(self, segment: Segment, rule: int, values: Values, watch: Watching = watching) -> None:
        super().__init__(segment, rule, values, watch)
        self._stepper = stepper = Stepper(self._segment, EULER, values)
        self.statements.histories.append(stepper.moments)
        connect(stepper, self._segment, self._others, self._stage)
        if self.switches is not None:
            self.switches.remember(stepper.moments)

    def _is_own(self, rule: int, way: SolverPlan) -> bool:
        """Only where there is no CVODE: as Python our BDF makes the same steps in three times the time."""
        return not is_there() and super()._is_own(rule, way)

    def advance(self, memory: RunMemory) -> Ended:
        """Run on; see `ReferenceModel`."""
        if not memory.begun:
            memory.begun = 1
            self._others.memory = memory
            self._stepper.prepare(memory, memory.times, memory.taus)
            if begin(self._stepper.moments) > 1:
                return self._too_fast(memory)
        return super().advance(memory)

    def _step(self, memory: RunMemory) -> Ended | None:
        """Go to the next communication point, or to where a block or code at steps' starts has run."""
        memory.phase = Phase.IN_STEP
        m, cells = self._stepper.moments, self.cells
        t_next = memory.t_start + memory.point * memory.comint
        m.near = slack = _SAME * memory.comint
        ended = self._take_up_switches(memory)
        if ended is not None:
            return ended
        while True:
            if m.delay_count and m.knots == 1:
                self._remember(cells[T], self._states())
            t0 = cells[T]
            ended = self._solver_step(memory, t_next, slack)
            if ended is not None:
                return ended
            located = self._locate(t0)
            if self.switches is not None and cells[T] - t0 > slack:
                if self.switches.look_back(t0, cells[T], self._taylor()) > 0:
                    located = True
                    if m.condition_count:
                        any_rises(m)
                else:
                    self._place(cells[T], self._between(cells[T]))
            self._remember_step(t0)
            came = arrive(m, slack)
            if came > 1:
                return self._too_fast(memory)
            if came or located:
                self.system.last[0] = np.nan  # whatever has changed, the solver begins anew
                if m.delay_count:
                    self._remember(cells[T], self._states())
            ended = self._take_up_switches(memory)
            if ended is not None:
                return ended
            if cells[T] >= t_next - slack:
                memory.phase = Phase.AT_POINT
                return None
            if self._acts or memory.stop:
                return None

    def _take_up_switches(self, memory: RunMemory) -> Ended | None:
        """Put the modes of the present states into force; the solver begins anew where one is another."""
        if self.switches is None:
            return None
        m, problem, t = self._stepper.moments, self.system.problem, self.cells[T]
        bits = self.switches.depart()
        if bits:
            self.system.last[0] = np.nan
        elif problem.t == t:
            problem.t = problem.t_step = self.cells[T]
        if bits >= CHATTERS:
            return chattering(self.switches, memory)
        if self.cells[T] > t and m.condition_count and any_rises(m):  # an event by t alone
            if arrive(m, m.near) > 1:
                return self._too_fast(memory)
            self.system.last[0] = np.nan
        return None

    def _solver_step(self, memory: RunMemory, t_next: float, slack: float) -> Ended | None:
        """Take a step, to the next moment of a clock at most."""
        system, cells, m = self.system, self.cells, self._stepper.moments
        problem, solver = system.problem, system.solver
        self._follow()
        stop, soon, t0 = t_next, next_time(m), cells[T]
        if soon < t_next - slack:
            stop = max(soon, t0)
        if m.tau_least > 0.0:
            stop = min(stop, t0 + m.tau_least)
        if self.switches is not None:
            stop = self.switches.limit(t0, stop)
        if stop - t0 <= slack:
            cells[T] = problem.t = problem.t_step = stop
            problem.anew = 1
            return None
        problem.suspect = problem.suspect if problem.stuck else -1
        m.is_inside = 1
        flag, t = solver.step(stop)
        m.is_inside = 0
        if self._callbacks.failure is not None:
            failure, self._callbacks.failure = self._callbacks.failure, None
            raise failure
        t = stop if flag == TSTOP_RETURN or t >= stop else t
        problem.stuck = problem.stuck + 1 if t == problem.t else 0
        if problem.stuck > STUCK_MOST:
            flag = STUCK_AT_EDGE_FLAG if problem.suspect >= 0 else STUCK_FLAG
        y = self._solution()
        self._place(t, y)
        system.last[:] = y
        problem.t = t
        if flag < 0:
            memory.which, memory.phase = flag, Phase.ENDED
            return Ended.SOLVER
        cells[DT] = solver.last_step
        note_extremes(memory, cells[DT])
        memory.steps += 1
        return None

    def _follow(self) -> None:
        """Begin anew if t, a state or an input is not what the solver left."""
        self._synchronise()
        if self.system.problem.anew:
            self._begin_anew(self.cells[T])

    def _locate(self, t0: float) -> bool:
        """Put t and the states to behind the first event of the step, if there is one in it."""
        m, t1 = self._stepper.moments, self.cells[T]
        if not m.condition_count or t1 <= t0:
            return False
        if t1 - t0 <= m.near:  # not the solver's step: it cannot tell what is inside
            return any_rises(m) != 0
        if any(m.in_doubt[i] for i in range(m.count)):
            self._decide(t0, t1)
        left, right = t0, t1
        places = _PLACES_OF_SERIES if isinstance(self.system.solver, TaylorSolver) else _PLACES
        for k in range(1, places + 1):
            right = t1 if k == places else t0 + (t1 - t0) * k / places
            self._place(right, self._between(right))
            if any_rises(m):
                break
            left = right
        else:
            return False
        least = RESOLUTION * max(abs(t0), abs(t1))
        while right - left > least and left < (middle := left + 0.5 * (right - left)) < right:
            self._place(middle, self._between(middle))
            if any_rises(m):
                right = middle
            else:
                left = middle
        self._place(right, self._between(right))
        any_rises(m)
        return True

    def _decide(self, t0: float, t1: float) -> None:
        """Look whether a condition has fallen from 0 and risen again in the step (`locate.rises_in_step`)."""
        m = self._stepper.moments
        self._place(t1, self._between(t1))
        any_rises(m)
        if not any_doubt(m):
            return
        for k in range(1, PROBES):
            t = t0 + (t1 - t0) * 0.5**k
            self._place(t, self._between(t))
            if any_falls(m):
                return

    def _between(self, t: float) -> Array:
        """Return the states at a time in the last step."""
        if t == self.system.problem.t:
            return np.array(self.system.last)
        solver = self.system.solver
        if isinstance(solver, TaylorSolver):
            return np.array(self.system.interpolate(t))
        return interpolated(solver, t, self.order)

    def _remember_step(self, t0: float) -> None:
        m, t1 = self._stepper.moments, self.cells[T]
        if not m.delay_count or t1 <= t0:
            return
        if m.knots + SPLITS_MOST > m.room:
            self._stepper.grow()
        for k in range(1, _PLACES + 1):
            t = t1 if k == _PLACES else t0 + (t1 - t0) * k / _PLACES
            self._remember(t, self._between(t))

    def _remember(self, t: float, y: Array) -> None:
        """Record a knot of the histories, with the states' derivatives there."""
        m = self._stepper.moments
        self._place(t, y)
        m.derivative(m.memory, m.k_at[0])
        record(m)

    def _too_fast(self, memory: RunMemory) -> Ended:
        memory.which, memory.phase = self._stepper.moments.last_fired, Phase.ENDED
        return Ended.ZENO


def interpolated(solver: Solver | OwnSolver, t: float, n: int) -> Array:
    """Return the solution at a time inside the last step."""
    out = np.zeros(n)
    if isinstance(solver, OwnSolver):
        bdf = Bdf.from_address(solver.memory)
        z = np.ctypeslib.as_array(bdf.z, ((bdf.order + 1) * n,)).reshape(bdf.order + 1, n)
        part = (t - bdf.t) / bdf.h
        for row in z[::-1]:
            out = out * part + row
        return out
    cvode = libraries().cvode
    context = ctypes.cast(solver.vector, ctypes.POINTER(ctypes.c_void_p))[2]  # {content, ops, sunctx}
    vector = cvode.N_VMake_Serial(n, out.ctypes.data, context)
    flag = cvode.CVodeGetDky(solver.memory, t, 0, vector)
    cvode.N_VDestroy_Serial(vector)
    assert flag == 0, flag
    return out
