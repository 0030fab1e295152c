"""Where in a step of rule 17 the first event comes: by the roots of the conditions' own Taylor polynomials.

A condition is looked at only where a part of the step ends in which its polynomial has a root, the only one
there: what it is at that place, by its expression, tells whether it has risen or fallen. So none is missed,
however close two roots are, and one that only touches 0 is none. Conditions without a series are looked at in
some places of the step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.taylor.isolation import begin_walk, next_part
from desire_tui.engine.passes.series.nodes import NEVER_INSIDE, SAMPLED
from desire_tui.engine.runtime.moments.blocks import any_rises, has_doubt, keep_arms
from desire_tui.engine.runtime.moments.locate import begin_at_left, clear_doubt, go_to, keep, locate

if TYPE_CHECKING:
    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.runtime.moments.memory import Moments

PLACES_OF_SERIES = 64
"""So many places of a step are looked at for conditions without a series: steps of series are long."""


def look_along_series(s: Taylor, m: Moments, t0: float, t1: float) -> int:
    """Find the first event in the last step of rule 17; results as of `locate.look_inside`."""
    if m.condition_count == 0 or not t1 > t0:
        return 0
    keep_arms(m)
    fallen = 0.0
    if has_doubt(m) != 0:
        fallen = clear_doubt(m, t0, t1) - t0
    m.left = 0.0
    m.right = t1 - t0
    found = 0
    for i in range(m.count):
        if m.period[i] == 0.0:
            m.fell[i] = -1.0
            start = 0.0
            if m.kept_doubt[i] != 0 and m.armed[i] != 0:
                start = fallen
            if m.arguments[i] == SAMPLED:
                found += look_at_places(m, i, t0, start, found)
            elif m.arguments[i] != NEVER_INSIDE:
                found += walk(s, m, i, t0, start, found)
    found += take_falls(m, t0)
    go_to(m, t0, t0 + m.right)
    if any_rises(m) == 0:
        return 0
    keep_left(m, t0)
    locate(m, t0, t0 + m.left, t0 + m.right)
    return 1


def keep_left(m: Moments, t0: float) -> None:
    """Take the conditions at `left` as those there; t and the states are those at `right` again."""
    begin_at_left(m)
    if m.left > 0.0:
        go_to(m, t0, t0 + m.left)
        any_rises(m)
        keep(m, 0)
        go_to(m, t0, t0 + m.right)
        any_rises(m)


def walk(s: Taylor, m: Moments, i: int, t0: float, start: float, found: int) -> int:
    """Go along the step, from `start` as far as `right`, to where condition i rises; 1: it does."""
    if begin_walk(s, m.arguments[i], 0.0, m.right) == 0:
        return 0
    below = start
    armed: int = m.armed[i]
    while next_part(s) != 0:
        if s.right > start:
            go_to(m, t0, t0 + s.right)
            any_rises(m)
            value: float = m.values[m.now + i]
            if value < 0.0:
                if armed == 0:
                    m.fell[i] = s.right
                armed = 1
                below = s.right
            elif value > 0.0 and armed != 0:
                bracket(m, below, s.right, found)
                return 1
    return 0


def look_at_places(m: Moments, i: int, t0: float, start: float, found: int) -> int:
    """Look at some places of the step, from `start` as far as `right`, for one where condition i has risen.

    1: it has.
    """
    before = start
    armed: int = m.armed[i]
    step: float = m.right
    for k in range(1, PLACES_OF_SERIES + 1):
        place = step * k / PLACES_OF_SERIES
        if place > start:
            go_to(m, t0, t0 + place)
            any_rises(m)
            value: float = m.values[m.now + i]
            if value < 0.0:
                if armed == 0:
                    m.fell[i] = place
                armed = 1
            elif value > 0.0 and armed != 0:
                bracket(m, before, place, found)
                return 1
            before = place
    return 0


def bracket(m: Moments, left: float, right: float, found: int) -> None:
    """Note where an event comes: what was found before may come in front of it, and is looked for as well."""
    m.left = min(m.left, left) if found != 0 else left
    m.right = right


def take_falls(m: Moments, t0: float) -> int:
    """Arm what falls in front of `right`, one after the other; 1: an event comes before all have fallen."""
    while True:
        first = -1
        for i in range(m.count):
            lies = m.period[i] == 0.0 and m.fell[i] >= 0.0 and m.fell[i] <= m.right
            if lies and (first < 0 or m.fell[i] < m.fell[first]):
                first = i
        if first < 0:
            return 0
        place: float = m.fell[first]
        go_to(m, t0, t0 + place)
        if any_rises(m) != 0:
            m.left = min(m.left, place)
            m.right = place
            return 1
        m.left = max(m.left, place)
        m.fell[first] = -1.0
        m.in_doubt[first] = 0
        m.armed[first] = 1
        m.before[first] = m.values[m.now + first]
