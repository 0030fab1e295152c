"""A step of series ends where a square root comes to 0, in plain Python.

The series of a root goes on below 0 where its radicand only touches 0: sqrt((1 - t/2)²) becomes 1 - t/2,
which no square root is. With `d/dt y = -sqrt(y)` an empty tank would fill again. Behind the place there is no
solution, or another one; the steps that follow get nowhere, and the run says so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.taylor.memory import Taylor

_PLACES = 16
"""Parts of a step at whose ends a root that may vanish is looked at."""


def before_zero(s: Taylor, h: float) -> float:
    """Return `h`, or how far the step may go until the first square root is 0."""
    for k in range(s.root_count):
        place = s.roots[3 * k]
        apart = s.roots[3 * k + 1]
        for i in range(s.roots[3 * k + 2]):
            if may_vanish(s, place + i, apart, h) != 0:
                h = first_zero(s, place + i, apart, h)
    return h


def may_vanish(s: Taylor, place: int, apart: int, h: float) -> int:
    """Whether all coefficients but the first could together outweigh it within h."""
    c: Reals = s.coefficients
    square = h * h
    one = 0.0
    other = 0.0
    j = s.order
    while j >= 2:  # odd and even powers apart: half as long a wait
        one = one * square + abs(c[place + j * apart])
        other = other * square + abs(c[place + (j - 1) * apart])
        j -= 2
    if j == 1:  # an odd order: `one` has the odd powers from h³ on, `other` the even ones from h²
        return not (one * square + abs(c[place + apart])) * h + other * square < c[place]
    return not one * square + other * h < c[place]


def first_zero(s: Taylor, place: int, apart: int, h: float) -> float:
    """Return the last place before a root's series falls below 0, `h` if it does not."""
    before = 0.0
    for k in range(1, _PLACES + 1):
        behind = h * k / _PLACES
        if value(s, place, apart, behind) < 0.0:
            middle = before + 0.5 * (behind - before)
            while middle > before and middle < behind:
                if value(s, place, apart, middle) < 0.0:
                    behind = middle
                else:
                    before = middle
                middle = before + 0.5 * (behind - before)
            return before
        before = behind
    return h


def value(s: Taylor, place: int, apart: int, h: float) -> float:
    """Return a series' sum at h behind the step's start."""
    c: Reals = s.coefficients
    total: float = c[place + s.order * apart]
    for down in range(1, s.order + 1):
        total = total * h + c[place + (s.order - down) * apart]
    return total
