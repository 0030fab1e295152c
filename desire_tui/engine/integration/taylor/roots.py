"""Where a mode switches in a step: the first root of a polynomial, however close to others.

A step's polynomial of a mode's argument is looked at over ever smaller parts of the step by Descartes' rule
of signs (Vincent, Collins and Akritas): a part is left alone where it has no root, taken where it has one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.located import has_switched, locate, resolution
from desire_tui.engine.integration.switching.mathematics import floor
from desire_tui.engine.integration.taylor.memory import HALVES_MOST, LEAST_PART
from desire_tui.engine.lowered.switching import Threshold

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.switching.memory import Watch
    from desire_tui.engine.integration.taylor.memory import Taylor


def look_along(s: Taylor, w: Watch, t0: float, t1: float) -> Int32:
    """Find the first switching in the last step; results as of `switching.watch.look_back`."""
    values: Reals = w.values
    found = 0
    looked = 0
    falls = 0
    left = 0.0
    right = t1 - t0
    for i in range(w.count):
        if s.arguments[2 * i] < 0:
            continue
        frozen: float = values[w.frozen + i]
        is_fall = w.rising[i] != 0 and frozen > 0.0
        for side in range(2):
            edge = edge_of(w.thresholds[i], s.coefficients[s.arguments[2 * i]], side)
            after = 0.0
            while find_root(s, i, edge, right, after):
                looked = 1
                there: float = s.right
                if is_fall == 0:
                    w.place(w.owner, t0 + there)
                    if has_switched(w) == 0:
                        after = there
                        continue
                found = 1
                falls = is_fall
                left = s.left
                right = there
                break
    if found == 0:
        return 0 if looked != 0 or (w.found != 0 and w.last <= t1) else -1
    if falls != 0:  # a `term` that has fired and may do so again
        w.place(w.owner, t0 + right)
    else:
        locate(w, t0 + left, t0 + right, resolution(t0, t1))
    return 1


def edge_of(threshold: int, argument: float, side: int) -> float:
    """Return where a mode switches next: below its argument (side 0), above it (side 1)."""
    if threshold == Threshold.ZERO:
        return 0.0
    if threshold == Threshold.UNIT:
        return 1.0 if side == 1 else -1.0
    if threshold == Threshold.HALF:
        return floor(argument - 0.5) + 0.5 + side
    return floor(argument) + side


def find_root(s: Taylor, mode: int, edge: float, h: float, after: float) -> int:
    """Find the first part of a step of h, behind `after`, in which a mode's argument reaches an edge.

    Whether there is one; its ends, from the step's start, are then `left` and `right`.
    """
    n: int = s.order
    place: int = s.arguments[2 * mode]
    apart: int = s.arguments[2 * mode + 1]
    whole: Reals = s.work
    power = 1.0
    size = 0.0
    for k in range(n + 1):
        whole[k] = s.coefficients[place + k * apart] * power
        power *= h
        if k > 0:
            size += abs(whole[k])
    whole[0] -= edge
    if abs(whole[0]) > size or not size > 0.0:
        return 0
    if whole[0] == 0.0 and after == 0.0:  # it begins on its edge, and may leave that at once
        s.left = 0.0
        s.right = LEAST_PART * h
        return 1
    level = 0
    low = 0.0
    width = 1.0
    while True:
        if (low + width) * h > after:
            signs = sign_changes(s, low, width)
            if signs == 1 or (signs > 1 and level == HALVES_MOST):
                s.left = low * h
                s.right = (low + width) * h
                return 1
            if signs > 1:
                level += 1
                width *= 0.5
                s.halves[level] = 0
                continue
        low += width
        while level > 0 and s.halves[level] == 1:
            level -= 1
            width *= 2.0
        if level == 0:
            return 0
        s.halves[level] = 1


def sign_changes(s: Taylor, low: float, width: float) -> int:
    """Return how many roots the polynomial in `work` has at most between `low` and `low` + `width`.

    By Descartes' rule: 0 and 1 are exact, more may be too many.
    """
    n: int = s.order
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
    changes = 0
    last = 0.0
    for k in range(n + 1):
        if turned[k] != 0.0:
            if turned[k] * last < 0.0:
                changes += 1
            last = 1.0 if turned[k] > 0.0 else -1.0
    return changes
