"""What run loops call: how far a step may go, what has switched in it, what follows from that."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.hermite import inside
from desire_tui.engine.integration.switching.ahead import begin_ahead, inputs_changed, look_ahead
from desire_tui.engine.integration.switching.clearance import begin_box, forget_box, renew_box, stays_in_box
from desire_tui.engine.integration.switching.located import has_switched, locate, resolution
from desire_tui.engine.integration.switching.margins import are_far, begin_margins
from desire_tui.engine.integration.switching.memory import CHATTERS, JUMPED
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.switching.memory import Watch

_PLACES = 4
"""A step is looked at in so many places, its end included."""
_CHATTER = 200
"""So many switchings within a part of the run that `span` names end it."""


def begin(w: Watch, t: float) -> Int32:
    """Prepare a run that starts at t with the states in the values."""
    begin_ahead(w, t)
    w.switches = 0
    w.switches_since = t
    w.switched = 0
    if w.count != 0:
        w.modes(w.memory, w.f1_address)
        accept_modes(w)
        begin_margins(w)
        begin_box(w)
    return 0


def limit(w: Watch, t: float, wish: float) -> float:
    """Return how far towards `wish` a step from t may go: to the last number before a switch of t."""
    if w.instruction_count == 0:
        return wish
    if inputs_changed(w):
        begin_ahead(w, t)
    if w.found == 0 and w.clear_to < wish:
        look_ahead(w, t, wish)
    if w.found != 0 and w.last < wish:
        last: float = w.last
        return last
    return wish


def look(w: Watch, t0: float, t1: float) -> Int32:
    """Find the first switching in a step from t0 to t1, whose states are in the values.

    1: t and the states in the values are now those just behind it. 0: nothing has switched, and t and the
    states are as they were.
    """
    if w.count == 0 or not t1 > t0:
        return 0
    left = t0
    right = t1
    found = 0
    for k in range(1, _PLACES):
        if found == 0:
            middle = t0 + (t1 - t0) * k / _PLACES
            w.place(w.owner, middle)
            if has_switched(w):
                found = 1
                right = middle
            else:
                left = middle
    if found == 0:
        w.place(w.owner, t1)
        if has_switched(w) == 0:
            return 0
    locate(w, left, right, resolution(t0, t1))
    return 1


def look_back(w: Watch, t0: float, t1: float) -> Int32:
    """Look at a step from t0 to t1, whose states are in the values, of a solver with an interpolant.

    1: as `look`. 0: no mode has switched, but it is time to `settle`, and the values are those near t1.
    -1: nothing has switched at all, and the values are as they were.
    """
    result = 0 if w.found != 0 and w.last <= t1 else -1
    if w.count == 0 or not t1 > t0:
        return result
    if w.box_count != 0:
        if inputs_changed(w):
            begin_ahead(w, t0)
            forget_box(w)
        if stays_in_box(w, t1 - t0):
            return result
    w.modes(w.memory, w.f1_address)
    if w.strayed != 0:
        begin_margins(w)
    if are_far(w, t1 - t0) == 0:
        result = look(w, t0, t1)
        if result != 0:
            return result
    if w.box_count != 0:
        w.box_wait -= 1
        if w.box_wait <= 0:
            renew_box(w, t1, t1 - t0)
    return result


def accept_modes(w: Watch) -> None:
    """Put into force what the modes are now."""
    values: Reals = w.values
    frozen: int = w.frozen
    live: int = w.live
    count: int = w.count
    for i in range(count):
        values[frozen + i] = values[live + i]


def settle(w: Watch, t_next: float) -> Int32:
    """Take up the modes where a step has ended; cross a switch of t there, but not beyond `t_next`.

    The result's bits: `memory.JUMPED`, `memory.CHATTERS`. t in the values is then behind the switch.
    """
    t: float = w.values[T]
    result = 0
    while w.found != 0 and w.last <= t and w.next <= t_next:
        result += cross(w)
    return take_modes(w, result)


def depart(w: Watch) -> Int32:
    """Cross the switches of t at a communication point, which shows what was before them."""
    t: float = w.values[T]
    result = 0
    while w.found != 0 and w.last <= t:
        result += cross(w)
        t = w.values[T]
    return take_modes(w, result)


def cross(w: Watch) -> int:
    """Go to the other side of the switch of t that was found; whether it is a jump."""
    w.found = 0
    w.values[T] = max(w.next, w.values[T])
    if w.is_jump != 0:
        w.switched = -1 - w.culprit
    jumps: int = w.is_jump
    return jumps


def take_modes(w: Watch, jumps: int) -> int:
    """Compute the modes anew and put them into force; return the bits."""
    result = JUMPED if jumps != 0 else 0
    if w.count != 0:
        w.modes(w.memory, w.f1_address)
        for i in range(w.count):
            live: float = w.values[w.live + i]
            frozen: float = w.values[w.frozen + i]
            w.values[w.frozen + i] = live
            if w.rising[i] == 0 and (live > frozen or live < frozen):
                w.switched = i
                result = JUMPED
    if result == 0:
        return 0
    begin_margins(w)
    forget_box(w)
    return result + chatter(w)


def chatter(w: Watch) -> int:
    """Count a switching; CHATTERS if very many came in a very short time."""
    w.switches += 1
    if w.switches < _CHATTER:
        return 0
    t: float = w.values[T]
    gone = t - w.switches_since
    w.switches = 0
    w.switches_since = t
    return CHATTERS if gone < w.span else 0


def place_on_step(w: Watch, t: float) -> int:
    """Put t and the step's polynomial into the values: for rules that have no interpolant of their own.

    Through the states at both ends and the derivatives at the first or, once those are known, at both.
    """
    s = (t - w.t0) / w.h
    w.values[T] = t
    for k in range(w.range_count):
        slot = w.ranges[3 * k]
        first = w.ranges[3 * k + 1]
        for i in range(w.ranges[3 * k + 2]):
            j = first + i
            x0: float = w.x0[j]
            x1: float = w.x1[j]
            rise = x1 - x0
            slope: float = w.h * w.f0[j]
            x = x0 + s * slope + s * s * (rise - slope)
            if w.is_cubic != 0:
                x = inside(s, x0, x1, slope, w.h * w.f1[j])
            if s >= 1.0:
                x = x1
            w.values[slot + i] = x
    return 0


def look_at_step(w: Watch, t0: float, t1: float) -> Int32:
    """Find the first switching in a step of a rule without interpolant: `x0`, `f0` are those at t0."""
    if w.count == 0:
        return 0
    w.t0 = t0
    w.h = t1 - t0
    w.is_cubic = 0
    for k in range(w.range_count):
        for i in range(w.ranges[3 * k + 2]):
            w.x1[w.ranges[3 * k + 1] + i] = w.values[w.ranges[3 * k] + i]
    if look(w, t0, t1) == 0:
        return 0
    place_on_step(w, t1)
    derivatives_at_end(w)
    w.is_cubic = 1
    return look(w, t0, t1)


def follow(w: Watch, t0: float, t1: float, t_next: float) -> Int32:
    """Look at a step that has ended, and take up what has switched in it; -1: nothing, else bits as `settle`.

    Where something has, t and the states in the values are other ones than before.
    """
    if look_at_step(w, t0, t1) == 0 and (w.found == 0 or w.last > t1):
        accept_modes(w)
        if w.box_count != 0 and w.box_wait <= 0:
            if inputs_changed(w):
                begin_ahead(w, t1)
                forget_box(w)
            renew_box(w, t1, t1 - t0)
        return -1
    return settle(w, t_next)


def derivatives_at_end(w: Watch) -> None:
    """Compute `f1` from the t and states in the values."""
    w.derivative(w.memory, w.f1_address)
