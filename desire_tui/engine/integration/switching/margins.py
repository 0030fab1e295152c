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
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.switching.memory import Watch

_TIMES = 3.0


def are_far(w: Watch, h: float) -> int:
    """Whether no argument has come near; `modes` has been computed at the end of a step of h.

    A mode that is another one at the step's end has a threshold no farther off than its argument has moved.
    """
    values: Reals = w.values
    at_start: Reals = w.at_start
    changes: Reals = w.changes
    count: int = w.count
    arguments: int = w.arguments
    times = _TIMES * (h / w.h_before)
    w.h_before = h
    near = 0
    if w.thresholds_are_0 != 0:  # nearly always: without branches, as fast as it may be
        for i in range(count):
            argument: float = values[arguments + i]
            change = abs(argument - at_start[i])
            room = _TIMES * change + times * changes[i]
            at_start[i] = argument
            changes[i] = change
            near += not abs(argument) >= room
        return near == 0
    for i in range(count):
        argument = values[arguments + i]
        change = abs(argument - at_start[i])
        room = _TIMES * change + times * changes[i]
        at_start[i] = argument
        changes[i] = change
        near += not distance(w.thresholds[i], argument) >= room
    return near == 0


def begin_margins(w: Watch) -> None:
    """Start from the arguments in the values, of which it is not known how they move."""
    w.h_before = 1.0
    w.strayed = 0
    for i in range(w.count):
        w.at_start[i] = w.values[w.arguments + i]
        w.changes[i] = inf


def distance(threshold: int, x: float) -> float:
    """Return how far a jump's argument is from the next threshold."""
    if threshold == Threshold.ZERO:
        return abs(x)
    if threshold == Threshold.UNIT:
        return abs(abs(x) - 1.0)
    if threshold == Threshold.HALF:
        return abs(x - floor(x) - 0.5)
    if threshold == Threshold.EVERY_WHOLE:
        return min(x - floor(x), floor(x) + 1.0 - x)
    below = floor(abs(x))
    above = below + 1.0 - abs(x)
    return above if below == 0.0 else min(above, abs(x) - below)
