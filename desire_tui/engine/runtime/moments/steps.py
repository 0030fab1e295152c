"""Steps of explicit rules that end where something happens."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.integration.tableaus import STILL_MOST
from desire_tui.engine.runtime.moments.blocks import any_rises, arrive, next_time
from desire_tui.engine.runtime.moments.histories import record
from desire_tui.engine.runtime.moments.locate import begin_at_left, locate, rises_in_step
from desire_tui.engine.runtime.moments.stages import (
    combined,
    make_stages,
    make_step,
    move,
    restore,
    save,
)
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32
    from desire_tui.engine.runtime.moments.memory import Moments
    from desire_tui.engine.runtime.run_memory import RunMemory

SPLITS_MOST = 1000
"""A step is split into so many parts at most: more events come too fast."""
SLACK = 1e-9
"""Part of a step by which two ends are the same moment."""


def step(m: Moments, memory: RunMemory, t_next: float) -> Int32:
    """Make one step of the rule, to `t_next` at most; the first derivatives are there."""
    if m.delay_count != 0 and m.knots + SPLITS_MOST > m.room:
        return Ended.FULL
    if m.stages == 0:
        return wait(m, memory, t_next)
    if m.is_variable != 0:
        return variable_step(m, memory, t_next)
    return fixed_step(m, memory)


def wait(m: Moments, memory: RunMemory, t_next: float) -> Int32:
    """Go to the next communication point where there are no states: what is due by then happens there."""
    m.values[T] = t_next
    if m.condition_count != 0:
        any_rises(m)
    return Ended.ZENO if arrive(m, SLACK * memory.comint) > 1 else Ended.RUNNING


def fixed_step(m: Moments, memory: RunMemory) -> Int32:
    """Make a step of DT, in parts if something happens in it; it ends on the grid t_base + k·DT."""
    here: float = m.values[T]
    if m.dt_may_change != 0 and m.values[DT] != memory.dt_base:
        if not here + m.values[DT] > here:
            return Ended.STALLED
        memory.t_base = here
        memory.dt_base = m.values[DT]
        memory.k = 0
    dt: float = memory.dt_base
    end: float = memory.t_base + (memory.k + 1) * dt
    whole = 1
    m.near = SLACK * dt
    while True:
        record(m)
        stop = end
        soon = next_time(m)
        if soon < end - SLACK * dt:
            stop = max(soon, here)
            whole = 0
        save(m)
        make_step(m, here, dt if whole != 0 else stop - here)
        m.values[T] = stop
        if m.condition_count != 0 and rises_in_step(m, here, stop) != 0:
            begin_at_left(m)
            stop = locate(m, here, m.left, stop)
        came = arrive(m, SLACK * dt)
        if came > 1:
            return Ended.ZENO
        if stop >= end:
            break
        whole = 0
        m.derivative(m.memory, m.k_at[0])
        here = stop
    memory.k += 1
    memory.steps += 1
    return Ended.RUNNING


def variable_step(m: Moments, memory: RunMemory, t_next: float) -> Int32:
    """Try, judge, halve or double; a step ends on every communication point and where something happens."""
    if m.watch != 0:
        bits = m.depart(m.watch)
        if bits >= CHATTERS:
            return Ended.CHATTERS
        if bits != 0:
            m.derivative(m.memory, m.k_at[0])
    here: float = m.values[T]
    target = t_next
    soon = next_time(m)
    if soon < t_next - SLACK * (t_next - here):
        target = max(soon, here)
    if m.watch != 0:
        target = m.limit(m.watch, here, target)
        m.t_stop = target
    left = target - here
    lands = m.values[DT] >= left * (1.0 - SLACK)
    cut = m.values[DT] > left * (1.0 + SLACK)
    dt: float = m.values[DT]
    if lands:
        dt = left
    if m.tau_least > 0.0 and dt > m.tau_least:
        dt = m.tau_least
        lands = False
        cut = True
    m.near = SLACK * dt
    record(m)
    save(m)
    difference = 0.0
    while True:
        make_stages(m, here, dt)
        difference = test(m, memory, dt)
        if not difference > memory.error_max:
            break
        dt = 0.5 * dt
        if dt < memory.dt_min:
            restore(m)
            m.values[T] = here
            m.values[ERRMAX] = difference
            return Ended.DEADLOCK
        memory.rejected += 1
        m.values[DT] = dt
        lands = False
        cut = False
    memory.k = 0 if lands or here + dt > here else memory.k + 1
    if memory.k >= STILL_MOST or not (lands or dt > 0.0):
        restore(m)
        m.values[T] = here
        return Ended.STALLED
    move(m, m.stages, dt)
    memory.steps += 1
    m.values[T] = target if lands else here + dt
    note_extremes(memory, dt)
    if difference < memory.error_min and not cut:
        m.values[DT] = min(2.0 * m.values[DT], memory.dt_max)
    if m.watch != 0:
        m.look(m.watch, here, m.values[T])
    if m.condition_count != 0 and rises_in_step(m, here, m.values[T]) != 0:
        begin_at_left(m)
        locate(m, here, m.left, m.values[T])
    came = arrive(m, SLACK * dt)
    if came > 1:
        return Ended.ZENO
    # a sample here shows what the blocks have left; switches of t are crossed behind it
    if came != 0 and m.watch != 0 and m.settle(m.watch, m.values[T]) >= CHATTERS:
        return Ended.CHATTERS
    return Ended.RUNNING


def test(m: Moments, memory: RunMemory, dt: float) -> float:
    """Return the largest test difference; `which` is its state."""
    row = m.stages + 1
    factor: float = dt / m.denominators[row]
    most = 0.0
    memory.which = 0
    for i in range(m.n):
        if memory.checked != 0 and memory.checked - 1 != i:
            continue
        absolute = factor * abs(combined(m, row, i))
        value = absolute
        if memory.checked == 0:
            value = absolute / (abs(m.x0[i]) + memory.error_one)
        if value > most:
            most = value
            memory.which = i
    return most


def note_extremes(memory: RunMemory, dt: float) -> None:
    """Note the smallest and the largest step so far."""
    if memory.dt_least == 0.0 or dt < memory.dt_least:
        memory.dt_least = dt
    memory.dt_most = max(memory.dt_most, dt)
