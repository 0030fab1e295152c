"""One model under a rule with an interpolant: a solver, the structure its callbacks get, their memory."""

from __future__ import annotations

import ctypes
from math import inf
from typing import TYPE_CHECKING, Protocol

import numpy as np

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.integration.bdf.solver import OwnSolver
from desire_tui.engine.integration.explicit.solver import ExplicitSolver
from desire_tui.engine.integration.problem import (
    ERROR_SHARE,
    NEWTON_ERROR_SHARE,
    NOISE_NEVER,
    NOISE_WAIT,
    SERIES_ERROR_SHARE,
    SLIDE_PARTS,
    Matrix,
    SolverProblem,
)
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import address
from desire_tui.engine.integration.sundials.solver import Callbacks, Counts, Solver
from desire_tui.engine.integration.tableaus import TABLEAUS
from desire_tui.engine.integration.taylor.memory import EPSILON
from desire_tui.engine.integration.taylor.solver import TaylorSolver

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.integration.plan import SolverPlan
    from desire_tui.engine.integration.taylor.solver import Layout

_DATA_OF = {"dense": "SUNDenseMatrix_Data", "band": "SUNBandMatrix_Data", "sparse": "SUNSparseMatrix_Data"}


class SolverCounters(Protocol):
    """What is wanted of `runtime.run_memory.RunMemory`."""

    error_max: float
    error_absolute: float
    dt_max: float
    dt_min: float
    error_min: float
    error_one: float
    t_start: float
    t_max: float
    comint: float
    derivative_calls: int
    jacobian_calls: int
    rejected: int
    order: int


@dataclass(frozen=True)
class ModelFunctions:
    """Addresses of the model's C functions (see `problem.SolverProblem`); 0 for none."""

    derivatives: int = 0
    tangent: int = 0
    jacobian: int = 0
    step: int = 0


@dataclass(frozen=True)
class Natives:
    """Addresses of CVODE's callbacks."""

    rhs: int
    weights: int
    jacobian: int
    own: bool = False
    """Use `bdf` in place of CVODE; native code calls it, and its callbacks, directly."""


class StiffSystem:
    """CVODE, `bdf`, `taylor` or `explicit` made ready for a model.

    `layout`, of rule 17, says where Taylor coefficients stand.

    `ranges` says where states live: (slot, first state, count). `directions` (TANGENT) and `array`
    (PROGRAM) are slots of n and n·n numbers. Everything the structure points at is kept alive here.
    """

    def __init__(
        self,
        rule: int,
        plan: SolverPlan,
        values: int,
        ranges: Sequence[tuple[int, int, int]],
        functions: ModelFunctions,
        natives: Natives,
        *,
        directions: int = 0,
        array: int = 0,
        layout: Layout | None = None,
    ) -> None:
        self.rule, self.plan = rule, plan
        self.n = n = sum(count for _, _, count in ranges)
        self.problem = problem = SolverProblem()
        self._ranges = np.array(ranges, dtype=np.int64).reshape(-1, 3)
        self._buffers = np.zeros((10, n))
        self.largest, self.noise, self.last, own, spare, self.between, *probe = self._buffers
        problem.noise = self.noise.ctypes.data
        problem.moved, problem.base, problem.rate, problem.level = (a.ctypes.data for a in probe)
        problem.values = values
        problem.n, problem.range_count, problem.ranges = n, len(self._ranges), self._ranges.ctypes.data
        problem.states = own.ctypes.data  # not the values: CVODE works in it while callbacks write those
        problem.last, problem.largest, problem.spare = (
            a.ctypes.data for a in (self.last, self.largest, spare)
        )
        problem.between = self.between.ctypes.data
        problem.derivatives, problem.tangent = functions.derivatives, functions.tangent
        problem.jacobian, problem.step = functions.jacobian, functions.step
        problem.directions, problem.array = values + 8 * directions, values + 8 * array
        self._connect_matrix(own=natives.own)
        linear = plan.linear
        if plan.method is not Matrix.NONE:
            linear = replace(linear, jacobian=natives.jacobian)
        self.solver: Solver | OwnSolver | TaylorSolver | ExplicitSolver
        if rule in TABLEAUS:
            place = ctypes.addressof(problem)
            self.solver = ExplicitSolver(TABLEAUS[rule], n, problem.states, place, problem.between)
        elif layout is not None:
            place = ctypes.addressof(problem)
            self.solver = TaylorSolver(n, problem.states, place, problem.between, layout)
        elif natives.own:
            self.solver = OwnSolver(n, problem.states, ctypes.addressof(problem), problem.between)
        else:
            callbacks = Callbacks(natives.rhs, natives.weights, ctypes.addressof(problem))
            self.solver = Solver(rule, n, problem.states, callbacks, linear, problem.between)
            test = self.solver.convergence
            problem.convergence, problem.convergence_in_doubt = test.trusted, test.in_doubt
            problem.doubt_from = test.doubt_from
        problem.solver, problem.vector = self.solver.memory, self.solver.vector
        problem.between_vector = self.solver.between

    def _connect_matrix(self, *, own: bool) -> None:
        problem, plan = self.problem, self.plan
        problem.method = plan.method.value
        if plan.tables is None:
            return
        plan.tables.give(problem)
        if own:  # its matrix is an array
            return
        library = libraries().cvode
        problem.data_of = address(library, _DATA_OF[plan.linear.kind])
        if plan.linear.kind == "sparse":
            problem.nonzeros = plan.linear.nonzeros
            problem.indices_of = address(library, "SUNSparseMatrix_IndexValues")
            problem.starts_of = address(library, "SUNSparseMatrix_IndexPointers")

    def begin(self, memory: SolverCounters, first_step: float, checked: int = 0) -> None:
        """Prepare a run: forget history, counts and largest values; take ERMAX, DTMAX and the first DT.

        `checked`: CHECKN, of rules 4, 7, 8.
        """
        problem = self.problem
        problem.memory = ctypes.addressof(memory)  # type: ignore[arg-type]
        share = ERROR_SHARE if self.plan.method is Matrix.NONE else NEWTON_ERROR_SHARE
        problem.tolerance = memory.error_max * share
        problem.first_step = first_step
        problem.anew = 0
        problem.settled = 1
        problem.t_end = memory.t_start + memory.t_max
        problem.started = problem.failed = problem.restarts = problem.stuck = 0
        problem.watch_steps = problem.watch_failed = 0
        problem.watch_t = float("nan")  # nothing is nearer: the first look only notes where it was
        problem.jacobian_calls = problem.derivative_calls = 0
        problem.suspect = -1
        problem.absolute = memory.error_absolute * share
        problem.noise_seen, problem.noise_wait = 0, NOISE_WAIT
        problem.turns = problem.returned = problem.noisy = 0
        problem.relief = 1.0
        if problem.input_count:  # else nothing returns, and no relay slides
            longest = [size / 2 for size in (memory.dt_max, abs(memory.comint)) if size > 0.0]
            problem.slide_size = min(abs(memory.t_max) / SLIDE_PARTS, *longest, inf)
        self._buffers[:2] = problem.floor = 0.0
        if isinstance(self.solver, ExplicitSolver):
            problem.noise_wait = NOISE_NEVER
            self.solver.begin(memory, checked)
        elif isinstance(self.solver, TaylorSolver):
            problem.noise_wait = NOISE_NEVER
            tolerance = max(memory.error_max * SERIES_ERROR_SHARE, EPSILON)
            self.solver.begin(tolerance, memory.error_absolute * SERIES_ERROR_SHARE, memory.dt_max)
        else:
            self.solver.limit(memory.dt_max)

    def interpolate(self, t: float) -> NDArray[np.float64]:
        """Return the states at a time inside the last step."""
        self.solver.interpolate(t)
        return self.between

    def report(self, memory: SolverCounters) -> None:
        """Write what CVODE did so far into the run's memory."""
        counts = self.solver.counts() if self.problem.started else Counts(0, 0, 0)
        memory.rejected = self.problem.failed + counts.failed
        memory.derivative_calls = self.problem.derivative_calls
        memory.jacobian_calls = self.problem.jacobian_calls
        memory.order = counts.order

    def suspect(self) -> int:
        """Return the number of the state that a failure is about."""
        if self.problem.suspect >= 0:
            return int(self.problem.suspect)
        return self.solver.worst_state()
