"""CVODE as `interval` drives it, in plain Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.problem import (
    DOUBT_FAILURE,
    DOUBT_MOST,
    JACOBIAN_SERVES_STEPS,
    Matrix,
)
from desire_tui.engine.integration.sundials.signatures import ONE_STEP

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import cvode  # noqa: TC004 - is compiled, never run
    from desire_tui.engine.integration.problem import SolverProblem


def begin(problem: SolverProblem, t: float, first_step: float) -> None:
    """Begin anew from the states in `problem.states`; a first step of 0: the solver looks for one."""
    cvode.CVodeReInit(problem.solver, t, problem.vector)
    cvode.CVodeSetInitStep(problem.solver, first_step)
    problem.diverged = 0
    if problem.doubt > problem.doubt_from:
        trust(problem, 1)
    problem.doubt = 0


def take_step(problem: SolverProblem, t_next: float) -> int:
    """Take a step to `t_next` at most; `reached[0]` and the states are then the solution. Return the flag."""
    cvode.CVodeSetStopTime(problem.solver, t_next)
    flag: int = cvode.CVode(problem.solver, t_next, problem.vector, problem.reached, ONE_STEP)
    doubt(problem)
    return flag


def doubt(problem: SolverProblem) -> None:
    """Hold the corrector to more while it is in doubt (`integration.problem`)."""
    cvode.CVodeGetNumStepSolveFails(problem.solver, problem.count)
    diverged: int = problem.count[0]
    before: int = problem.doubt
    least: int = problem.doubt_from
    doubt = min(before + DOUBT_FAILURE * (diverged - problem.diverged), DOUBT_MOST)
    problem.diverged = diverged
    if doubt > least and before <= least:
        trust(problem, 0)
    problem.doubt = max(doubt - 1, 0)
    if doubt > least and problem.doubt <= least:
        trust(problem, 1)


def trust(problem: SolverProblem, is_trusted: int) -> None:
    """Let a Jacobian serve long and the corrector converge to its usual share of the error test, or not."""
    share: float = problem.convergence if is_trusted != 0 else problem.convergence_in_doubt
    cvode.CVodeSetNonlinConvCoef(problem.solver, share)
    if problem.method != Matrix.NONE:
        cvode.CVodeSetJacEvalFrequency(problem.solver, JACOBIAN_SERVES_STEPS if is_trusted != 0 else 1)


def last_size(problem: SolverProblem) -> float:
    """Return the last step's size."""
    cvode.CVodeGetLastStep(problem.solver, problem.size)
    size: float = problem.size[0]
    return size


def failures(problem: SolverProblem) -> int:
    """Return the number of tries that failed, whole steps each, since the solver began."""
    problem.count[0] = 0
    cvode.CVodeGetNumErrTestFails(problem.solver, problem.count)
    tests: int = problem.count[0]
    problem.count[0] = 0
    cvode.CVodeGetNumStepSolveFails(problem.solver, problem.count)
    corrections: int = problem.count[0]
    return tests + corrections


def interpolate(problem: SolverProblem, t: float) -> None:
    """Write the states inside the last step to `between`."""
    cvode.CVodeGetDky(problem.solver, t, 0, problem.between_vector)
