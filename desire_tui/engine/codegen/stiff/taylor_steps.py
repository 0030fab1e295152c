"""`integration.taylor` as `interval` drives it, in plain Python; the functions are those of `cvode_steps`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.stiff.model_calls import scatter
from desire_tui.engine.integration.taylor.roots import look_along
from desire_tui.engine.integration.taylor.step import advance, put_inside, restart
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.integration.switching.memory import Watch
    from desire_tui.engine.integration.taylor.memory import Taylor


def begin(problem: SolverProblem, t: float, first_step: float) -> None:  # noqa: ARG001 - others do
    """Begin anew from the states in `problem.states`; it needs no first step."""
    solver: Taylor = problem.solver
    restart(solver, t)


def take_step(problem: SolverProblem, t_next: float) -> int:
    """Take a step to `t_next` at most; `reached[0]` and the states are then the solution. Return the flag."""
    solver: Taylor = problem.solver
    flag = advance(solver, t_next)
    if flag < 0:
        problem.suspect = solver.worst
    problem.reached[0] = solver.t
    return flag


def last_size(problem: SolverProblem) -> float:
    """Return the last step's size."""
    solver: Taylor = problem.solver
    size: float = solver.h_last
    return size


def failures(problem: SolverProblem) -> int:  # noqa: ARG001 - others do
    """Return the number of tries that failed: no step is tried twice."""
    return 0


def interpolate(problem: SolverProblem, t: float) -> None:
    """Write the states inside the last step to `between`."""
    solver: Taylor = problem.solver
    between: Reals = problem.between
    put_inside(solver, t, between)


def expand(problem: SolverProblem, t: float, y: Reals) -> Int32:
    """Compute the coefficients at t from the states y (`integration.taylor.memory.Expand`)."""
    solver: Taylor = problem.solver
    values: Reals = problem.values
    coefficients: Reals = solver.coefficients
    values[T] = t
    scatter(problem, y)
    problem.derivative_calls += 1
    solver.at_start(problem.memory, problem.spare)
    solver.recurrences(values, coefficients, solver.order)
    return 0


def look(problem: SolverProblem, t0: float, t1: float) -> Int32:
    """Find the first switching in the last step, by the arguments' series where they have one."""
    solver: Taylor = problem.solver
    watch: Watch = problem.watch
    if solver.argument_count == 0:
        found: int = problem.look(problem.watch, t0, t1)
        return found
    return look_along(solver, watch, t0, t1)


def look_for_moments(problem: SolverProblem, t0: float, t1: float) -> int:
    """Find the first event in the last step, by the conditions' series where they have one."""
    found: int = problem.look_along_series(problem.solver, problem.moments, t0, t1)
    return found
