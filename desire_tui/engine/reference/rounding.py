"""States that are nothing but rounding noise, for the reference back end (`codegen.stiff.rounding`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.memory_views import reals
from desire_tui.engine.integration.problem import (
    NOISE_FAILURE,
    NOISE_NEVER,
    NOISE_PART,
    NOISE_ROOM,
    NOISE_TRIES,
    ULP,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.integration.system import StiffSystem
    from desire_tui.engine.runtime.run_memory import RunMemory

    Array = NDArray[np.float64]


def watch_noise(
    system: StiffSystem,
    derivatives: Callable[[float, Array, Array], None],
    memory: RunMemory,
    t: float,
    flag: int,
) -> int:
    """Look for noise now and then, and where the solver gave up; begin anew if that was it."""
    problem = system.problem
    if problem.noise_wait >= NOISE_NEVER:
        return flag
    failed = problem.failed + system.solver.counts().failed
    seen = memory.steps + NOISE_FAILURE * failed
    if flag >= 0 and seen - problem.noise_seen < problem.noise_wait:
        return flag
    problem.noise_seen = seen
    if not _find_noise(system, derivatives, t, memory.t_max):
        problem.noise_wait *= 2
        return flag
    if flag >= 0:
        return flag
    problem.failed = failed
    system.solver.restart(t, 0.0)
    problem.restarts += 1
    problem.fresh = 0
    return 0


def _find_noise(
    system: StiffSystem, derivatives: Callable[[float, Array, Array], None], t: float, horizon: float
) -> bool:
    """Note states that are noise and were not known as such."""
    n = system.n
    states = reals(system.problem.states, n).copy()

    def rate(y: Array) -> Array:
        out = np.zeros(n)
        derivatives(t, y, out)
        system.problem.derivative_calls += 1
        return out

    base, level = rate(states), np.zeros(n)
    if not np.isfinite(base).all():
        return False
    for k in range(NOISE_TRIES):
        ulps = (k - np.arange(n)) % NOISE_TRIES - 2.5
        near = rate(states * (1.0 + ulps * ULP))
        if not np.isfinite(near).all():  # no evaluation more: difference equations take part in each
            return False
        level = np.maximum(level, np.abs(near - base))
    most = level * horizon
    found = False
    for i in np.flatnonzero(
        (most > 0.0) & (np.abs(base) <= NOISE_PART * level) & (system.largest <= NOISE_PART * most)
    ):
        moved = states.copy()
        moved[i] += NOISE_ROOM * most[i]
        decay = abs(rate(moved)[i] - base[i]) / (NOISE_ROOM * most[i])
        sum_of_errors = level[i] / decay if decay * horizon > 1.0 else most[i]
        if np.isfinite(decay) and system.largest[i] <= NOISE_PART * sum_of_errors:
            floor = NOISE_ROOM * sum_of_errors
            found = found or bool(system.noise[i] < floor)
            system.noise[i] = max(system.noise[i], floor)
    return found
