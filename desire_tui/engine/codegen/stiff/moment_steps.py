"""What `interval` asks of a model with events or delays, in plain Python; the work is `runtime.moments`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.stiff.look_back import look_for_moments
from desire_tui.engine.codegen.stiff.model_calls import gather
from desire_tui.engine.runtime.moments.inside import SAME
from desire_tui.engine.runtime.moments.steps import SPLITS_MOST
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.runtime.moments.memory import Moments
    from desire_tui.engine.runtime.run_memory import RunMemory


def begin_interval(problem: SolverProblem, memory: RunMemory) -> None:
    """Say how near two moments are to be the same."""
    m: Moments = problem.moments
    m.near = SAME * memory.comint


def nearness(problem: SolverProblem) -> float:
    """Return it."""
    m: Moments = problem.moments
    near: float = m.near
    return near


def has_room(problem: SolverProblem) -> int:
    """Whether what delays remember of a step still has room."""
    m: Moments = problem.moments
    wanted: int = m.knots + SPLITS_MOST if m.delay_count != 0 else 0
    return 1 if wanted <= m.room else 0


def enter_step(problem: SolverProblem, is_inside: int) -> None:
    """Note that a step begins (1) or has ended: inside it jumps at its end have not happened yet."""
    m: Moments = problem.moments
    m.is_inside = is_inside


def look_for_events(problem: SolverProblem, t0: float) -> float:
    """Put the solver's step, from t0, back to its first event; return where it ends then."""
    values: Reals = problem.values
    if look_for_moments(problem, t0, problem.t_step) != 0:
        gather(problem)
        problem.t_step = values[T]
        problem.anew = 1
    t: float = problem.t_step
    return t


def happen(problem: SolverProblem) -> Int32:
    """Carry out what is due where the last step has ended (`runtime.moments.inside.happen`)."""
    came: int = problem.happen(problem.moments, problem.anew)
    return came
