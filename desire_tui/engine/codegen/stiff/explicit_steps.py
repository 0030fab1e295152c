"""`integration.explicit` as `interval` drives it, in plain Python; functions as in `cvode_steps`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.explicit.step import advance, put_inside, restart

if TYPE_CHECKING:
    from desire_tui.engine.integration.explicit.memory import Explicit
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.problem import SolverProblem


def begin(problem: SolverProblem, t: float, first_step: float) -> None:
    """Begin anew from the states in `problem.states`."""
    solver: Explicit = problem.solver
    restart(solver, t, first_step)


def take_step(problem: SolverProblem, t_next: float) -> int:
    """Take a step to `t_next` at most; `reached[0]` and the states are then the solution. Return the flag."""
    solver: Explicit = problem.solver
    flag = advance(solver, t_next)
    problem.reached[0] = solver.t
    return flag


def last_size(problem: SolverProblem) -> float:
    """Return the last step's size."""
    solver: Explicit = problem.solver
    size: float = solver.h_last
    return size


def failures(problem: SolverProblem) -> int:
    """Return the number of tries that failed since the solver began."""
    solver: Explicit = problem.solver
    count: int = solver.rejected
    return count


def interpolate(problem: SolverProblem, t: float) -> None:
    """Write the states inside the last step to `between`."""
    solver: Explicit = problem.solver
    between: Reals = problem.between
    put_inside(solver, t, between)
