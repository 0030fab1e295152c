"""A box of t and states in which no mode switches: inside it a step's modes need not be computed.

Bounds of every mode's jump over the box (interval arithmetic, Moore 1966, rounded outward) tell that it is
the same number all over the box, however curved its argument is. Switches that never come near then cost a
step a few comparisons for each state that they depend on. Where a step leaves the box, modes are looked at as
ever; once in a while the box is made anew around the present state. In plain Python.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.bounds import over_registers
from desire_tui.engine.integration.switching.operations import Operation
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.switching.memory import Watch

_TIMES = 3.0
"""As `margins`: a state that is so many times as far from the box's sides as it has moved in this step, and
would have moved at the rate of the step before, has not been there."""
_LASTS = 2000.0
"""Steps for which a box must do to be worth its making, which takes as long as some hundred steps of the
smallest models."""
_PAUSE_LEAST, _PAUSE_MOST = 64, 8192
"""Steps without a box behind one that did not last so long."""
_TRIALS = 60
_FAILURES = 3
"""A side is placed to an eighth of its distance from the state."""
_FAR = 1e150


def begin_box(w: Watch) -> None:
    """Start a run without a box."""
    w.box_pause = 0
    w.box_wait = _PAUSE_LEAST
    w.box_since = w.values[T]
    for i in range(w.box_count):
        w.box_moves[i] = inf
        w.box_scale[i] = 0.0
    w.box_h = 1.0
    forget_box(w)


def forget_box(w: Watch) -> None:
    """Let nothing be inside: a mode has switched, or what modes are made of has changed."""
    w.box_known = 0
    for i in range(w.box_count):
        w.box_low[i] = inf
        w.box_high[i] = -inf


def stays_in_box(w: Watch, h: float) -> int:
    """Whether a step of h, of a solver with an interpolant of its own, has been inside all the time."""
    values: Reals = w.values
    low: Reals = w.box_low
    high: Reals = w.box_high
    last: Reals = w.box_last
    moves: Reals = w.box_moves
    scale: Reals = w.box_scale
    times = _TIMES * (h / w.box_h)
    w.box_h = h
    outside = 0
    for i in range(w.box_count):
        x: float = values[w.box_slots[i]]
        move = abs(x - last[i])
        room = _TIMES * move + times * moves[i]
        last[i] = x
        moves[i] = move
        scale[i] = max(scale[i], abs(x))
        outside += not x - room >= low[i]
        outside += not x + room <= high[i]
    if outside == 0:
        w.strayed = 1
    return outside == 0


def renew_box(w: Watch, t: float, h: float) -> None:
    """Make a box around the t and states in the values, where a step of h has ended and no mode has switched.

    The old one is extended if that is possible: it holds what the solution comes back to.
    """
    short = t - w.box_since < _LASTS * h
    w.box_since = t
    w.box_pause = min(2 * w.box_pause + _PAUSE_LEAST, _PAUSE_MOST) if short else 0
    w.box_wait = w.box_pause
    for i in range(w.box_count):
        w.box_scale[i] = max(w.box_scale[i], abs(w.values[w.box_slots[i]]))
    if extended(w) == 0:
        for i in range(w.box_count):
            x: float = w.values[w.box_slots[i]]
            w.box_low[i] = x
            w.box_high[i] = x
        widen(w)
    push_sides(w)
    w.box_known = 1


def extended(w: Watch) -> int:
    """Whether the box that is known can be made to hold the present state; if so, it does."""
    if w.box_known == 0:
        return 0
    for i in range(w.box_count):
        x: float = w.values[w.box_slots[i]]
        w.box_low[i] = min(w.box_low[i], x)
        w.box_high[i] = max(w.box_high[i], x)
    return is_clear(w)


def widen(w: Watch) -> None:
    """Widen a box that is a point on all sides, each in proportion to its state."""
    by = 1.0
    grown = 0
    for _ in range(_TRIALS):
        for i in range(w.box_count):
            w.reach_low[i] = w.box_low[i]
            w.reach_high[i] = w.box_high[i]
            w.box_low[i] -= by * unit(w, i)
            w.box_high[i] += by * unit(w, i)
        if is_clear(w):
            grown = 1
            by *= 2.0
            continue
        for i in range(w.box_count):
            w.box_low[i] = w.reach_low[i]
            w.box_high[i] = w.reach_high[i]
        if grown != 0:
            break
        by *= 0.25


def push_sides(w: Watch) -> None:
    """Move the box's sides outward as far as they go: in turn, so that none takes all the room there is."""
    for i in range(w.box_count):
        x: float = w.values[w.box_slots[i]]
        w.reach_low[i] = max(x - w.box_low[i], unit(w, i))
        w.reach_high[i] = max(w.box_high[i] - x, unit(w, i))
    failures = 0
    for _ in range(_TRIALS):
        grown = 0
        for i in range(w.box_count):
            grown += push(w, w.box_low, w.reach_low, i, -1.0)
            grown += push(w, w.box_high, w.reach_high, i, 1.0)
        failures = 0 if grown != 0 else failures + 1
        if failures == _FAILURES:
            break


def push(w: Watch, sides: Reals, reaches: Reals, i: int, direction: float) -> int:
    """Move a side by its reach, if that is possible; whether it was. The next reach is larger, else less."""
    here: float = sides[i]
    if not abs(here) < _FAR:
        return 0
    sides[i] = here + direction * reaches[i]
    if is_clear(w):
        reaches[i] *= 2.0
        return 1
    sides[i] = here
    reaches[i] *= 0.25
    return 0


def unit(w: Watch, i: int) -> float:
    """Return a small distance, measured by the largest size that a state has had."""
    scale: float = w.box_scale[i]
    return 1e-3 * scale + 1e-9


def is_clear(w: Watch) -> int:
    """Whether no mode can switch anywhere in the box."""
    for i in range(w.box_count):
        w.low[w.box_registers[i]] = w.box_low[i]
        w.high[w.box_registers[i]] = w.box_high[i]
    return over_registers(w, w.box_instruction_count, Operation.KINK)
