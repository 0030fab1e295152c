"""One step: try, judge, halve or double (language.md 11); the solution inside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.explicit.memory import DEADLOCK, GAVE_UP, NOT_FINITE, ROW
from desire_tui.engine.integration.hermite import inside

if TYPE_CHECKING:
    from desire_tui.engine.integration.explicit.memory import Explicit
    from desire_tui.engine.integration.plain_types import Reals

DONE, AT_STOP = 0, 1
_TOLERANCE = 1e-9
"""A step that would end this near to its stop (relative to what is left) ends on it."""


def restart(s: Explicit, t: float, first_step: float) -> None:
    """Begin anew from the states in `y`; only the first step of a run is not the solver's own.

    A step behind an event that is as long as those before may see the next one come and go, as where a ball
    bounces lower each time.
    """
    s.t = t
    s.is_known = 0
    s.rejected = 0
    if s.dt == 0.0:
        s.dt = first_step
    s.dt = min(s.dt, s.dt_anew)


def advance(s: Explicit, t_stop: float) -> int:
    """Take one step, never beyond `t_stop`; `y` and `t` are then the solution. Return a flag."""
    stages = s.stages
    t0: float = s.t
    put(s.base, 0, s.y, 0, s.n)
    if s.is_known == 0:
        if derive(s, t0, 0) < 0:
            return GAVE_UP
    else:
        put(s.k, 0, s.k, stages * s.n, s.n)
    left = t_stop - t0
    lands = s.dt >= left * (1.0 - _TOLERANCE)
    is_cut = s.dt > left * (1.0 + _TOLERANCE)
    h: float = s.dt
    if lands:
        h = left
    while True:
        for stage in range(1, stages):
            move(s, stage, h)
            t = t0 + s.nodes[stage] * h
            if lands and s.nodes[stage] == 1.0:
                t = t_stop
            if derive(s, t, stage) < 0:
                return GAVE_UP
        judge(s, h)
        if not s.difference > s.error_most:
            break
        h = 0.5 * h
        if h < s.dt_least:
            put(s.y, 0, s.base, 0, s.n)
            return DEADLOCK
        s.rejected += 1
        s.dt = h
        lands = False
        is_cut = False
    move(s, stages, h)
    s.t_base = t0
    s.t = t_stop if lands else t0 + h
    s.h_last = h
    if s.difference < s.error_least and not is_cut:
        s.dt = min(2.0 * s.dt, s.dt_most)
    put(s.end, 0, s.y, 0, s.n)
    if are_finite(s.end, s.n) == 0:
        return NOT_FINITE
    flag = derive(s, s.t, stages)
    if flag < 0:
        return GAVE_UP
    s.is_known = 1
    s.is_cubic = 1 if flag == 0 else 0
    return AT_STOP if lands else DONE


def derive(s: Explicit, t: float, row: int) -> int:
    """Compute the derivatives of `y` at t into a row of `k`; return the callback's flag."""
    flag: int = s.evaluate(s.problem, t, s.y, s.rate)
    put(s.k, row * s.n, s.rate, 0, s.n)
    return flag


def put(to: Reals, to_first: int, source: Reals, first: int, count: int) -> None:
    """Copy numbers."""
    for i in range(count):
        to[to_first + i] = source[first + i]


def are_finite(x: Reals, n: int) -> int:
    """Whether all numbers are."""
    total = 0.0
    for i in range(n):
        total += x[i] - x[i]  # 0 for every finite number
    return 1 if total == 0.0 else 0


def move(s: Explicit, row: int, h: float) -> None:
    """States ← those at the start + h·Σ row·k."""
    add_up(s, row, s.y)
    part = h / s.rows[row * ROW]
    y: Reals = s.y
    base: Reals = s.base
    for i in range(s.n):
        y[i] = base[i] + part * y[i]


def add_up(s: Explicit, row: int, out: Reals) -> None:
    """Write the sum of whole multiples of derivatives, in the order of the stages (`tableaus`)."""
    n = s.n
    k: Reals = s.k
    begun = 0
    for stage in range(s.stages):
        multiple: float = s.rows[row * ROW + 1 + stage]
        at = stage * n
        if multiple != 0.0 and begun == 0:
            begun = 1
            for i in range(n):
                out[i] = multiple * k[at + i]
        elif multiple != 0.0:
            for i in range(n):
                out[i] = out[i] + multiple * k[at + i]


def judge(s: Explicit, h: float) -> None:
    """Find the largest test difference and its state; a state that is nan has none."""
    row = s.stages + 1
    add_up(s, row, s.rate)
    part = h / s.rows[row * ROW]
    most = 0.0
    worst = 0
    for i in range(s.n):
        size = part * abs(s.rate[i])
        if s.checked == 0:
            size = size / (abs(s.base[i]) + s.error_one)
        elif s.checked != i + 1:
            size = 0.0
        if size > most:
            most = size
            worst = i
    s.difference = most
    s.worst = worst


def put_inside(s: Explicit, t: float, out: Reals) -> None:
    """Write the solution inside the last step to `out`: the cubic, a parabola where the end has no slope."""
    n = s.n
    h: float = s.h_last
    part = (t - s.t_base) / h
    at = s.stages * n
    k: Reals = s.k
    base: Reals = s.base
    end: Reals = s.end
    if s.is_cubic != 0:
        for i in range(n):
            out[i] = inside(part, base[i], end[i], h * k[i], h * k[at + i])
        return
    for i in range(n):
        slope = h * k[i]
        out[i] = inside(part, base[i], end[i], slope, 2.0 * (end[i] - base[i]) - slope)
