"""What rules 9 … 17 ask: how far a step may go, what is due at its end, what is to be remembered of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.runtime.moments.blocks import arrive, next_time
from desire_tui.engine.runtime.moments.histories import record
from desire_tui.engine.runtime.moments.locate import go_to

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32
    from desire_tui.engine.runtime.moments.memory import Moments

SAME = 1e-10
"""Part of COMINT by which two moments are the same (`Moments.near`)."""
FIRST_LOOK = 0.25
"""Part of the time since an event came before: so early behind it a step ends, if it may fall and come again.

A longer step's polynomial would be as exact as ERMAX asks, and what bounces lower than that fall through.
"""
PLACES = 4
"""A step is looked at in so many places, its end included; histories have as many knots in it."""


def limit_step(m: Moments, t: float, wish: float, t_next: float) -> float:
    """Return how far towards `wish` a step from t, whose states are in the values, may go.

    A clock that strikes at the next communication point but for rounding strikes there.
    """
    if m.knots == 1:
        remember_here(m)  # with derivatives, which were not known when the run began
    soon = next_time(m)
    if abs(soon - t_next) <= m.near:
        soon = t_next
    stop = min(wish, max(soon, t))
    for i in range(m.count):
        look = m.came[i] + FIRST_LOOK * m.gap[i]
        if m.in_doubt[i] != 0 and look > t:
            stop = min(stop, look)
    if m.tau_least > 0.0:
        stop = min(stop, t + m.tau_least)
    return stop


def happen(m: Moments, jumped: int) -> Int32:
    """Carry out what is due at the t and states in the values; `jumped`: these are new ones.

    0, 1, 2: as `blocks.arrive`.
    """
    if m.condition_count != 0:
        m.conditions(m.memory, m.k_at[0])
    came = arrive(m, m.near)
    if came + jumped != 0:
        remember_here(m)
    return came


def remember_step(m: Moments, t0: float, t1: float) -> None:
    """Record the solver's last step, or its part up to t1, with the states' derivatives in it."""
    if m.delay_count == 0 or not t1 > t0:
        return
    for k in range(1, PLACES + 1):
        t = t1
        if k < PLACES:
            t = t0 + (t1 - t0) * k / PLACES
        go_to(m, t0, t)
        remember_here(m)


def remember_here(m: Moments) -> None:
    """Record the t and states in the values."""
    if m.delay_count != 0:
        m.derivative(m.memory, m.k_at[0])
        record(m)
