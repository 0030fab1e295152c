"""The corrector: Newton's iteration with a Jacobian and factors that are kept as long as they serve."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from desire_tui.engine.integration.bdf.memory import SETUP_FAILED
from desire_tui.engine.integration.problem import (
    DOUBT_FAILURE,
    DOUBT_FROM,
    DOUBT_MOST,
    JACOBIAN_SERVES_STEPS,
)

if TYPE_CHECKING:
    from desire_tui.engine.integration.bdf.memory import Bdf
    from desire_tui.engine.integration.plain_types import Ints, Reals

TOO_SLOW = 1
"""The corrector did not converge; so is a derivative that a callback could not give. Try a smaller step."""
NOTHING, BAD_TEST, BAD_CORRECTION = 0, 1, 2
"""What this step has met so far."""

_ITERATIONS_MOST = 3  # [NLS_MAXCOR]
_DIVERGING = 2.0  # [RDIV]
_RATE_FORGETS = 0.3  # [CRDOWN]
_FACTORS_SERVE_STEPS = 20  # [MSBP]
_GAMMA_FACTORS = 0.3  # [DGMAX_LSETUP]
_GAMMA_JACOBIAN = 0.2  # [DGMAX_JBAD]


def size(s: Bdf, place: int) -> float:
    """Return the weighted root mean square of row `place` of the history."""
    n, z, w = s.n, s.z, s.weights
    total = 0.0
    for i in range(n):
        part = z[place * n + i] * w[i]
        total += part * part
    return sqrt(total / n)


def correct(s: Bdf, met: int) -> int:
    """Solve for the step's end [cvNls, SUNNonlinSolSolve_Newton]; `met`: what this step has met so far."""
    if met == BAD_CORRECTION:
        s.doubt = min(s.doubt + DOUBT_FAILURE, DOUBT_MOST)
    old = s.steps == 0 or s.steps >= s.factored_at + _FACTORS_SERVE_STEPS
    setup = met != NOTHING or old or abs(s.gamma / s.gamma_factored - 1.0) > _GAMMA_FACTORS
    serve = 1 if s.doubt > DOUBT_FROM else JACOBIAN_SERVES_STEPS
    old = s.steps == 0 or s.steps >= s.jacobian_at + serve
    renew = met == BAD_CORRECTION or old
    n, z, y, correction = s.n, s.z, s.y, s.correction
    while True:
        for i in range(n):
            correction[i] = 0.0
            y[i] = z[i]
        flag: int = s.evaluate(s.problem, s.t, y, s.derivatives)
        if flag != 0:
            return flag
        current = 0
        if setup:
            flag = prepare(s, renew)
            current = renew
        if flag == 0:
            flag = iterate(s)
        if flag <= 0 or current:
            return flag
        setup = True  # the matrix was an old one: once more, with new factors or all new
        renew = abs(s.gamma / s.gamma_factored - 1.0) < _GAMMA_JACOBIAN


def prepare(s: Bdf, renew: int) -> int:
    """Factor I − gamma·J [cvLsSetup]."""
    n, jacobian, factors = s.n, s.jacobian, s.factors
    if renew:
        for i in range(n * n):
            jacobian[i] = 0.0
        flag: int = s.fill(s.problem, s.t, s.y, s.derivatives, jacobian, s.spare, s.spare2)
        if flag != 0:
            return flag if flag > 0 else SETUP_FAILED
        s.jacobian_at = s.steps
    for i in range(n * n):
        factors[i] = -s.gamma * jacobian[i]
    for i in range(n):
        factors[i * n + i] += 1.0
    s.gamma_factored = s.gamma
    s.rate = 1.0
    s.factored_at = s.steps
    return factor(n, factors, s.swaps)


def iterate(s: Bdf) -> int:
    """Newton's iteration from the prediction, whose derivatives are known [cvNlsConvTest]."""
    n, z, y, w, f = s.n, s.z, s.y, s.weights, s.derivatives
    correction, change, gamma = s.correction, s.change, s.gamma
    ratio = gamma / s.gamma_factored
    scale = 2.0 / (1.0 + ratio)  # makes up for factors of another gamma
    row = gamma / s.h  # 1/l[1]
    before = 0.0
    count = 0
    while True:
        for i in range(n):
            change[i] = gamma * f[i] - row * z[n + i] - correction[i]
        solve(n, s.factors, s.swaps, change)
        total = 0.0
        for i in range(n):
            step = change[i] * scale
            correction[i] += step
            y[i] = z[i] + correction[i]
            part = step * w[i]
            total += part * part
        now = sqrt(total / n)
        if count > 0:
            s.rate = max(_RATE_FORGETS * s.rate, now / before)
        if now * min(1.0, s.rate) <= s.tq[4]:
            total = 0.0
            for i in range(n):
                part = correction[i] * w[i]
                total += part * part
            s.norm = sqrt(total / n)
            return 0
        count += 1
        if count >= _ITERATIONS_MOST or (count > 1 and now > _DIVERGING * before):
            return TOO_SLOW
        before = now
        flag: int = s.evaluate(s.problem, s.t, y, f)
        if flag != 0:
            return flag


def factor(n: int, a: Reals, swaps: Ints) -> int:
    """Factor in place with partial pivoting, column after column; TOO_SLOW if singular.

    The diagonal holds the pivots' inverses.
    """
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(a[k * n + i]) > abs(a[k * n + pivot]):
                pivot = i
        swaps[k] = pivot
        if a[k * n + pivot] == 0.0:
            return TOO_SLOW
        if pivot != k:
            for j in range(n):
                held = a[j * n + k]
                a[j * n + k] = a[j * n + pivot]
                a[j * n + pivot] = held
        inverse = 1.0 / a[k * n + k]
        a[k * n + k] = inverse
        for i in range(k + 1, n):
            a[k * n + i] *= inverse
        for j in range(k + 1, n):
            part = a[j * n + k]
            if part != 0.0:
                for i in range(k + 1, n):
                    a[j * n + i] -= part * a[k * n + i]
    return 0


def solve(n: int, a: Reals, swaps: Ints, b: Reals) -> None:
    """Solve with the factors, in place."""
    for k in range(n):
        pivot = swaps[k]
        if pivot != k:
            held = b[k]
            b[k] = b[pivot]
            b[pivot] = held
    for k in range(n):
        part = b[k]
        for i in range(k + 1, n):
            b[i] -= part * a[k * n + i]
    for down in range(n):
        k = n - 1 - down
        b[k] *= a[k * n + k]
        part = b[k]
        for i in range(k):
            b[i] -= part * a[k * n + i]
