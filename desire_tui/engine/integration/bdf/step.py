"""One step: predict, correct, test, choose size and order of the next [cvStep, CVode]."""

from __future__ import annotations

from math import sqrt

from desire_tui.engine.integration.bdf.coefficients import change_order, rescale, set_coefficients
from desire_tui.engine.integration.bdf.memory import ORDER_MOST, Bdf
from desire_tui.engine.integration.bdf.newton import (
    BAD_CORRECTION,
    BAD_TEST,
    NOTHING,
    SETUP_FAILED,
    correct,
    size,
)

DONE, AT_STOP = 0, 1
TOO_ACCURATE, TEST_FAILED, NOT_CONVERGED, GAVE_UP, NO_DERIVATIVES = -2, -3, -4, -8, -10
"""CVODE's flags. More accuracy is wished for than doubles have; the error test, the corrector failed too
often; a callback gave up; derivatives were not finite."""

TRIES_MOST = 40
"""Failed tests in one step. CVODE's own 7 to 10 are too few where the program's DT is a wild guess."""
_EPSILON = 2.220446049250313e-16
_RATIO_FIRST = 10_000.0  # [eta_max_fs]: the first step was a guess
_RATIO_MOST = 10.0  # [eta_max_es, eta_max_gs]
_RATIO_LEAST_AFTER_TEST = 0.1  # [eta_min_ef]
_RATIO_MOST_AFTER_TESTS = 0.2  # [eta_max_ef], from the second failed test on
_RATIO_AFTER_CORRECTOR = 0.25  # [eta_cf]
_RATIO_WORTH_WHILE = 1.5  # [eta_max_fx]
_TESTS_BEFORE_LOWER_ORDER = 3  # [MXNEF1]
_WAIT_LONG = 10  # [LONG_WAIT]
_BIAS_DOWN, _BIAS_SAME, _BIAS_UP = 6.0, 6.0, 10.0  # [BIAS1, BIAS2, BIAS3]
_ADDED = 1e-6  # [ADDON]


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


def advance(s: Bdf, t_stop: float) -> int:
    """Take one step, never beyond `t_stop`; `y` and `t` are then the solution [CVode, CV_ONE_STEP]."""
    n, z, y = s.n, s.z, s.y
    if s.steps == 0:
        flag = start(s, t_stop)
        if flag != 0:
            return flag
    elif near(s, t_stop):
        s.t = t_stop
        return AT_STOP
    elif (s.t + s.h_next - t_stop) * s.h > 0.0:
        s.h_next = (t_stop - s.t) * (1.0 - 4.0 * _EPSILON)
        s.ratio = s.h_next / s.h
    if s.steps > 0:
        s.weigh(s.problem, z, s.weights)
    if size(s, 0) * _EPSILON > 1.0:
        return TOO_ACCURATE
    flag = step(s, t_stop)
    for i in range(n):
        y[i] = z[i]
    if flag != 0:
        return flag
    if near(s, t_stop):
        return AT_STOP
    return DONE


def near(s: Bdf, t_stop: float) -> int:
    """Whether t is t_stop but for rounding."""
    is_near: int = abs(s.t - t_stop) <= 100.0 * _EPSILON * (abs(s.t) + abs(s.h))
    return is_near


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
        s.h = (t_stop - s.t) * (1.0 - 4.0 * _EPSILON)
    s.h_scale = s.h
    s.h_next = s.h
    for i in range(n):
        z[n + i] *= s.h
    return 0


def guess_first(s: Bdf, t_stop: float) -> None:
    """Choose h so that h²/2 times the second derivative has size 1 [cvHin]; row 1 holds the derivatives."""
    n, z, y, w, f = s.n, s.z, s.y, s.weights, s.derivatives
    span = abs(t_stop - s.t)
    least = 100.0 * _EPSILON * max(abs(s.t), abs(t_stop))
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


def step(s: Bdf, t_stop: float) -> int:
    """Try until a step passes the error test [cvStep]."""
    n, z, correction = s.n, s.z, s.correction
    t_before = s.t
    met = NOTHING
    tests = 0
    corrections = 0
    if s.steps > 0 and s.h_next != s.h:
        if s.order_next != s.order:
            change_order(s, s.order_next - s.order)
        rescale(s)
    while True:
        predict(s, t_stop)
        set_coefficients(s)
        flag = correct(s, met)
        if flag != 0:
            back(s, t_before)
            s.failed_corrections += 1
            if flag < 0:
                return flag if flag == SETUP_FAILED else GAVE_UP
            corrections += 1
            s.ratio_most = 1.0
            if corrections == TRIES_MOST:
                return NOT_CONVERGED
            met = BAD_CORRECTION
            s.ratio = _RATIO_AFTER_CORRECTOR
            rescale(s)
            continue
        error = s.norm * s.tq[2]
        if error <= 1.0:
            break
        tests += 1
        s.failed_tests += 1
        met = BAD_TEST
        back(s, t_before)
        if tests == TRIES_MOST:
            return TEST_FAILED
        s.ratio_most = 1.0
        flag = retreat(s, tests, error)
        if flag != 0:
            return flag
    s.steps += 1
    s.h_last = s.h
    s.order_last = s.order
    for down in range(s.order - 1):
        s.tau[s.order - down] = s.tau[s.order - down - 1]
    if s.order == 1 and s.steps > 1:
        s.tau[2] = s.tau[1]
    s.tau[1] = s.h
    for j in range(s.order + 1):
        part = s.l[j]
        for i in range(n):
            z[j * n + i] += part * correction[i]
    s.wait -= 1
    if s.wait == 1 and s.order != ORDER_MOST:
        keep_correction(s)
        s.tq5_kept = s.tq[5]
    choose(s, error)
    s.ratio_most = _RATIO_MOST
    return 0


def predict(s: Bdf, t_stop: float) -> None:
    """Go on along the history's polynomial: times Pascal's triangle [cvPredict]."""
    n, z, q = s.n, s.z, s.order
    s.t += s.h
    if (s.t - t_stop) * s.h > 0.0:
        s.t = t_stop
    for k in range(q):
        for down in range(q - k):
            j = q - down
            for i in range(n):
                z[(j - 1) * n + i] += z[j * n + i]


def back(s: Bdf, t_before: float) -> None:
    """Undo a prediction [cvRestore]."""
    n, z, q = s.n, s.z, s.order
    s.t = t_before
    for k in range(q):
        for down in range(q - k):
            j = q - down
            for i in range(n):
                z[(j - 1) * n + i] -= z[j * n + i]


def retreat(s: Bdf, tests: int, error: float) -> int:
    """After a failed test: a smaller step, then order 1 less, at last from scratch [cvDoErrorTest]."""
    n, z = s.n, s.z
    if tests <= _TESTS_BEFORE_LOWER_ORDER:
        ratio = 1.0 / ((_BIAS_SAME * error) ** (1.0 / (s.order + 1)) + _ADDED)
        s.ratio = max(_RATIO_LEAST_AFTER_TEST, ratio)
        if tests >= 2:
            s.ratio = min(s.ratio, _RATIO_MOST_AFTER_TESTS)
        rescale(s)
        return 0
    s.ratio = _RATIO_LEAST_AFTER_TEST
    if s.order > 1:
        change_order(s, -1)
        rescale(s)
        return 0
    s.h *= s.ratio
    s.h_next = s.h
    s.h_scale = s.h
    s.wait = _WAIT_LONG
    for i in range(n):
        s.y[i] = z[i]
    flag = s.evaluate(s.problem, s.t, s.y, s.derivatives)
    if flag != 0:
        return NO_DERIVATIVES if flag > 0 else GAVE_UP
    for i in range(n):
        z[n + i] = s.h * s.derivatives[i]
    return 0


def keep_correction(s: Bdf) -> None:
    """Store the last correction in the history's spare row."""
    for i in range(s.n):
        s.z[ORDER_MOST * s.n + i] = s.correction[i]


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
