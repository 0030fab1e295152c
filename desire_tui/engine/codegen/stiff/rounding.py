"""States that are nothing but rounding noise, in plain Python: they may not stop a solver.

The difference of large equal terms jumps by their rounding errors at each step, however small; no step
would be small enough to follow that to ERMAX of itself. Where steps fail again and again, derivatives are
compared with those of states an ulp or two away: what they differ by is their rounding level, the size of
their terms times 2e-16. A state whose derivative is no larger than that, and which is no larger itself
than such errors add up to before they die away, is noise; its errors count from there on only. A
population that falls to 1e-200 is none: its terms fall with it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.cvode_steps import begin, failures
from desire_tui.engine.codegen.stiff.model_calls import evaluate
from desire_tui.engine.integration.problem import (
    NOISE_FAILURE,
    NOISE_NEVER,
    NOISE_PART,
    NOISE_ROOM,
    NOISE_TRIES,
    ULP,
)

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.runtime.run_memory import RunMemory


def watch_noise(problem: SolverProblem, memory: RunMemory, t: float, flag: int) -> int:
    """Look for noise now and then, and where the solver gave up; begin anew if that was it."""
    if problem.noise_wait >= NOISE_NEVER:
        return flag
    failed = failures(problem) + problem.failed
    seen = memory.steps + NOISE_FAILURE * failed
    if flag >= 0 and seen - problem.noise_seen < problem.noise_wait:
        return flag
    return search_noise(problem, memory, t, flag, failed)


def search_noise(problem: SolverProblem, memory: RunMemory, t: float, flag: int, failed: int) -> int:
    """Look for noise now."""
    problem.noise_seen = memory.steps + NOISE_FAILURE * failed
    horizon: float = memory.t_max
    found = find_noise(problem, t, horizon)
    if found == 0:
        problem.noise_wait *= 2
        return flag
    if flag >= 0:
        return flag
    problem.failed = failed
    begin(problem, t, 0.0)
    problem.restarts += 1
    problem.fresh = 0
    return 0


def find_noise(problem: SolverProblem, t: float, horizon: float) -> int:
    """Return how many states are noise that were not known as such."""
    n = problem.n
    states: Reals = problem.states
    moved: Reals = problem.moved
    base: Reals = problem.base
    rate: Reals = problem.rate
    level: Reals = problem.level
    if evaluate(problem, t, states, base) != 0:
        return 0
    for i in range(n):
        level[i] = 0.0
    for k in range(NOISE_TRIES):
        turn = k
        for i in range(n):
            moved[i] = states[i] * (1.0 + (turn - 2.5) * ULP)
            turn -= 1
            if turn < 0:
                turn += NOISE_TRIES
        if evaluate(problem, t, moved, rate) != 0:
            return 0
        for i in range(n):
            level[i] = max(level[i], abs(rate[i] - base[i]))
    copy(moved, 0, states, 0, n)
    found = 0
    for i in range(n):
        found += is_noise(problem, t, horizon, i)
    return found


def is_noise(problem: SolverProblem, t: float, horizon: float, i: int) -> int:
    """Note whether a state is noise; `moved` holds the states, and does so again."""
    states: Reals = problem.states
    moved: Reals = problem.moved
    base: Reals = problem.base
    rate: Reals = problem.rate
    level: Reals = problem.level
    largest: Reals = problem.largest
    noise: Reals = problem.noise
    most = level[i] * horizon
    if most == 0.0 or abs(base[i]) > NOISE_PART * level[i] or largest[i] > NOISE_PART * most:
        return 0
    moved[i] = states[i] + NOISE_ROOM * most
    flag = evaluate(problem, t, moved, rate)
    moved[i] = states[i]
    if flag != 0:
        return 0
    decay = abs(rate[i] - base[i]) / (NOISE_ROOM * most)
    if decay * horizon > 1.0:
        most = level[i] / decay
    if largest[i] > NOISE_PART * most or noise[i] >= NOISE_ROOM * most:
        return 0
    noise[i] = NOISE_ROOM * most
    problem.noisy = 1
    return 1
