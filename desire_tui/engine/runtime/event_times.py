"""Times that hold for a run, found at its start: those of each `every`, and delays that do not vary."""

from __future__ import annotations

from math import floor, isfinite
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.effects import writes
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.runtime.before_run import evaluate, needed
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values


_NEAR = 1e-12
"""A moment so near behind a run's start, in periods, is at it."""


def event_times(
    segment: Segment, values: Values, *, backward_from: float | None = None
) -> list[tuple[float, float]]:
    """Return period and start of each event, 0 and 0 for a condition. DesireError 487.

    `backward_from`: where a run against time starts. Its clocks are those of -t, and start at their latest
    moment before that time or at it.
    """
    if not segment.events:
        return []
    sets = [action for action in segment.body if isinstance(action, Set)]
    found: list[tuple[float, float]] = []
    for event in segment.events:
        if event.period is None or event.start is None:
            found.append((0.0, 0.0))
            continue
        period, start = (evaluate(time, needed(time, sets), values) for time in (event.period, event.start))
        if not (isfinite(period) and period > 0.0 and isfinite(start)):
            facts: dict[str, object] = {"period": f"{period:g}", "start": f"{start:g}"}
            raise DesireError(at_statement("every-not-positive", facts, segment, event.where))
        if backward_from is not None:
            start = 0.0 - (start + period * floor((backward_from - start) / period + _NEAR))
        found.append((period, start))
    return found


def moment_slots(segment: Segment) -> set[int]:
    """Return the slots of all numbers that the times of clocks and delays are computed from."""
    sets = [action for action in segment.body if isinstance(action, Set)]
    times = [time for event in segment.events for time in (event.period, event.start) if time is not None]
    times += [delayed.tau for delayed in segment.delays]
    values = [value for time in times for value in (time, *(made.value for made in needed(time, sets)))]
    return {node.slot for node in walk_values(*values) if isinstance(node, Load)}


def delay_times(segment: Segment, values: Values, *, backward: bool = False) -> list[float]:
    """Return the time of each `delay(x, tau)`, 0 for one that may vary. DesireError: it is negative.

    `backward`: of a segment over -t, whose tau are the program's turned round: a constant above 0 there looks
    ahead, at what the run has passed. DesireError 483: another looks at what is still to come, or may.
    """
    if not segment.delays:
        return []
    sets = [action for action in segment.body if isinstance(action, Set)]
    states = {s.slot + i for s in segment.states for i in range(s.count)}
    bodies = [segment.body, *(event.body for event in segment.events)]
    found: list[float] = []
    for delayed in segment.delays:
        before = needed(delayed.tau, sets)
        read = {
            node.slot
            for node in walk_values(delayed.tau, *(action.value for action in before))
            if isinstance(node, Load)
        }
        computed = {id(action) for action in before}
        varied = {T, *states}
        for body in bodies:
            for action in walk_actions(body):
                if id(action) not in computed:
                    varied.update(slot + i for slot, count in writes(action) for i in range(count))
        varies = bool(read & varied)
        tau = 0.0 if varies else evaluate(delayed.tau, before, values)
        if backward and (varies or tau < 0.0):
            raise DesireError(at_statement("delay-backward", {}, segment, delayed.where))
        if not (isfinite(tau) and tau >= 0.0):
            raise DesireError(at_statement("delay-negative", {"tau": tau}, segment, delayed.where))
        found.append(tau)
    return found
