"""Size and order of the next step [cvPrepareNextStep]."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from desire_tui.engine.integration.bdf.memory import ORDER_MOST
from desire_tui.engine.integration.bdf.newton import size

if TYPE_CHECKING:
    from desire_tui.engine.integration.bdf.memory import Bdf

_RATIO_WORTH_WHILE = 1.5  # [eta_max_fx]
_BIAS_DOWN, _BIAS_SAME, _BIAS_UP = 6.0, 6.0, 10.0  # [BIAS1, BIAS2, BIAS3]
_ADDED = 1e-6  # [ADDON]


def expected(error: float, order: int) -> float:
    """Return the ratio by which a step of this order should change to pass, cautiously."""
    ratio: float = 1.0 / ((_BIAS_SAME * error) ** (1.0 / (order + 1)) + _ADDED)
    return ratio


def choose(s: Bdf, error: float) -> None:
    """Choose size and order of the next step [cvPrepareNextStep, cvChooseEta]."""
    q = s.order
    s.order_next = q
    if s.ratio_most == 1.0:  # it has just failed: not larger at once
        s.wait = max(s.wait, 2)
        s.h_next = s.h
        s.ratio = 1.0
        return
    same = growth(_BIAS_SAME * error, q + 1)
    if s.wait != 0:
        settle(s, same)
        return
    s.wait = 2
    down = 0.0
    up = 0.0
    if q > 1:
        down = growth(_BIAS_DOWN * size(s, q) * s.tq[1], q)
    if q != ORDER_MOST and s.tq5_kept != 0.0:
        up = growth(_BIAS_UP * rise(s) * s.tq[3], q + 2)
    best = max(down, same, up)
    if best < _RATIO_WORTH_WHILE:
        settle(s, best)
        return
    if best != same:
        if best == down:
            s.order_next = q - 1
        else:
            s.order_next = q + 1
            keep_correction(s)
    settle(s, best)


def growth(error: float, root: int) -> float:
    """Return the ratio by which a step may grow; 1 in place of one that would not be worth while.

    A root costs as much as all else in the choice: most need not be taken.
    """
    bound = 1.0
    for _ in range(root):
        bound *= 1.0 / _RATIO_WORTH_WHILE
    if error > bound:
        return 1.0
    ratio: float = 1.0 / (error ** (1.0 / root) + _ADDED)
    return ratio


def rise(s: Bdf) -> float:
    """Return the size of the change of the correction, an estimate for the next order [cvComputeEtaqp1]."""
    n, z, w, correction = s.n, s.z, s.weights, s.correction
    power = 1.0
    for _ in range(s.order + 1):
        power *= s.h / s.tau[2]
    quotient = s.tq[5] / s.tq5_kept * power
    total = 0.0
    for i in range(n):
        part = (correction[i] - quotient * z[ORDER_MOST * n + i]) * w[i]
        total += part * part
    return sqrt(total / n)


def settle(s: Bdf, ratio: float) -> None:
    """Bound the growth; a small one is not worth it [cvSetEta]."""
    if ratio < _RATIO_WORTH_WHILE:
        s.ratio = 1.0
        s.h_next = s.h
        s.order_next = s.order
        return
    s.ratio = min(ratio, s.ratio_most)
    if s.h_most > 0.0:
        s.ratio /= max(1.0, abs(s.h) / s.h_most * s.ratio)
    s.h_next = s.h * s.ratio


def keep_correction(s: Bdf) -> None:
    """Store the last correction in the history's spare row."""
    for i in range(s.n):
        s.z[ORDER_MOST * s.n + i] = s.correction[i]
