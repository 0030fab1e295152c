"""Where a mode switches in a step: the first root of its argument's polynomial, however close to others."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.located import has_switched, locate, resolution
from desire_tui.engine.integration.switching.mathematics import floor
from desire_tui.engine.integration.taylor.isolation import begin_walk, next_part
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
    left = 0.0
    right = t1 - t0
    for i in range(w.count):
        if s.arguments[2 * i] < 0:
            continue
        frozen: float = values[w.frozen + i]
        is_fall = w.rising[i] != 0 and frozen > 0.0
        sides = 1 if w.thresholds[i] == Threshold.ZERO else 2  # both edges are 0
        for side in range(sides):
            edge = edge_of(w.thresholds[i], s.coefficients[s.arguments[2 * i]], side)
            if begin_walk(s, i, edge, right) == 0:
                continue
            while next_part(s) != 0:
                looked = 1
                if is_fall == 0:
                    w.place(w.owner, t0 + s.right)
                    if has_switched(w) == 0:
                        continue
                # what was found before may lie in front of this part: it is looked for from there
                left = s.left if found == 0 else min(left, s.left)
                right = s.right
                found = 1
                break
    if found == 0:
        return 0 if looked != 0 or (w.found != 0 and w.last <= t1) else -1
    w.place(w.owner, t0 + right)
    if has_switched(w) != 0:  # else a `term` that has fired, and may do so again from here on
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
