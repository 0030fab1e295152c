"""Coefficients of a step, of a change of its size, of a change of order: numbers only, no model.

Fixed leading coefficient BDF in Nordsieck form: Jackson and Sacks-Davis (ACM TOMS 6, 1980), as VODE (Brown,
Byrne, Hindmarsh, SIAM J. Sci. Stat. Comput. 10, 1989) and CVODE compute them.
"""

from __future__ import annotations

from desire_tui.engine.integration.bdf.memory import ORDER_MOST, Bdf


def set_coefficients(s: Bdf) -> None:
    """Set `l`, the tests' `tq` and gamma for order and step size [cvSetBDF, cvSetTqBDF]."""
    l, tau, tq, q, h = s.l, s.tau, s.tq, s.order, s.h  # noqa: E741 - the literature's letter
    equal = True
    for j in range(1, q):
        equal = equal and tau[j] == h
    if equal and s.l_order == q and s.l_h == h and s.wait != 1:
        return  # all steps that matter were equal, and are
    s.l_order = q if equal else 0
    s.l_h = h
    l[0] = 1.0
    l[1] = 1.0
    for i in range(2, q + 1):
        l[i] = 0.0
    inverse = 1.0
    inverse_last = 1.0
    alpha0 = -1.0
    alpha0_hat = -1.0
    reach = h
    if q > 1:
        for j in range(2, q):
            reach += tau[j - 1]
            inverse = h / reach
            alpha0 -= 1.0 / j
            for down in range(j):
                l[j - down] += l[j - down - 1] * inverse
        alpha0 -= 1.0 / q
        inverse_last = -l[1] - alpha0
        reach += tau[q - 1]
        inverse = h / reach
        alpha0_hat = -l[1] - inverse
        for down in range(q):
            l[q - down] += l[q - down - 1] * inverse_last
    a1 = 1.0 - alpha0_hat + alpha0
    a2 = 1.0 + q * a1
    tq[2] = abs(a1 / (alpha0 * a2))
    tq[5] = abs(a2 * inverse_last / (l[q] * inverse))
    if s.wait == 1:
        tq[1] = 1.0
        if q > 1:
            c = inverse_last / l[q]
            a3 = alpha0 + 1.0 / q
            a4 = alpha0_hat + inverse
            tq[1] = abs(c * (1.0 - a4 + a3) / a3)
        reach += tau[q]
        inverse = h / reach
        a5 = alpha0 - 1.0 / (q + 1)
        a6 = alpha0_hat - inverse
        tq[3] = abs((1.0 - a6 + a5) / a2 / (inverse * (q + 2) * a5))
    tq[4] = s.share / tq[2]
    s.gamma = h / l[1]
    if s.steps == 0:
        s.gamma_factored = s.gamma


def rescale(s: Bdf) -> None:
    """Take the step size times `ratio`: row j of the history times ratioʲ [cvRescale]."""
    n, z, ratio = s.n, s.z, s.ratio
    factor = ratio
    for j in range(1, s.order + 1):
        for i in range(n):
            z[j * n + i] *= factor
        factor *= ratio
    s.h = s.h_scale * ratio
    s.h_scale = s.h


def raise_order(s: Bdf) -> None:
    """Fill the row of the next order from the last correction [cvIncreaseBDF]."""
    n, z, l, q = s.n, s.z, s.l, s.order  # noqa: E741
    for i in range(ORDER_MOST + 1):
        l[i] = 0.0
    l[2] = 1.0
    alpha0 = -1.0
    alpha1 = 1.0
    product = 1.0
    xi_before = 1.0
    reach = s.h_scale
    for j in range(1, q):
        reach += s.tau[j + 1]
        xi = reach / s.h_scale
        product *= xi
        alpha0 -= 1.0 / (j + 1)
        alpha1 += 1.0 / xi
        for down in range(j + 1):
            i = j + 2 - down
            l[i] = l[i] * xi_before + l[i - 1]
        xi_before = xi
    a1 = (-alpha0 - alpha1) / product
    new = (q + 1) * n
    kept = ORDER_MOST * n
    for i in range(n):
        z[new + i] = a1 * z[kept + i]
    for j in range(2, q + 1):
        for i in range(n):
            z[j * n + i] += l[j] * z[new + i]


def lower_order(s: Bdf) -> None:
    """Take the highest row's part out of the others [cvDecreaseBDF]."""
    n, z, l, q = s.n, s.z, s.l, s.order  # noqa: E741
    for i in range(ORDER_MOST + 1):
        l[i] = 0.0
    l[2] = 1.0
    reach = 0.0
    for j in range(1, q - 1):
        reach += s.tau[j]
        xi = reach / s.h_scale
        for down in range(j + 1):
            i = j + 2 - down
            l[i] = l[i] * xi + l[i - 1]
    for j in range(2, q):
        for i in range(n):
            z[j * n + i] -= l[j] * z[q * n + i]


def change_order(s: Bdf, change: int) -> None:
    """Go one order up or down [cvAdjustOrder]; from 2 down nothing must be taken out."""
    s.l_order = 0  # `l` is used for other things here
    if change == 1:
        raise_order(s)
    if change == -1 and s.order > 2:
        lower_order(s)
    s.order += change
    s.wait = s.order + 1
