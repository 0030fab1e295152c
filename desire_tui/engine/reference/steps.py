"""One step of an explicit rule: fixed, or controlled (language.md 11)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.integration.tableaus import CHANGE, LATE_HOLD, LATE_PARTS, STILL_MOST, whole_multiples
from desire_tui.engine.passes.assigned_states import checked_state
from desire_tui.engine.reference.states import sum_of_multiples
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.integration.tableaus import Row, Tableau
    from desire_tui.engine.reference.statements import Run
    from desire_tui.engine.reference.states import States
    from desire_tui.engine.reference.switches import Switches
    from desire_tui.engine.runtime.run_memory import RunMemory

TOLERANCE = 1e-9


class SteppedModel(Protocol):
    """What a step asks of a model: its numbers, its states, the stages behind the first and their passes."""

    cells: memoryview[float]
    states: States
    nodes: list[tuple[int, float]]
    numbers: Sequence[int]
    switches: Switches | None
    step_renewal: Run

    def run_stage(self, stage: int, memory: RunMemory) -> None:
        """Make a pass with both flags off; its derivatives are k[stage]."""


def fixed_step(model: SteppedModel, tableau: Tableau, memory: RunMemory) -> Ended | None:
    """Move the states by one step of DT: t = t_base + k·dt_base as long as DT does not change."""
    cells, states = model.cells, model.states
    if tableau.rule.dt_may_change and cells[DT] != memory.dt_base:
        if not cells[T] + cells[DT] > cells[T]:
            memory.phase = Phase.ENDED
            return Ended.STALLED
        memory.t_base, memory.dt_base, memory.k = cells[T], cells[DT], 0
    dt, base, k = memory.dt_base, memory.t_base, memory.k
    start = states.fetch()
    for stage, node in model.nodes:
        states.move(stage, start, dt)
        cells[T] = base + (k + node) * dt
        model.run_stage(stage, memory)
    states.move(len(model.nodes) + 1, start, dt)
    memory.k = k + 1
    memory.steps += 1
    cells[T] = base + (k + 1) * dt
    _note_extremes(memory, dt)
    if cells[T] >= memory.t_start + memory.point * memory.comint - TOLERANCE * dt:
        memory.phase = Phase.AT_POINT
    return None


def variable_step(model: SteppedModel, tableau: Tableau, memory: RunMemory) -> Ended | None:
    """Try, judge, halve or double; a step ends on every communication point."""
    cells, states = model.cells, model.states
    assert tableau.test is not None
    here, start = cells[T], states.fetch()
    next_point = memory.t_start + memory.point * memory.comint
    switches = model.switches
    stop = next_point if switches is None else switches.limit(here, next_point)
    left = stop - here
    lands = cells[DT] >= left * (1.0 - TOLERANCE)
    cut = cells[DT] > left * (1.0 + TOLERANCE)
    dt = left if lands else cells[DT]
    while True:
        for stage, node in model.nodes:
            states.move(stage, start, dt)
            cells[T] = stop if switches is not None and lands and node == 1.0 else here + node * dt
            model.run_stage(stage, memory)
        checked = checked_state(memory.checked, model.numbers)
        difference, state = _difference(model, tableau.test, dt, start, checked, memory.error_one)
        if not difference > memory.error_max:
            break
        dt = 0.5 * dt
        if dt < memory.dt_min:
            states.put(start)
            cells[T], cells[ERRMAX] = here, difference
            memory.which, memory.phase = model.numbers[state], Phase.ENDED
            return Ended.DEADLOCK
        memory.rejected += 1
        cells[DT] = dt
        lands = cut = False
    memory.k = 0 if lands or here + dt > here else memory.k + 1
    if memory.k >= STILL_MOST or not (lands or dt > 0.0):
        states.put(start)
        cells[T], memory.phase = here, Phase.ENDED
        memory.which = model.numbers[state]
        return Ended.STALLED
    states.move(tableau.stages, start, dt)
    memory.steps += 1
    cells[T] = stop if lands else here + dt
    _note_extremes(memory, dt)
    held, memory.late_hold = memory.late_hold > 0, max(memory.late_hold - 1, 0)
    if difference < memory.error_min and not cut and not held:
        if 2.0 * cells[DT] < memory.late_dt:
            memory.late_hold = LATE_HOLD
        else:
            memory.late_dt = 0.0
        cells[DT] = min(2.0 * cells[DT], memory.dt_max)
    if switches is not None:
        bits = switches.follow(here, cells[T], next_point, start, states.k[0])
        if bits >= CHATTERS:
            return chattering(switches, memory)
        lands = cells[T] >= next_point
    if lands:
        memory.phase = Phase.AT_POINT
    return None


def renew_in_interval(model: SteppedModel, memory: RunMemory) -> None:
    """Make k1 anew behind a step's start; DT is less where code there has changed it by much."""
    cells, k = model.cells, model.states.k
    k[1][:] = k[0]
    model.step_renewal()
    dt = cells[DT]
    checked = checked_state(memory.checked, model.numbers)
    change, _ = _difference(model, CHANGE, dt, model.states.fetch(), checked, memory.error_one)
    if change > memory.error_max:
        least = min(abs(memory.t_max) / LATE_PARTS, dt)
        cells[DT] = max(dt * (memory.error_max / change), least)
        memory.late_dt, memory.late_hold = max(dt, memory.late_dt), LATE_HOLD


def chattering(switches: Switches, memory: RunMemory) -> Ended:
    """End a run that a switch holds up."""
    memory.culprit, memory.phase = switches.culprit(), Phase.ENDED
    return Ended.CHATTERS


def _difference(
    model: SteppedModel, test: Row, dt: float, start: Sequence[float], checked: int, one: float
) -> tuple[float, int]:
    """Return the largest test difference, and the number of its state.

    Relative to |x| + `one` with x at the step's start; absolute, and of one state, with CHECKN (0: that
    state is not integrated). A state that is nan has no difference: the run ends at it when the step is done.
    """
    denominator, multiples = whole_multiples(test)
    absolute = dt / denominator * np.abs(sum_of_multiples(multiples, model.states.k))
    if checked > len(absolute):
        return 0.0, 0
    if checked:
        return float(np.nan_to_num(absolute[checked - 1], posinf=np.inf)), checked - 1
    relative = np.nan_to_num(absolute / (np.abs(np.asarray(start)) + one), posinf=np.inf)
    largest = int(np.argmax(relative))
    return float(relative[largest]), largest


def _note_extremes(memory: RunMemory, dt: float) -> None:
    """Keep the smallest and largest step so far; 0 means none yet."""
    if memory.dt_least == 0.0 or dt < memory.dt_least:
        memory.dt_least = dt
    memory.dt_most = max(memory.dt_most, dt)
