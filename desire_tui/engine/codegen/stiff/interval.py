"""One communication interval under a rule 9 … 16, step by step, in plain Python.

`interval` starts from t and the states in the values, where the pass at the first step's start has been done,
and comes back with `Ended.RUNNING` once t is `t_next`; with STOPPED where `stop` was set; TERM with the
statement's number in `which`; SOLVER with CVODE's flag in `which`.

The steps are those of `cvode_steps` or `own_steps`, whichever this text is compiled with. Solvers keep a
history of the solution and begin anew where the states in the values are not what they left there: at a run's
start, where difference-equation code changed one, where the user did.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.cvode_steps import begin, failures, last_size, take_step
from desire_tui.engine.codegen.stiff.model_calls import gather, scatter
from desire_tui.engine.codegen.stiff.rounding import watch_noise
from desire_tui.engine.integration.problem import (
    CHATTER_FLAG,
    CHATTER_PART,
    CHATTER_STEPS,
    STUCK_AT_EDGE_FLAG,
    STUCK_FLAG,
    STUCK_MOST,
)
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.runtime.run_memory import RunMemory


def interval(problem: SolverProblem, memory: RunMemory, t_next: float) -> Int32:
    """Make the steps of an interval."""
    values: Reals = problem.values
    states: Reals = problem.states
    last: Reals = problem.last
    synchronise(problem)
    while True:
        if problem.stuck == 0:
            problem.suspect = -1
        flag = take_step(problem, t_next)
        problem.fresh += 1
        t: float = problem.reached[0]
        done = flag == TSTOP_RETURN or t >= t_next
        if done:
            t = t_next
        flag = watch_noise(problem, memory, t, flag)
        flag = watch_progress(problem, t, flag)
        flag = watch_chatter(problem, memory, t, flag)
        values[T] = t
        problem.t = t
        scatter(problem, states)
        copy(last, 0, states, 0, problem.n)
        if flag < 0:
            memory.which = flag
            return Ended.SOLVER
        size = last_size(problem)
        values[DT] = size
        record_step(memory, size)
        if done:
            return Ended.RUNNING
        if memory.stop != 0:
            return Ended.STOPPED
        if problem.step != 0:  # pass(-, STEP) at a step's start
            fired: int = problem.step(memory, states)
            if fired != 0:
                memory.which = fired - 1
                return Ended.TERM
            synchronise(problem)


def synchronise(problem: SolverProblem) -> None:
    """Begin anew if t or a state is not what the solver left."""
    gather(problem)
    values: Reals = problem.values
    states: Reals = problem.states
    last: Reals = problem.last
    t = values[T]
    going = problem.started != 0
    differ = 0
    for i in range(problem.n):
        differ += states[i] != last[i]
    if going and t == problem.t and differ == 0:
        return
    problem.failed += failures(problem)  # the solver starts to count at 0
    if going:
        again = problem.fresh == 1  # a state is changed at each step: the step before is the best guess
        begin(problem, t, 2.0 * last_size(problem) if again else 0.0)
        problem.restarts += 1
    else:
        begin(problem, t, problem.first_step)
    problem.fresh = 0
    problem.started = 1
    problem.t = t


def watch_progress(problem: SolverProblem, t: float, flag: int) -> int:
    """Count steps that do not change t; too many of them make a failure of a success."""
    if t == problem.t:
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
