"""Where in a step the first event's expression rises: the step is made again, ever closer to that place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.halving import RESOLUTION
from desire_tui.engine.runtime.moments.blocks import any_doubt, any_falls, any_rises, rises
from desire_tui.engine.runtime.moments.stages import make_step
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.runtime.moments.memory import Moments


PROBES = 60
"""Looks at a step's first half, quarter, eighth … for a condition that falls from 0 and rises again."""


def rises_in_step(m: Moments, here: float, end: float) -> int:
    """Whether an expression has risen in the step from `here` to `end` that has been made."""
    risen = any_rises(m)
    if any_doubt(m) == 0:
        return risen
    part = 1.0
    for _ in range(PROBES):
        part *= 0.5
        t = here + part * (end - here)
        if not t > here:
            break
        make_step(m, here, t - here)
        m.values[T] = t
        if any_falls(m) != 0:
            break
    make_step(m, here, end - here)
    m.values[T] = end
    return any_rises(m)


def locate(m: Moments, here: float, end: float) -> float:
    """Return the first number t behind the root; t and the states in the values are those there.

    A step from `here` to `end` has been made, and some expression has risen in it.
    """
    left = here
    right = end
    keep(m, 1)
    for i in range(m.count):
        m.at_left[i] = m.before[i]
    turn = 0
    stayed = 0
    least = RESOLUTION * max(abs(here), abs(end))
    while right - left > least:
        middle = left + 0.5 * (right - left)
        if not (middle > left and middle < right):
            break
        turn += 1
        t = middle
        if turn == 3:
            turn = 0
        else:
            t = guessed(m, left, right)
            if not (t > left and t < right):
                t = middle
        make_step(m, here, t - here)
        m.values[T] = t
        if any_rises(m) != 0:
            right = t
            keep(m, 1)
            if stayed > 0:
                weigh(m, 0)
            stayed = 1
        else:
            left = t
            keep(m, 0)
            if stayed < 0:
                weigh(m, 1)
            stayed = -1
    make_step(m, here, right - here)
    m.values[T] = right
    any_rises(m)
    return right


def keep(m: Moments, is_right: int) -> None:
    """Remember the expressions at one end."""
    for i in range(m.count):
        if is_right != 0:
            m.at_right[i] = m.values[m.now + i]
        else:
            m.at_left[i] = m.values[m.now + i]


def weigh(m: Moments, is_right: int) -> None:
    """Halve the expressions at the end that stays, so that the next guess comes nearer to it (Illinois)."""
    for i in range(m.count):
        if is_right != 0:
            m.at_right[i] *= 0.5
        else:
            m.at_left[i] *= 0.5


def guessed(m: Moments, left: float, right: float) -> float:
    """Return where the first of the straight lines between the ends crosses 0."""
    found = right
    for i in range(m.count):
        if rises(m, i, m.at_right[i]) != 0:
            low: float = m.at_left[i]
            rise: float = m.at_right[i] - low
            if rise > 0.0:
                found = min(found, left - (right - left) * low / rise)
    return found
