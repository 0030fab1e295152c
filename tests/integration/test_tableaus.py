"""The rules' rows: consistency, order conditions, observed orders, and test differences on hand-computed steps."""

from __future__ import annotations

from fractions import Fraction
from math import log2

import numpy as np
import pytest

from desire_tui.engine.integration.rules import RULES as RULES_TABLE
from desire_tui.engine.integration.tableaus import TABLEAUS

RULES = sorted(TABLEAUS)


def step(rule, f, t, x, dt):
    """One step with exact arithmetic if x, t and dt are Fractions; the new x and the test difference."""
    row = TABLEAUS[rule]
    k = []
    for c, a in zip(row.c, row.a, strict=True):
        k.append(f(t + c * dt, x + dt * sum((w * q for w, q in zip(a, k, strict=True)), start=Fraction(0))))
    moved = x + dt * sum((w * q for w, q in zip(row.b, k, strict=True)), start=Fraction(0))
    test = None
    if row.test is not None:
        test = dt * abs(sum((w * q for w, q in zip(row.test, k, strict=True)), start=Fraction(0)))
    return moved, test


def test_the_rules_are_the_explicit_ones():
    assert RULES == [1, 2, 3, 4, 5, 7, 8]
    assert [r for r in RULES if TABLEAUS[r].variable] == [4, 7, 8]
    assert [r for r in RULES if not TABLEAUS[r].rule.dt_may_change] == [1]


@pytest.mark.parametrize("rule", RULES)
def test_rows_are_consistent(rule):
    row = TABLEAUS[rule]
    assert row.rule is RULES_TABLE[rule]
    assert row.stages == row.rule.stages == len(row.c) == len(row.a) == len(row.b)
    assert [len(a) for a in row.a] == list(range(row.stages))
    assert [sum(a, start=Fraction(0)) for a in row.a] == list(row.c)
    assert sum(row.b) == 1
    if row.test is not None:
        assert len(row.test) == row.stages
        assert sum(row.test) == 0  # a constant derivative has no error


@pytest.mark.parametrize("rule", RULES)
def test_order_conditions(rule):
    row = TABLEAUS[rule]
    n = row.stages
    a = np.zeros((n, n), dtype=object)
    a[:] = Fraction(0)
    for i, entries in enumerate(row.a):
        a[i, : len(entries)] = entries
    b, c = np.array(row.b, dtype=object), np.array(row.c, dtype=object)
    conditions = {  # order: (elementary weight, its value); Butcher's trees up to order 4
        2: [(b @ c, Fraction(1, 2))],
        3: [(b @ c**2, Fraction(1, 3)), (b @ (a @ c), Fraction(1, 6))],
        4: [
            (b @ c**3, Fraction(1, 4)),
            ((b * c) @ (a @ c), Fraction(1, 8)),
            (b @ (a @ c**2), Fraction(1, 12)),
            (b @ (a @ (a @ c)), Fraction(1, 24)),
        ],
    }
    met = 1
    while met + 1 in conditions and all(got == want for got, want in conditions[met + 1]):
        met += 1
    assert met == row.rule.order


@pytest.mark.parametrize("rule", RULES)
def test_observed_order(rule):
    """dx/dt = −2·t·x, x = exp(−t²): halving DT divides the error by 2^order."""
    errors = []
    for steps in (64, 128):
        x, dt = 1.0, 1.0 / steps
        for i in range(steps):
            x, _ = step(rule, lambda t, x: -2.0 * t * x, i * dt, x, dt)
        errors.append(abs(x - np.exp(-1.0)))
    assert log2(errors[0] / errors[1]) == pytest.approx(TABLEAUS[rule].rule.order, abs=0.15)


def test_test_differences_by_hand():
    """dx/dt = x + t from x = 1 at t = 0 with DT = 1/2, worked out with fractions on paper.

    Rule 4: k1 = 1, k2 = 3/2, k3 = 13/8, k4 = 37/16; (1/12)·(1 − 6 + 13/4 + 37/16) = 9/192.
    Rule 7: k1 = 1, k2 = 2; (1/4)·1. Rule 8: k1 = 1, k2 = 3/2, k3 = 5/2; (1/6)·(1 + 5/2 − 3) = 1/12.
    """
    f, dt = (lambda t, x: x + t), Fraction(1, 2)
    one, zero = Fraction(1), Fraction(0)
    assert step(4, f, zero, one, dt)[1] == Fraction(9, 192)
    assert step(7, f, zero, one, dt)[1] == Fraction(1, 4)
    assert step(8, f, zero, one, dt)[1] == Fraction(1, 12)
    assert step(8, f, zero, one, dt)[0] == 1 + Fraction(19, 24)
