"""Whether a mode has switched, and where in an interval of t: what all that watch a step's inside share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.halving import RESOLUTION

if TYPE_CHECKING:
    from desire_tui.engine.integration.switching.memory import Watch


def has_switched(w: Watch) -> int:
    """Whether a mode is another one at the t and states in the values."""
    w.modes(w.memory, w.f1_address)
    for i in range(w.count):
        live: float = w.values[w.live + i]
        frozen: float = w.values[w.frozen + i]
        if live > frozen or (live < frozen and w.rising[i] == 0):
            w.switched = i
            return 1
    return 0


def locate(w: Watch, left: float, right: float, least: float) -> None:
    """Put t and the states just behind the first switching between `left`, where none is, and `right`."""
    before = left
    behind = right
    while behind - before > least:
        middle = before + 0.5 * (behind - before)
        if not (middle > before and middle < behind):
            break
        w.place(w.owner, middle)
        if has_switched(w):
            behind = middle
        else:
            before = middle
    w.place(w.owner, behind)
    has_switched(w)


def resolution(t0: float, t1: float) -> float:
    """Return how far apart two times in a step may be to count as one."""
    return RESOLUTION * max(abs(t0), abs(t1))
