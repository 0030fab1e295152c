"""The beginning: from the states alone to a first step [cvInitialSetup, cvHin]."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from desire_tui.engine.integration.bdf.memory import EPSILON, GAVE_UP, NO_DERIVATIVES

if TYPE_CHECKING:
    from desire_tui.engine.integration.bdf.memory import Bdf

_RATIO_FIRST = 10_000.0  # [eta_max_fs]: the first step was a guess


def restart(s: Bdf, t: float, h_first: float) -> None:
    """Forget the history; the next step begins at t from the states in `y` [CVodeReInit]."""
    for i in range(s.n):
        s.z[i] = s.y[i]
    s.t = t
    s.h_first = h_first
    s.steps = 0
    s.failed_tests = 0
    s.failed_corrections = 0
    s.order = 1
    s.order_next = 1
    s.order_last = 0
    s.wait = 2
    s.ratio_most = _RATIO_FIRST
    s.h_last = 0.0
    s.tq5_kept = 0.0
    s.l_order = 0
    s.rate = 1.0
    s.doubt = 0


def start(s: Bdf, t_stop: float) -> int:
    """Find derivatives and size of the first step [cvInitialSetup and CVode's first call]."""
    n, z, y = s.n, s.z, s.y
    s.weigh(s.problem, z, s.weights)
    for i in range(n):
        y[i] = z[i]
    flag = s.evaluate(s.problem, s.t, y, s.derivatives)
    if flag != 0:
        return NO_DERIVATIVES if flag > 0 else GAVE_UP
    for i in range(n):
        z[n + i] = s.derivatives[i]
    s.h = s.h_first
    if s.h == 0.0:
        guess_first(s, t_stop)
    if s.h_most > 0.0 and abs(s.h) > s.h_most:
        s.h *= s.h_most / abs(s.h)
    if (s.t + s.h - t_stop) * s.h > 0.0:
        s.h = (t_stop - s.t) * (1.0 - 4.0 * EPSILON)
    s.h_scale = s.h
    s.h_next = s.h
    for i in range(n):
        z[n + i] *= s.h
    return 0


def guess_first(s: Bdf, t_stop: float) -> None:
    """Choose h so that h²/2 times the second derivative has size 1 [cvHin]; row 1 holds the derivatives."""
    n, z, y, w, f = s.n, s.z, s.y, s.weights, s.derivatives
    span = abs(t_stop - s.t)
    least = 100.0 * EPSILON * max(abs(s.t), abs(t_stop))
    most = 0.1 * span
    for i in range(n):
        most_here = (0.1 * abs(z[i]) + 1.0 / w[i]) / max(abs(z[n + i]), 1e-300)
        most = min(most, most_here)
    h = sqrt(least * most)
    if t_stop < s.t:
        h = -h
    s.h = h
    if most < least:
        return
    tries = 0
    found = abs(h)
    while tries < 4:
        tries += 1
        flag = 1
        smaller = 0
        while flag != 0 and smaller < 4:
            smaller += 1
            for i in range(n):
                y[i] = z[i] + h * z[n + i]
            flag = s.evaluate(s.problem, s.t + h, y, f)
            if flag < 0:
                return
            if flag > 0:
                h *= 0.2
        if flag != 0:
            break
        total = 0.0
        for i in range(n):
            part = (f[i] - z[n + i]) / h * w[i]
            total += part * part
        second = sqrt(total / n)
        found = sqrt(abs(h) * most)
        if second * most * most > 2.0:
            found = sqrt(2.0 / second)
        change = found / abs(h)
        if change > 0.5 and change < 2.0:
            break
        if tries > 1 and change > 2.0:
            found = abs(h)
            break
        h = found if t_stop > s.t else -found
    found = min(max(0.5 * found, least), most)
    s.h = found if t_stop > s.t else -found
