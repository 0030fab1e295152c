"""Where in a step the first event's expression rises: its inside is looked at, ever closer to that place.

Rules 0 … 8 make the step again, as far as that; rules 9 … 17 have a polynomial of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.halving import RESOLUTION
from desire_tui.engine.runtime.moments.blocks import (
    any_doubt,
    any_rises,
    arm_fallen,
    has_doubt,
    keep_arms,
    rises,
    take_side,
)
from desire_tui.engine.runtime.moments.stages import make_step
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.runtime.moments.memory import Moments


NEAREST = 4.5e-16
"""Part of t by which the first look behind a step's start lies behind it; each other twice as far."""


def go_to(m: Moments, here: float, t: float) -> None:
    """Put t and the states there into the values, in a step that began at `here`."""
    if m.places != 0:
        m.place(m.owner, t)
    else:
        make_step(m, here, t - here)
        m.values[T] = t


def rises_in_step(m: Moments, here: float, end: float) -> int:
    """Whether an expression has risen in the step from `here` to `end` that has been made; behind `left`."""
    m.left = here
    risen = any_rises(m)
    if any_doubt(m) == 0:
        return risen
    m.left = clear_doubt(m, here, end)
    go_to(m, here, end)
    return any_rises(m)


def clear_doubt(m: Moments, here: float, end: float) -> float:
    """Look ever farther behind a step's start whether conditions in doubt fall below 0.

    Returns where the last of them is below 0; `here`: none of them falls.
    """
    fallen = here
    reach = NEAREST * max(abs(here), abs(end))
    while has_doubt(m) != 0 and here + reach < end:
        if here + reach > here:
            go_to(m, here, here + reach)
            if take_side(m) != 0:
                fallen = here + reach
        reach *= 2.0
    return fallen


def look_inside(m: Moments, t0: float, t1: float) -> int:
    """Find the first event in a step of a rule 9 … 17; 1: t and the states are those just behind it."""
    if m.condition_count == 0 or not t1 > t0:
        return 0
    keep_arms(m)
    left = t0
    if has_doubt(m) != 0:
        left = clear_doubt(m, t0, t1)
    begin_at_left(m)
    places: int = m.places
    for k in range(1, places + 1):
        right = t1
        if k < places:
            right = t0 + (t1 - t0) * k / places
        if right > left:
            go_to(m, t0, right)
            if any_rises(m) != 0:
                locate(m, t0, left, right)
                return 1
            arm_fallen(m)
            keep(m, 0)
            left = right
    return 0


def begin_at_left(m: Moments) -> None:
    """Take the expressions at a step's start as those at the left end."""
    for i in range(m.count):
        m.at_left[i] = m.before[i]


def locate(m: Moments, here: float, start: float, end: float) -> float:
    """Return the first number t behind the root; t and the states in the values are those there.

    In a step from `here` some expression has risen between `start`, where the expressions are `at_left`, and
    `end`, whose states are in the values.
    """
    left = start
    right = end
    keep(m, 1)
    turn = 0
    stayed = 0
    least = RESOLUTION * max(abs(start), abs(end))
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
        go_to(m, here, t)
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
    go_to(m, here, right)
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
