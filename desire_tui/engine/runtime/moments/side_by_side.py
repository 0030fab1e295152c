"""Runs in lock step: what each of them remembers, and steps that some of them make alone.

All runs have the same grid of steps. One in whose step something happens makes that step as it would alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.runtime.moments.blocks import begin, next_time
from desire_tui.engine.runtime.moments.histories import add_knot, look_up
from desire_tui.engine.runtime.moments.steps import SLACK, SPLITS_MOST, step
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Ints
    from desire_tui.engine.runtime.moments.memory import Moments, SideBySide
    from desire_tui.engine.runtime.run_memory import RunMemory


def begin_runs(g: SideBySide) -> None:
    """Prepare all runs of a group; their t and states are the own numbers."""
    for run in range(g.width):
        m: Moments = g.moments[run]
        enter(g, run)
        first = g.group * (4 * g.count + g.delay_count)
        for i in range(g.count):
            m.period[i] = g.times[(first + 4 * i) * g.width + run]
            m.start[i] = g.times[(first + 4 * i + 1) * g.width + run]
            m.ticks[i] = g.times[(first + 4 * i + 2) * g.width + run]
            m.next[i] = g.times[(first + 4 * i + 3) * g.width + run]
        for j in range(g.delay_count):
            m.tau[j] = g.times[(first + 4 * g.count + j) * g.width + run]
        g.failed[run] = begin(m) > 1
        leave(g, run)


def step_runs(g: SideBySide) -> None:
    """Make the step of those runs that are wanted, each alone."""
    memory: RunMemory = g.memory
    for run in range(g.width):
        if g.wanted[run] != 0:
            m: Moments = g.moments[run]
            enter(g, run)
            for i in range(g.count):
                m.before[i] = g.before[i * g.width + run]
                m.armed[i] = g.armed[i * g.width + run]
                m.in_doubt[i] = g.in_doubt[i * g.width + run]
            for i in range(g.n):
                m.k[i] = g.k1[i * g.width + run]
            if g.wanted[run] > 1:
                m.knots -= 1
            g.failed[run] = step(m, memory, g.t_next) != 0
            leave(g, run)


def enter(g: SideBySide, run: int) -> None:
    """Put the numbers of a run where its passes look for them."""
    memory: RunMemory = g.memory
    memory.histories = g.moments[run]
    memory.k = g.k
    random: Ints = memory.random
    random[0] = g.random[run]
    for place in range(g.own_count):
        g.values[g.own_slots[place]] = g.own[place * g.width + run]
    g.values[T] = g.here


def leave(g: SideBySide, run: int) -> None:
    """Take the numbers of a run back."""
    memory: RunMemory = g.memory
    random: Ints = memory.random
    g.random[run] = random[0]
    for place in range(g.own_count):
        g.own[place * g.width + run] = g.values[g.own_slots[place]]
    m: Moments = g.moments[run]
    for i in range(g.count):
        g.before[i * g.width + run] = m.before[i]
        g.armed[i * g.width + run] = m.armed[i]
        g.in_doubt[i * g.width + run] = m.in_doubt[i]
    g.soon[run] = next_time(m)


def record_runs(g: SideBySide) -> None:
    """Remember the values at a step's start of those runs that do not make it alone."""
    memory: RunMemory = g.memory
    g.values[T] = g.here
    for run in range(g.width):
        m: Moments = g.moments[run]
        if m.knots + SPLITS_MOST > m.room:
            g.failed[run] = 1
        if g.wanted[run] == 0:
            m.near = SLACK * memory.dt_base
            for j in range(g.delay_count):
                g.values[g.source + j] = g.sources[j * g.width + run]
                state = m.state_of[j]
                if state >= 0:
                    m.k[state] = g.k1[state * g.width + run]
            add_knot(m)


def look_up_runs(g: SideBySide, j: int, has_before: int, is_inside: int) -> None:
    """Look value j up for all runs."""
    for run in range(g.width):
        m: Moments = g.moments[run]
        m.is_inside = is_inside
        g.found[run] = look_up(m, j, g.s[run], has_before, g.past[run])
        m.is_inside = 0
