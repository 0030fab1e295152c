"""Whether steps get anywhere, in plain Python; what is counted of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.stiff.cvode_steps import failures
from desire_tui.engine.integration.problem import (
    CHATTER_FLAG,
    CHATTER_PART,
    CHATTER_STEPS,
    STUCK_AT_EDGE_FLAG,
    STUCK_FLAG,
    STUCK_MOST,
)

if TYPE_CHECKING:
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.runtime.run_memory import RunMemory


def watch_progress(problem: SolverProblem, t: float, flag: int) -> int:
    """Count steps that do not change t; too many of them make a failure of a success."""
    if t == problem.t_step:
        problem.stuck += 1
    else:
        problem.stuck = 0
    if problem.stuck > STUCK_MOST:
        return STUCK_AT_EDGE_FLAG if problem.suspect >= 0 else STUCK_FLAG
    return flag


def watch_chatter(problem: SolverProblem, memory: RunMemory, t: float, flag: int) -> int:
    """Make a failure of steps that fail about as often as they succeed and get nowhere."""
    problem.watch_steps += 1
    if problem.watch_steps < CHATTER_STEPS:
        return flag
    failed = failures(problem) + problem.failed
    often = failed - problem.watch_failed
    near = t - problem.watch_t < memory.comint * CHATTER_PART
    problem.watch_t = t
    problem.watch_failed = failed
    problem.watch_steps = 0
    if near and 2 * often >= CHATTER_STEPS and flag >= 0:
        return CHATTER_FLAG
    return flag


def record_step(memory: RunMemory, size: float) -> None:
    """Count a step, and note the least and the largest."""
    first = memory.steps == 0
    memory.steps += 1
    if first or size < memory.dt_least:
        memory.dt_least = size
    if first or size > memory.dt_most:
        memory.dt_most = size
