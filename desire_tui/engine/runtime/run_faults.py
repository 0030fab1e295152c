"""What went wrong in a run: which variable, when, and the line that defines it (language.md 9.8)."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.lowered.effects import reads, writes
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.lowered.statements import Assignment, Deriv, DerivVec
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.values import DT, ERRMAX, IROW, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

_SOLVER_KEYS = {
    -1: "solver-gave-up", -2: "solver-too-accurate", -3: "solver-error-test", -4: "solver-corrector",
    -5: "solver-linear", -6: "solver-singular", -7: "solver-linear", -8: "solver-derivative",
    -9: "solver-derivative", -10: "solver-derivative", -15: "solver-corrector", -27: "solver-too-close",
}  # fmt: skip
"""CVODE's return flags (SUNDIALS 7, cvode.h)."""


def first_not_finite(
    data: NDArray[np.float64],
    states: NDArray[np.int64],
    columns: NDArray[np.int64],
    vital: NDArray[np.int64],
) -> int:
    """Return `RunMemory.which`: the first state that is inf or nan, else -1 - the first such column.

    `data` are all numbers, `states` and `columns` the slots of states and sampled variables, `vital` the
    numbers of the columns that count (`passes.vital_columns`).
    """
    wild = np.flatnonzero(~np.isfinite(data[states]))
    if wild.size:
        return int(wild[0])
    wild = vital[~np.isfinite(data[columns[vital]])]
    return -1 - int(wild[0]) if wild.size else 0


def fault(ended: Ended, segment: Segment, plan: RunPlan, memory: RunMemory, values: Values) -> DesireError:
    """Return the error for a run that ended by a fault."""
    cells, t = values.cells, values.cells[T]
    which = int(memory.which)
    if ended is Ended.DEADLOCK:
        name, where = state_name(segment, which)
        facts = {
            "t": t, "state": name, "difference": cells[ERRMAX], "ermax": plan.error_max, "dt": cells[DT],
        }  # fmt: skip
        return _placed("variable-step-deadlock", facts, segment, where)
    if ended is Ended.STALLED:
        dt = cells[DT]
        if dt > 0.0 and rule_numbered(plan.rule).kind == "variable":
            name, where = state_name(segment, which)
            return _placed("time-stalled-by-state", {"t": t, "dt": dt, "state": name}, segment, where)
        return _placed("time-stalled", {"t": t, "dt": dt}, segment, defining(segment, DT))
    if ended is Ended.CHATTERS:
        assert memory.culprit is not None
        name, where = memory.culprit
        driven = _driven(segment, where)
        held = f"state '{driven}'" if driven else "the run"
        facts = {"t": t, "name": name, "dt": cells[DT], "held": held}
        return _placed("switch-chatters", facts, segment, where)
    if ended is Ended.NO_HEADWAY:
        found = memory.standstill
        assert found is not None
        name, where = state_name(segment, found.state)
        facts = {
            "t": t, "dt": cells[DT], "state": name, "why": found.why, "advice": found.advice,
            "steps": int(memory.steps), "rule": plan.rule,
        }  # fmt: skip
        return _placed("no-headway", facts, segment, where)
    if ended is Ended.SOLVER:
        name, where = state_name(segment, int(memory.suspect))
        facts = {"t": t, "dt": cells[DT], "rule": plan.rule, "state": name, "flag": which}
        return _placed(_SOLVER_KEYS.get(which, "solver-broken"), facts, segment, where)
    if ended is Ended.ZENO:
        where = segment.events[which].where
        return _placed("events-too-fast", {"t": t}, segment, where)
    if which >= 0:
        name, where = state_name(segment, which)
        value = cells[_state_slot(segment, which)]
    else:
        column = segment.columns[-1 - which]
        name, value = column.name, cells[column.slot]
        where = defining(segment, column.slot) or column.where
    return _placed("not-finite", {"name": name, "what": described(value), "t": t}, segment, where)


def watched_fault(ended: Ended, segment: Segment, memory: RunMemory, values: Values) -> DesireError | None:
    """Return the error of a run that one of the compiler's own tests ended (232, 475, 124), else None."""
    if ended is not Ended.TERM:
        return None
    for watched in segment.faults:
        if watched.number == memory.which:
            key = watched.fault
            assert key is not None
            if isinstance(watched.value, Load):
                if values.cells[watched.value.slot] == 2.0:  # `LearningStep.full_slot`
                    key = "learning-without-vector"
                values.cells[watched.value.slot] = 0.0  # the next run begins without it
            facts: dict[str, object] = {"t": values.cells[T], "value": values.cells[IROW]}
            return _placed(key, facts, segment, watched.where)
    return None


def state_name(segment: Segment, number: int) -> tuple[str, Where | None]:
    """Return the name of a state (`x`, `V[3]`) and the line that defines its derivative."""
    for states in segment.states:
        if states.first <= number < states.first + states.count:
            index = number - states.first
            name = f"{states.name}[{index + 1}]" if states.count > 1 else states.name
            return name, _derivative(segment, number) or states.where
    return f"number {number + 1}", None


def _driven(segment: Segment, where: Where) -> str:
    """Return the name of the first state whose derivative depends on what stands at a place; else ''."""
    changed: set[int] = set()
    for action in walk_actions(segment.body):
        if action.where != where and not any(
            slot + i in changed for slot, count in reads(action) for i in range(count)
        ):
            continue
        if isinstance(action, Deriv | DerivVec):
            return state_name(segment, action.state)[0]
        changed.update(slot + i for slot, count in writes(action) for i in range(count))
    return ""


def _state_slot(segment: Segment, number: int) -> int:
    for states in segment.states:
        if states.first <= number < states.first + states.count:
            return states.slot + number - states.first
    return T


def _derivative(segment: Segment, number: int) -> Where | None:
    for action in walk_actions(segment.body):
        match action:
            case Deriv(state=state) if state == number:
                return action.where
            case DerivVec(state=state, count=count) if state <= number < state + count:
                return action.where
    return None


def defining(segment: Segment, slot: int) -> Where | None:
    """Return the place that gives a slot its value: an assignment, or a state's derivative."""
    for action in walk_actions(segment.body):
        if not isinstance(action, Assignment):
            continue
        if any(first <= slot < first + count for first, count in writes(action)):
            return action.where
    for states in segment.states:
        if states.slot <= slot < states.slot + states.count:
            return _derivative(segment, states.first + slot - states.slot)
    return None


def _placed(key: str, facts: dict[str, object], segment: Segment, where: Where | None) -> DesireError:
    return DesireError(at_statement(key, facts, segment, where))


def described(value: float) -> str:
    """Return what became of a number: `infinite`, `undefined (nan)`."""
    if isnan(value):
        return "undefined (nan)"
    return "infinite" if abs(value) == float("inf") else f"{value:g}"
