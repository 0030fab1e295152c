"""Whether a mode may have switched inside a step, by how far its argument is from where it would.

For solvers with an interpolant of their own, in plain Python: one look at a step's end in place of several
inside. An argument that is several times as far from its threshold as it has moved in this step, and would
have moved at the rate of the step before, has not been there: solvers resolve what states do.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.mathematics import floor
from desire_tui.engine.lowered.switching import Threshold

if TYPE_CHECKING:
    from desire_tui.engine.integration.switching.memory import Watch

_TIMES = 3.0


def are_far(w: Watch, h: float) -> int:
    """Whether no argument has come near; `modes` has been computed at the end of a step of h."""
    far = 1
    for i in range(w.count):
        argument: float = w.values[w.arguments + i]
        live: float = w.values[w.live + i]
        frozen: float = w.values[w.frozen + i]
        change = abs(argument - w.at_start[i])
        moved = change + h * w.slopes[i]
        w.at_start[i] = argument
        w.slopes[i] = change / h
        if live != frozen or not distance(w.thresholds[i], argument) >= _TIMES * moved:
            far = 0
    return far


def begin_margins(w: Watch) -> None:
    """Start from the arguments in the values, of which it is not known how they move."""
    for i in range(w.count):
        w.at_start[i] = w.values[w.arguments + i]
        w.slopes[i] = inf


def distance(threshold: int, x: float) -> float:
    """Return how far a jump's argument is from the next threshold."""
    if threshold == Threshold.ZERO:
        return abs(x)
    if threshold == Threshold.UNIT:
        return abs(abs(x) - 1.0)
    if threshold == Threshold.HALF:
        return abs(x - floor(x) - 0.5)
    below = floor(abs(x))
    above = below + 1.0 - abs(x)
    return above if below == 0.0 else min(above, abs(x) - below)
