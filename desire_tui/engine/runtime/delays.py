"""How many records back a delay line reads: found at the start of each run (language.md 9.2)."""

from __future__ import annotations

import math
import weakref
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DUMMY, RULES
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    EffectAction,
    Guard,
    Set,
    SetDot,
    SetMat,
    SetVec,
)
from desire_tui.engine.lowered.walk import simple_actions
from desire_tui.engine.runtime.before_run import evaluate, needed
from desire_tui.engine.runtime.plan import ROUNDING
from desire_tui.engine.values import DT
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.values import Values


_LEAST_CUT = 1e-6
"""Part of a record by which a time must be too long for a warning."""


@dataclass(frozen=True, slots=True)
class TimedDelay:
    """A delay line, and the statements before it that its time depends on, in their order."""

    action: DelayLine
    before: tuple[Set, ...]


class Delays:
    """The delay lines of segments, looked for once; forgotten with their segment."""

    def __init__(self) -> None:
        self.cut: list[Diagnostic] = []
        """Warnings about the last run's delays."""
        self._found: dict[int, tuple[weakref.ref[Segment], tuple[TimedDelay, ...], bool]] = {}

    def lags(self, segment: Segment, plan: RunPlan, values: Values) -> dict[int, int]:
        """Return each delay line's lag by its counter. DesireError 105: buffer too short; 122: DT varies."""
        self.cut = []
        if not segment.counters:  # of which each line has one: the statements need not be looked through
            return {}
        known = self._found.get(id(segment))
        if known is None or known[0]() is not segment:
            changes_dt = any(isinstance(a, Set) and a.slot == DT for a in simple_actions(segment.body))
            number, found = id(segment), self._found
            gone = weakref.ref(segment, lambda _: found.pop(number, None))
            known = found[number] = (gone, tuple(_lines(segment.body, [])), changes_dt)
        _, lines, changes_dt = known
        return _lags(segment, lines, changes_dt, plan, values, self.cut) if lines else {}


def _lines(body: tuple[Action, ...], before: list[Set]) -> Iterator[TimedDelay]:
    """Find delay lines; `before` are the numbers set up to here whatever the conditions are."""
    for action in body:
        match action:
            case Set():
                before.append(action)
            case DelayLine():
                yield TimedDelay(action, needed(action.tau, before))
            case Guard(kind="step" | "out"):
                yield from _lines(action.body, before)
            case Guard():
                yield from _lines(action.body, before.copy())
                yield from _lines(action.orelse, before.copy())
            case SetVec() | SetMat() | SetDot() | Deriv() | DerivVec():
                pass
            case _:
                if not isinstance(action, EffectAction):
                    assert_never(action)


def _lags(
    segment: Segment,
    lines: tuple[TimedDelay, ...],
    changes_dt: bool,
    plan: RunPlan,
    values: Values,
    cut: list[Diagnostic],
) -> dict[int, int]:
    found: dict[int, int] = {}
    for known in lines:
        line = known.action
        if line.per_step and (changes_dt or RULES[plan.rule].controls_error):
            raise _error("delay-variable-step", segment, line, rule=plan.rule)
        per_step = line.per_step and plan.rule != DUMMY
        tau = evaluate(line.tau, known.before, values)
        if not (math.isfinite(tau) and tau >= 0.0):
            raise _error("delay-negative", segment, line, tau=tau)
        interval = plan.dt if per_step else plan.comint
        records = tau / interval + ROUNDING
        lag = whole(records, 0, line.count)
        if lag is None:
            name, needed = segment.names.get(line.buffer_slot, "buffer"), f"{records // 1:.15g}"
            raise _error(
                "delay-too-long", segment, line, tau=tau, needed=needed, buffer=name, count=line.count
            )
        if records - lag > _LEAST_CUT:
            facts: dict[str, object] = {
                "tau": tau, "kept": lag * interval, "word": "tdelay" if line.per_step else "delay",
                "interval": interval, "what": "steps" if per_step else "communication intervals",
            }  # fmt: skip
            problem = at_statement("delay-cut", facts, segment, line.where)
            cut.append(replace(problem, severity="warning"))
        found[line.counter] = lag
    return found


def _error(key: str, segment: Segment, line: DelayLine, **facts: object) -> DesireError:
    return DesireError(Diagnostic(key, line.where.span, facts, segment.source))
