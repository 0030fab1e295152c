"""Which events are due where a step has ended, and their blocks carried out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.runtime.moments.histories import (
    add_jump,
    begin_histories,
    next_return,
    pass_returns,
    record,
)
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.runtime.moments.memory import Moments

FIRINGS_MOST = 200
"""So many firings within the part of a run that `span` names end it."""
_FEW_STEPS, _SHRUNK_LEAST = 12.0, 5
"""An event comes every few steps; before, the time between two became less so often in a row."""
_SOONER_LEAST, _NARROW = 5, 1e-2
"""An event has come ever sooner so many times in a row, until this part was left of the time between two."""
_AT_ONCE = 1e-13
"""Such an event comes at once: within `span`, or this part of t."""
_RISES_LEAST = 3
"""So many looks in a row at which a condition is larger than before tell that it does not fall."""
NEVER = 1.7976931348623157e308


def begin(m: Moments) -> int:
    """Prepare a run that starts with the t and states in the values; return 2 if events come too fast."""
    t: float = m.values[T]
    m.firings = 0
    m.firings_since = t
    m.lost = 0
    if m.condition_count != 0:
        m.conditions(m.memory, m.k_at[0])
    for i in range(m.count):
        value: float = m.values[m.now + i]
        m.values[m.due + i] = 0.0
        m.before[i] = value
        m.came[i] = t
        m.gap[i] = 0.0
        m.widest[i] = 0.0
        m.sooner[i] = 0
        m.turned[i] = 0
        m.shrunk[i] = 0
        m.quick[i] = 0
        m.in_doubt[i] = 0
        m.armed[i] = value < 0.0 or (value == 0.0 and m.goes_on == 0)
    if due(m, 0.0) != 0 and carry_out(m) > 1:
        return 2
    begin_histories(m)
    return 1


def next_time(m: Moments) -> float:
    """Return when the next event of the clock is due, or a jump comes back."""
    found = NEVER
    if m.delay_count != 0:
        found = next_return(m)
    for i in range(m.count):
        if m.period[i] > 0.0:
            found = min(found, m.next[i])
    return found


def rises(m: Moments, i: int, value: float) -> int:
    """Whether event i is due with this value of its condition: above 0, or at 0 from below."""
    if m.period[i] > 0.0 or m.armed[i] == 0:
        return 0
    return value > 0.0 or (value == 0.0 and m.before[i] < 0.0)


def any_rises(m: Moments) -> int:
    """Compute the conditions at the t and states in the values; whether one of them has risen."""
    m.conditions(m.memory, m.k_at[0])
    found = 0
    for i in range(m.count):
        if rises(m, i, m.values[m.now + i]) != 0:
            found = 1
    return found


def any_doubt(m: Moments) -> int:
    """Whether a condition not below 0 behind its own block is above 0: it may have been below in between."""
    found = 0
    for i in range(m.count):
        if m.in_doubt[i] != 0 and m.values[m.now + i] > 0.0:
            found = 1
    return found


def take_side(m: Moments) -> int:
    """Arm conditions in doubt that are below 0 at the t and states in the values; 1: some are.

    Those that have risen from one look to the next some times in a row are in doubt no more.
    """
    m.conditions(m.memory, m.k_at[0])
    found = 0
    for i in range(m.count):
        value: float = m.values[m.now + i]
        if m.in_doubt[i] != 0:
            if value < 0.0:
                m.in_doubt[i] = 0
                m.armed[i] = 1
                m.turned[i] = 1
                found = 1
            elif value > m.before[i]:
                m.in_doubt[i] += 1
                if m.in_doubt[i] > _RISES_LEAST:
                    m.in_doubt[i] = 0
                    if narrows(m, i, m.gap[i]) != 0:
                        m.lost = i + 1
            else:
                m.in_doubt[i] = 1
            m.before[i] = value
    return found


def has_doubt(m: Moments) -> int:
    """Whether it is not known of some condition if it falls behind its own block."""
    found = 0
    for i in range(m.count):
        if m.in_doubt[i] != 0:
            found = 1
    return found


def arm_fallen(m: Moments) -> None:
    """Arm the conditions that are below 0 inside a step, in which no event has come yet."""
    for i in range(m.count):
        value: float = m.values[m.now + i]
        if m.period[i] == 0.0 and value < 0.0:
            if m.in_doubt[i] != 0:
                m.turned[i] = 1
            m.in_doubt[i] = 0
            m.armed[i] = 1
            m.before[i] = value


def keep_arms(m: Moments) -> None:
    """Remember how conditions stand at a step's start."""
    for i in range(m.count):
        m.kept_armed[i] = m.armed[i]
        m.kept_doubt[i] = m.in_doubt[i]
        m.kept_before[i] = m.before[i]


def cut_short(m: Moments) -> None:
    """Let conditions stand as at the step's start: it ends earlier than where they were followed to."""
    for i in range(m.count):
        m.armed[i] = m.kept_armed[i]
        m.in_doubt[i] = m.kept_doubt[i]
        m.before[i] = m.kept_before[i]


def arrive(m: Moments, slack: float) -> int:
    """Carry out what is due at t, clocks that are `slack` away included.

    The conditions have been computed. 0: nothing was due, 1: something was, 2: far too much is.
    """
    if m.lost != 0:
        m.last_fired = m.lost - 1
        return 2
    pass_returns(m, slack)
    if due(m, slack) == 0:
        return 0
    if m.delay_count != 0:
        m.derivative(m.memory, m.k_at[0])
        record(m)  # how it was before the jump
        add_jump(m, m.values[T], 0)
    return carry_out(m)


def due(m: Moments, slack: float) -> int:
    """Mark what is due at t; return how many there are."""
    t: float = m.values[T]
    found = 0
    for i in range(m.count):
        if m.period[i] > 0.0:
            while m.next[i] <= t + slack:
                m.values[m.due + i] = 1.0
                found += 1
                m.ticks[i] += 1.0
                m.next[i] = m.start[i] + m.ticks[i] * m.period[i]
        else:
            found += note(m, i)
    return found


def carry_out(m: Moments) -> int:
    """Run the blocks that are due, and those that they set off."""
    t: float = m.values[T]
    while True:
        m.blocks(m.memory, m.k_at[0])
        if has_fired(m, t) != 0:
            return 2
        if m.watch != 0:
            m.settle(m.watch, t)  # conditions read what switches: by the states that the blocks have left
        if m.condition_count != 0:
            m.conditions(m.memory, m.k_at[0])
        found = 0
        for i in range(m.count):
            ran: float = m.values[m.due + i]
            m.values[m.due + i] = 0.0
            if m.period[i] > 0.0:
                continue
            if ran == 0.0:
                found += note(m, i)
            else:
                value: float = m.values[m.now + i]
                # at 0 by its own block: it may rise again; else it has had its turn, unless it falls from
                # here on, as it does where the block has turned a state round
                m.armed[i] = value < 0.0 or (value == 0.0 and m.fired[i] > 0.0)
                m.in_doubt[i] = m.armed[i] == 0
                m.turned[i] = m.armed[i]
                m.before[i] = value
        if found == 0:
            return 1


def note(m: Moments, i: int) -> int:
    """Take up the present value of condition i; 1: its block is due."""
    value: float = m.values[m.now + i]
    if m.in_doubt[i] != 0:
        if value < 0.0:
            m.turned[i] = 1
        m.in_doubt[i] = value > 0.0 and value < m.before[i]  # still falling
    due = rises(m, i, value)
    if due != 0:
        m.values[m.due + i] = 1.0
        m.fired[i] = value
        m.armed[i] = 0
    elif value < 0.0 or (value == 0.0 and m.before[i] > 0.0):
        m.armed[i] = 1
    elif value > 0.0:
        m.armed[i] = 0
    m.before[i] = value
    return due


def narrows(m: Moments, i: int, gap: float) -> int:
    """Whether event i has come ever sooner behind its own block, and at last `gap` behind the time before."""
    times: int = m.sooner[i]
    return times >= _SOONER_LEAST and gap < _NARROW * m.widest[i]


def closes_in(m: Moments, i: int, gap: float, t: float) -> int:
    """Whether event i, which comes `gap` behind the time before, came ever sooner and now comes at once."""
    if m.turned[i] != 0 and gap < m.gap[i]:
        m.sooner[i] += 1
    else:
        m.sooner[i] = 0
        m.widest[i] = gap
    return narrows(m, i, gap) != 0 and gap <= max(m.span, _AT_ONCE * abs(t))


def piles_up(m: Moments, i: int, gap: float) -> int:
    """Whether event i came ever faster, and by now has come every few steps for a long time.

    Fixed steps may hide that it comes faster still: what bounces is carried on by the size of DT alone.
    """
    if gap > _FEW_STEPS * m.values[DT]:
        m.shrunk[i] = m.shrunk[i] + 1 if gap < m.gap[i] else 0
        m.quick[i] = 0
    elif m.shrunk[i] >= _SHRUNK_LEAST:
        m.quick[i] += 1
    times: int = m.quick[i]
    return times >= FIRINGS_MOST


def has_fired(m: Moments, t: float) -> int:
    """Count the conditions that are due; 1 if very many came in a very short time."""
    fired = 0
    for i in range(m.count):
        if m.period[i] == 0.0 and m.values[m.due + i] != 0.0:
            m.last_fired = i
            fired = 1
            gap: float = t - m.came[i]
            if closes_in(m, i, gap, t) != 0:
                return 1
            if m.is_variable == 0 and m.stages != 0 and piles_up(m, i, gap) != 0:
                return 1
            m.came[i] = t
            m.gap[i] = gap
    m.firings += fired
    if m.firings < FIRINGS_MOST:
        return 0
    span: float = m.span
    gone: float = t - m.firings_since
    m.firings = 0
    m.firings_since = t
    return gone <= span
