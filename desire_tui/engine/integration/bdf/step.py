"""One step: predict, correct, test [CVode, cvStep]."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.bdf.choice import choose, expected, keep_correction
from desire_tui.engine.integration.bdf.coefficients import change_order, rescale, set_coefficients
from desire_tui.engine.integration.bdf.memory import (
    EPSILON,
    GAVE_UP,
    NO_DERIVATIVES,
    NOT_CONVERGED,
    ORDER_MOST,
    SETUP_FAILED,
    TEST_FAILED,
    TOO_ACCURATE,
)
from desire_tui.engine.integration.bdf.newton import BAD_CORRECTION, BAD_TEST, NOTHING, correct, size
from desire_tui.engine.integration.bdf.start import start

if TYPE_CHECKING:
    from desire_tui.engine.integration.bdf.memory import Bdf
    from desire_tui.engine.integration.plain_types import Reals

DONE, AT_STOP = 0, 1
TRIES_MOST = 40
"""Failed tests in one step. CVODE's own 7 to 10 are too few where the program's DT is a wild guess."""
_RATIO_MOST = 10.0  # [eta_max_es, eta_max_gs]
_RATIO_LEAST_AFTER_TEST = 0.1  # [eta_min_ef]
_RATIO_MOST_AFTER_TESTS = 0.2  # [eta_max_ef], from the second failed test on
_RATIO_AFTER_CORRECTOR = 0.25  # [eta_cf]
_TESTS_BEFORE_LOWER_ORDER = 3  # [MXNEF1]
_WAIT_LONG = 10  # [LONG_WAIT]


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
        s.h_next = (t_stop - s.t) * (1.0 - 4.0 * EPSILON)
        s.ratio = s.h_next / s.h
    if s.steps > 0:
        s.weigh(s.problem, z, s.weights)
    if size(s, 0) * EPSILON > 1.0:
        return TOO_ACCURATE
    flag = step(s, t_stop)
    for i in range(n):
        y[i] = z[i]
    if flag != 0:
        return flag
    if near(s, t_stop):
        return AT_STOP
    return DONE


def put_inside(s: Bdf, t: float, out: Reals) -> None:
    """Write the solution inside the last step to `out` [CVodeGetDky]."""
    part = (t - s.t) / s.h
    for i in range(s.n):
        x = s.z[s.order * s.n + i]
        for down in range(s.order):
            x = x * part + s.z[(s.order - 1 - down) * s.n + i]
        out[i] = x


def near(s: Bdf, t_stop: float) -> int:
    """Whether t is t_stop but for rounding."""
    is_near: int = abs(s.t - t_stop) <= 100.0 * EPSILON * (abs(s.t) + abs(s.h))
    return is_near


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
    s.doubt -= s.doubt > 0
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
        s.ratio = max(_RATIO_LEAST_AFTER_TEST, expected(error, s.order))
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
