"""One step: the series at its start, as far as they may be trusted, summed up."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from desire_tui.engine.integration.problem import FLOOR
from desire_tui.engine.integration.switching.mathematics import exp, fused, log
from desire_tui.engine.integration.taylor.memory import GAVE_UP, NO_COEFFICIENTS
from desire_tui.engine.integration.taylor.shared_steps import move, scan
from desire_tui.engine.integration.taylor.square_roots import before_zero

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.taylor.memory import Taylor

DONE, AT_STOP = 0, 1
_LARGEST = 1.7976931348623157e308

_LEAST_PART, _TRIES, _MARGIN = 1.0 / 64.0, 20, 0.9
"""Arguments make no step shorter than this part of it: some, as sqrt(x) near 0, would never let it pass."""


def restart(s: Taylor, t: float) -> None:
    """Begin anew from the states in `y`."""
    most: float = s.most
    for i in range(s.n):
        s.rest[i] = 0.0
        most = max(most, abs(s.y[i]))
    s.most = most
    s.t = t
    s.t_base = t
    s.h_last = 0.0


def advance(s: Taylor, t_stop: float) -> int:
    """Take one step, never beyond `t_stop`; `y` and `t` are then the solution. Return a flag."""
    t0 = s.t
    if s.share == 0:  # else `scan` does it
        for i in range(s.n):
            s.base[i] = s.y[i]
            s.base_rest[i] = s.rest[i]
    if s.expand(s.problem, t0, s.y) != 0:
        return GAVE_UP
    s.t_base = t0
    h = reach(s)
    if not h > 0.0:
        find_worst(s)
        return NO_COEFFICIENTS
    if s.h_most > 0.0:
        h = min(h, s.h_most)
    if s.root_count != 0:
        h = before_zero(s, min(h, t_stop - t0))
    flag = DONE
    s.h_last = h
    t1 = t0 + h
    if t1 >= t_stop:
        t1 = t_stop
        flag = AT_STOP
    h = t1 - t0
    shorter = reach_of_arguments(s, h)
    if shorter < h:
        h = shorter
        t1 = t0 + h
        flag = DONE
    s.t = t1
    if h > 0.0:
        s.h_last = h
    s.steps += 1
    add_up(s, h)
    return flag


def reach(s: Taylor) -> float:
    """Return how far the series may be trusted: from the last two coefficients. -1: one is not finite."""
    order = s.order
    total = 0.0
    most: float = s.most
    floor = max(most * FLOOR, s.absolute)
    before = 0.0
    last = 0.0
    if s.share != 0:
        s.floor = floor
        total = scan(s)
        most = max(most, s.found[0])
        before = s.found[1]
        last = s.found[2]
        s.worst = s.found_states[0]
    for k in range(s.piece_count if s.share == 0 else 0):
        first = s.pieces[4 * k]
        place = s.pieces[4 * k + 2] + order * s.pieces[4 * k + 3]
        down = place - s.pieces[4 * k + 3]
        for i in range(s.pieces[4 * k + 1]):
            size = max(s.largest[first + i], abs(s.y[first + i]))
            s.largest[first + i] = size
            most = max(most, size)
            if size == 0.0:
                size = 1.0
            size = 1.0 / max(size, floor)
            a = abs(s.coefficients[down + i]) * size
            b = abs(s.coefficients[place + i]) * size
            total += a + b
            before = max(before, a)
            if b > last:
                last = b
                s.worst = first + i
    s.most = most
    if not total <= _LARGEST:
        return -1.0
    if before == 0.0 and last == 0.0:
        return inf
    radius = 0.0  # its reciprocal's logarithm
    if last > 0.0:
        radius = log(last) * s.per_order
    if before > 0.0:
        other = log(before) * s.per_order_before
        radius = max(radius, other) if last > 0.0 else other
    return exp(s.log_part - radius)


def reach_of_arguments(s: Taylor, h: float) -> float:
    """Return how much of a step of h the polynomials of what switches, and of events' conditions, hold for.

    They decide by their roots alone, which places are looked at: they may be less exact than the states, but
    cos(5·x) needs shorter steps than x does.
    """
    order = s.order - 1  # the last coefficient is computed of states alone
    least = h * _LEAST_PART
    for i in range(s.argument_total):
        place = s.arguments[2 * i]
        apart = s.arguments[2 * i + 1]
        tries = 0
        while place >= 0 and tries < _TRIES and h > least:
            tries += 1
            power = 1.0
            size = 0.0
            tail = 0.0
            for k in range(order + 1):
                part = abs(s.coefficients[place + k * apart]) * power
                size += part
                if k >= order - 1:
                    tail += part
                power *= h
            allowed = s.argument_error * size
            if tail <= allowed or not tail <= _LARGEST:  # inf or nan: it is not smooth here
                break
            h *= _MARGIN * exp(log(allowed / tail) / (order - 1)) if allowed > 0.0 else _MARGIN
    return max(h, least)


def find_worst(s: Taylor) -> None:
    """Name a state with a coefficient that is not finite."""
    s.worst = 0
    order = s.order
    for k in range(s.piece_count):
        place = s.pieces[4 * k + 2] + order * s.pieces[4 * k + 3]
        down = place - s.pieces[4 * k + 3]
        for i in range(s.pieces[4 * k + 1]):
            if not abs(s.coefficients[down + i]) + abs(s.coefficients[place + i]) <= _LARGEST:
                s.worst = s.pieces[4 * k] + i


def add_up(s: Taylor, h: float) -> None:
    """Put the solution at the step's end into `y`, what it is rounded by into `rest` (Kahan; Knuth's sum).

    So errors of rounding grow with the square root of the number of steps and not faster (Brouwer's law).
    """
    if s.share != 0:
        move(s, h)
        return
    sum_up(s, h, s.y)
    for i in range(s.n):
        x: float = s.base[i]
        change = s.y[i] * h + s.base_rest[i]
        moved = x + change
        part = moved - x
        s.y[i] = moved
        s.rest[i] = (x - (moved - part)) + (change - part)


def put_inside(s: Taylor, t: float, out: Reals) -> None:
    """Write the solution inside the last step to `out`."""
    h = t - s.t_base
    sum_up(s, h, out)
    for i in range(s.n):
        out[i] = s.base[i] + (out[i] * h + s.base_rest[i])


def sum_up(s: Taylor, h: float, out: Reals) -> None:
    """Write what the series change by in h, divided by h; odd and even powers apart: half as long a wait."""
    c: Reals = s.coefficients
    square = h * h
    for k in range(s.piece_count):
        first = s.pieces[4 * k]
        count = s.pieces[4 * k + 1]
        base = s.pieces[4 * k + 2]
        apart = s.pieces[4 * k + 3]
        j = s.order
        if count == 1:
            one = 0.0
            other = 0.0
            while j >= 2:
                one = fused(one, square, c[base + j * apart])
                other = fused(other, square, c[base + (j - 1) * apart])
                j -= 2
            if j == 1:
                out[first] = fused(h, other, fused(one, square, c[base + apart]))
            else:
                out[first] = fused(h, one, other)
        else:
            for i in range(count):
                out[first + i] = c[base + j * apart + i]
            while j >= 2:
                j -= 1
                for i in range(count):
                    out[first + i] = fused(out[first + i], h, c[base + j * apart + i])
