"""The parts of a step in which a polynomial has a root, one after the other, however close they are.

Ever smaller parts of the step are looked at by Descartes' rule of signs (Vincent, Collins and Akritas): a
part is left alone where it has no root, and told where it has one. Its ends belong to it: a root that falls
between two parts is found in both, so that the signs on either side of it are seen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.taylor.memory import HALVES_MOST

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.taylor.memory import Taylor


def begin_walk(s: Taylor, argument: int, edge: float, h: float) -> int:
    """Prepare to go along a step of h, to where an argument's series reaches an edge; 0: it never does."""
    n = s.order - 1  # the last coefficient is computed of states alone
    place: int = s.arguments[2 * argument]
    if place < 0:
        return 0
    apart: int = s.arguments[2 * argument + 1]
    whole: Reals = s.work
    power = 1.0
    size = 0.0
    for k in range(n + 1):
        whole[k] = s.coefficients[place + k * apart] * power
        power *= h
        if k > 0:
            size += abs(whole[k])
    whole[0] -= edge
    s.walk_h = h
    s.walk_low = 0.0
    s.walk_width = 1.0
    s.walk_level = 0
    return 1 if abs(whole[0]) <= size and size > 0.0 else 0


def next_part(s: Taylor) -> int:
    """Go to the next part with a root, from `left` to `right` behind the step's start; 0: there is none."""
    level: int = s.walk_level
    low: float = s.walk_low
    width: float = s.walk_width
    found = 0
    while found == 0 and level >= 0:
        roots = root_count(s, low, width)
        if roots > 1 and level < HALVES_MOST:
            level += 1
            width *= 0.5
            s.halves[level] = 0
            continue
        if roots > 0:
            found = 1
            s.left = low * s.walk_h
            s.right = (low + width) * s.walk_h
        low += width
        while level > 0 and s.halves[level] == 1:
            level -= 1
            width *= 2.0
        if level == 0:
            level = -1
        else:
            s.halves[level] = 1
    s.walk_level = level
    s.walk_low = low
    s.walk_width = width
    return found


def root_count(s: Taylor, low: float, width: float) -> int:
    """Return how many roots the polynomial has at most from `low` to `low` + `width`: 0 and 1 are exact."""
    n = s.order - 1
    whole: Reals = s.work
    part: Reals = s.part
    for k in range(n + 1):
        part[k] = whole[k]
    for i in range(n):
        for down in range(n - i):
            j = n - 1 - down
            part[j] += low * part[j + 1]
    power = 1.0
    size = 0.0
    for k in range(n + 1):
        part[k] *= power
        power *= width
        if k > 0:
            size += abs(part[k])
    if abs(part[0]) > size:
        return 0
    turned: Reals = s.turned
    for k in range(n + 1):
        turned[k] = part[n - k]
    for i in range(n):
        for down in range(n - i):
            j = n - 1 - down
            turned[j] += turned[j + 1]
    count = 0
    if part[0] == 0.0:
        count += 1
    if turned[0] == 0.0:
        count += 1
    last = 0.0
    for k in range(n + 1):
        if turned[k] != 0.0:
            if turned[k] * last < 0.0:
                count += 1
            last = 1.0 if turned[k] > 0.0 else -1.0
    return count
