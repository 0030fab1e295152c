"""One step of an explicit rule from the states that were saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.runtime.moments.memory import Moments


def save(m: Moments) -> None:
    """Keep the states at a step's start."""
    for r in range(m.range_count):
        for i in range(m.ranges[3 * r + 2]):
            m.x0[m.ranges[3 * r + 1] + i] = m.values[m.ranges[3 * r] + i]


def restore(m: Moments) -> None:
    """States ← saved states."""
    for r in range(m.range_count):
        for i in range(m.ranges[3 * r + 2]):
            m.values[m.ranges[3 * r] + i] = m.x0[m.ranges[3 * r + 1] + i]


def move(m: Moments, row: int, dt: float) -> None:
    """States ← saved states + dt·Σ row·k, in the order of the k's."""
    factor: float = dt / m.denominators[row]
    for r in range(m.range_count):
        for i in range(m.ranges[3 * r + 2]):
            state = m.ranges[3 * r + 1] + i
            m.values[m.ranges[3 * r] + i] = m.x0[state] + factor * combined(m, row, state)


def combined(m: Moments, row: int, state: int) -> float:
    """Return Σ row·k of a state."""
    total = 0.0
    for stage in range(m.stages):
        multiple: float = m.rows[row * m.stages + stage]
        if multiple != 0.0:
            total += multiple * m.k[stage * m.n + state]
    return total


def make_stages(m: Moments, here: float, dt: float) -> None:
    """Compute the derivatives behind the first ones; t is `here` at the start."""
    m.is_inside = 1
    for stage in range(1, m.stages):
        move(m, stage, dt)
        t: float = here + m.nodes[stage] * dt
        m.values[T] = min(t, m.t_stop) if m.watch != 0 else t
        m.derivative(m.memory, m.k_at[stage])
    m.is_inside = 0


def make_step(m: Moments, here: float, dt: float) -> None:
    """Make a whole step; t is left to the caller."""
    make_stages(m, here, dt)
    move(m, m.stages, dt)
