"""How many records back a delay line reads: found at the start of each run (language.md 9.2)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.library import LIBRARY, func1
from desire_tui.engine.lowered import Const, DelayLine, Load, Op, Set, Table1
from desire_tui.engine.runtime.faults import actions
from desire_tui.engine.runtime.plan import DUMMY, ROUNDING, VARIABLE_ORDER, VARIABLE_STEP
from desire_tui.engine.values import DT

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered import Segment, Value
    from desire_tui.engine.runtime.plan import Plan
    from desire_tui.engine.values import Values

_OPERATIONS: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b if b else math.nan,
    "neg": lambda a: -a,
    "pow": math.pow,
    "ipow": math.pow,
}
"""What is no library function."""


class Delays:
    """The delay lines of segments, looked for once."""

    def __init__(self) -> None:
        self._found: dict[int, tuple[Segment, tuple[DelayLine, ...], bool]] = {}

    def lags(self, segment: Segment, plan: Plan, values: Values) -> dict[int, int]:
        """Return each delay line's lag by its counter. DesireError 105: buffer too short; 122: DT varies."""
        known = self._found.get(id(segment))
        if known is None or known[0] is not segment:
            lines = tuple(a for a in actions(segment.body) if isinstance(a, DelayLine))
            changes_dt = any(isinstance(a, Set) and a.slot == DT for a in actions(segment.body))
            known = self._found[id(segment)] = (segment, lines, changes_dt)
        _, lines, changes_dt = known
        return _lags(segment, lines, changes_dt, plan, values) if lines else {}


def _lags(
    segment: Segment, lines: tuple[DelayLine, ...], changes_dt: bool, plan: Plan, values: Values
) -> dict[int, int]:
    found: dict[int, int] = {}
    for line in lines:
        if line.per_step and (changes_dt or plan.rule in VARIABLE_STEP | VARIABLE_ORDER):
            raise _error("delay-variable-step", segment, line, rule=plan.rule)
        per_step = line.per_step and plan.rule != DUMMY
        tau = _evaluate(line.tau, values)
        if not (math.isfinite(tau) and tau >= 0.0):
            raise _error("delay-negative", segment, line, tau=tau)
        lag = math.floor(tau / (plan.dt if per_step else plan.comint) + ROUNDING)
        if lag > line.count:
            name = segment.names.get(line.buffer_slot, "buffer")
            raise _error("delay-too-long", segment, line, tau=tau, needed=lag, buffer=name, count=line.count)
        found[line.counter] = lag
    return found


def _evaluate(value: Value, values: Values) -> float:
    """Return a time; nan where it has none, which is then refused."""
    match value:
        case Const():
            return value.value
        case Load():
            return values.cells[value.slot]
        case Table1():
            return func1(_evaluate(value.x, values), values.cells[value.slot : value.slot + 2 * value.count])
        case Op():
            function = _OPERATIONS.get(value.name) or LIBRARY[value.name].value
            if function is not None:  # ran() and gauss() have none: a time that is drawn is no time
                try:
                    return float(function(*(_evaluate(a, values) for a in value.args)))  # type: ignore[arg-type]
                except (ArithmeticError, ValueError):
                    return math.nan
    return math.nan


def _error(key: str, segment: Segment, line: DelayLine, **facts: object) -> DesireError:
    return DesireError(Diagnostic(key, line.where.span, facts, segment.source))
