"""What `delay(x, tau)` remembers, and what it was at an earlier time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.runtime.moments.memory import Moments

SMOOTH = 5
"""A jump in this derivative no step has to end at."""
_POINTS = 4


def begin_histories(m: Moments) -> None:
    """Begin with the values at the run's start, or go on from those of the run before."""
    m.is_inside = 0
    m.near = 0.0
    for j in range(m.delay_count):
        m.found[j] = 0
    if m.has_past != 0:
        return
    m.knots = 0
    m.jump_count = 0
    for j in range(m.delay_count):
        m.jump_at[j] = 0
    for i in range(m.n):
        m.k[i] = 0.0
    record(m)
    add_jump(m, m.values[T], 0)


def record(m: Moments) -> None:
    """Remember the values at the present t; the first derivatives of the step are known."""
    if m.delay_count != 0:
        m.sources(m.memory, m.k_at[0])
        add_knot(m)


def add_knot(m: Moments) -> None:
    """Remember what has been put where `sources` puts it."""
    if m.knots >= m.room:
        return
    t: float = m.values[T]
    if m.knots == 1 and m.times[0] == t:
        m.knots = 0
    m.times[m.knots] = t
    for j in range(m.delay_count):
        place = j * m.room + m.knots
        m.history[place] = m.values[m.source + j]
        m.slopes[place] = m.k[m.state_of[j]] if m.state_of[j] >= 0 else 0.0
    m.knots += 1


def add_jump(m: Moments, t: float, smoothness: int) -> None:
    """Note that a derivative of this order (0: the value) jumps at t; delays bring it back smoother."""
    if m.jump_count < m.jump_room and m.delay_count != 0:
        m.jumps[m.jump_count] = t
        m.smoothness[m.jump_count] = smoothness
        m.jump_count += 1


def next_return(m: Moments) -> float:
    """Return when the next jump comes back."""
    found = 1.7976931348623157e308
    for j in range(m.delay_count):
        if m.tau[j] > 0.0 and m.jump_at[j] < m.jump_count:
            found = min(found, m.jumps[m.jump_at[j]] + m.tau[j])
    return found


def pass_returns(m: Moments, slack: float) -> None:
    """Take the jumps that have come back by now as jumps of their own."""
    t: float = m.values[T]
    for j in range(m.delay_count):
        if m.tau[j] > 0.0:
            while m.jump_at[j] < m.jump_count and m.jumps[m.jump_at[j]] + m.tau[j] <= t + slack:
                smoothness = m.smoothness[m.jump_at[j]] + 1
                m.jump_at[j] += 1
                if smoothness < SMOOTH:
                    add_jump(m, t, smoothness)


def look_up(m: Moments, j: int, s: float, has_before: int, before: float) -> float:
    """Return value j at time s; `before` it was before the start, or its first value."""
    first = j * m.room
    first_value: float = m.history[first]
    start: float = m.times[0]
    edge: float = start - m.near
    if m.is_inside != 0:
        edge = start + m.near
    if s <= edge or m.knots < 2:
        if has_before != 0 and s <= edge:
            return before
        if s <= edge:
            return first_value
        slope: float = m.slopes[first]
        return first_value + slope * (s - start)
    i = interval_of(m, j, s)
    if m.state_of[j] >= 0:
        return cubic(m, first, i, s)
    return through_points(m, first, i, s)


def interval_of(m: Moments, j: int, s: float) -> int:
    """Return the number of the knot at whose right s lies; at a jump, before it while a step is made.

    The search begins where the last one for this value has ended.
    """
    limit: float = s + m.near
    if m.is_inside != 0:
        limit = s - m.near
    i: int = m.found[j]
    i = min(i, m.knots - 1)
    while i > 0 and m.times[i] > limit:
        i -= 1
    while i < m.knots - 1 and m.times[i + 1] <= limit:
        i += 1
    if i == m.knots - 1 and m.is_inside != 0 and m.times[i] > m.times[i - 1]:
        i -= 1
    m.found[j] = i
    return i


def cubic(m: Moments, first: int, i: int, s: float) -> float:
    """Return the cubic through values and slopes at both ends of an interval; behind the last, the line."""
    t0: float = m.times[i]
    x0: float = m.history[first + i]
    k0: float = m.slopes[first + i]
    if i == m.knots - 1:
        return x0 + k0 * (s - t0)
    h: float = m.times[i + 1] - t0
    if h <= 0.0:
        return x0
    x1: float = m.history[first + i + 1]
    k1: float = m.slopes[first + i + 1]
    u = (s - t0) / h
    r = 1.0 - u
    rise = x1 - x0
    return r * x0 + u * x1 - u * r * ((1.0 - 2.0 * u) * rise - r * h * k0 + u * h * k1)


def through_points(m: Moments, first: int, i: int, s: float) -> float:
    """Return the polynomial through up to four points around an interval, none beyond a jump (Neville)."""
    low = i
    high = i
    while high - low < _POINTS - 1:
        wider = 0
        if high + 1 < m.knots and m.times[high + 1] > m.times[high]:
            high += 1
            wider = 1
        if high - low < _POINTS - 1 and low > 0 and m.times[low - 1] < m.times[low]:
            low -= 1
            wider = 1
        if wider == 0:
            break
    count = high - low + 1
    for k in range(count):
        m.spare[k] = m.history[first + low + k]
    for level in range(1, count):
        for k in range(count - level):
            a: float = m.times[low + k]
            b: float = m.times[low + k + level]
            m.spare[k] = ((b - s) * m.spare[k] + (s - a) * m.spare[k + 1]) / (b - a)
    result: float = m.spare[0]
    return result
