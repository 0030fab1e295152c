"""The explicit rules against exact solutions: order, closed formulas, error estimates."""

import math

import numpy as np
import pytest

from tests.codegen.conftest import run

ORDERS = {1: 2, 2: 1, 3: 4, 5: 2}


def final(rule, dt, equations, start, t_max=1.0):
    made = run(
        f"irule {rule} | {start}\nTMAX = {t_max} | DT = {dt} | NN = 2\ndrun\nDYNAMIC\n{equations}\ndispt x\n"
    )
    return made.scalar("x")


@pytest.mark.parametrize("rule", ORDERS)
def test_convergence_order(rule):
    """x' = -x + sin t, x(0) = 1: smooth, and t stands on the right, so wrong stage times show."""
    exact = 1.5 * math.exp(-1) + (math.sin(1) - math.cos(1)) / 2
    steps = np.array([0.04, 0.02, 0.01, 0.005])
    errors = [abs(final(rule, dt, "d/dt x = sin(t) - x", "x = 1") - exact) for dt in steps]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert abs(orders[-1] - ORDERS[rule]) < 0.1


@pytest.mark.parametrize(("rule", "terms"), [(1, 2), (2, 1), (3, 4), (5, 2)])
def test_growth_over_ten_steps_is_the_truncated_exponential(rule, terms):
    h = 0.1
    factor = sum((-h) ** k / math.factorial(k) for k in range(terms + 1))
    assert final(rule, h, "d/dt x = -x", "x = 1") == pytest.approx(factor**10, rel=1e-14)


def test_rk4_is_exact_for_cubics():
    assert final(3, 0.25, "d/dt x = 4*t^3 - 3*t^2", "x = 0", 2.0) == pytest.approx(2.0**4 - 2.0**3, rel=1e-14)


@pytest.mark.parametrize(
    ("rule", "growth", "estimate"),
    [
        # x' = -x from 1: k1 = -1, and so on by hand with h = DT
        (4, lambda h: 1 - h + h**2 / 2 - h**3 / 6 + h**4 / 24, lambda h: h**3 / 6 - h**4 / 24),
        (7, lambda h: 1 - h + h**2 / 2, lambda h: h**2 / 2),
        (8, lambda h: 1 - h + h**2 / 2 - h**3 / 6, lambda h: h**3 / 3),
    ],
)
def test_variable_step_accepts_up_to_its_estimate(rule, growth, estimate):
    """One step of h = 0.2; ERMAX a little above or below the relative estimate est/(1 + 1) decides."""
    h = 0.2
    limit = estimate(h) / 2
    text = (
        f"irule {rule} | x = 1 | TMAX = {h} | DT = {h} | NN = 2 | DTMIN = 0.001 | ERMIN = 0\n"
        "ERMAX = {ermax}\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    )
    whole = run(text.format(ermax=limit * (1 + 1e-9)))
    assert (whole.record.steps, whole.record.rejected) == (1, 0)
    assert whole.scalar("x") == pytest.approx(growth(h), rel=1e-14)
    halved = run(text.format(ermax=limit * (1 - 1e-9)))
    assert (halved.record.steps, halved.record.rejected) == (2, 1)
    assert halved.scalar("x") == pytest.approx(growth(h / 2) ** 2, rel=1e-14)


@pytest.mark.parametrize(("checkn", "rejected"), [(1, 0), (2, 1)])
def test_checkn_looks_at_one_state_and_absolutely(checkn, rejected):
    """Rule 7, x' = 0 and y' = -y from 100: the estimate of y is 100·h²/2, relative 100/101 of h²/2."""
    h = 0.1
    made = run(
        f"irule 7 | x = 1 | y = 100 | TMAX = {h} | DT = {h} | NN = 2 | DTMIN = 0.001 | ERMIN = 0 | CHECKN = {checkn}\n"
        "ERMAX = 0.4\ndrun\nDYNAMIC\nd/dt x = 0\nd/dt y = -y\ndispt x, y\n"
    )
    assert made.record.rejected == rejected


def test_steps_double_while_the_estimate_is_small_but_not_beyond_dtmax():
    made = run(
        "irule 4 | x = 1 | TMAX = 16 | DT = 0.125 | NN = 2 | DTMAX = 1 | ERMAX = 1 | ERMIN = 0.5\n"
        "drun\nDYNAMIC\nd/dt x = -0.001*x\ndispt x\n"
    )
    # 1/8 + 1/4 + 1/2, then steps of 1 and a shortened last one
    assert made.record.steps == 3 + 15 + 1
    assert made.record.dt_most == 1.0
    assert made.record.dt_least == pytest.approx(0.125)
    assert made.record.end_time == 16.0


@pytest.mark.parametrize("rule", [4, 7, 8])
def test_variable_steps_end_on_communication_points(rule):
    made = run(
        f"irule {rule} | x = 1 | TMAX = 3 | DT = 0.01 | NN = 8 | ERMAX = 1.0E-04\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    )
    assert made.rows[:, 0].tolist() == [k * (3 / 7) for k in range(8)]
    np.testing.assert_allclose(made.rows[:, 1], np.exp(-made.rows[:, 0]), rtol=5e-3)


@pytest.mark.parametrize("rule", [2, 3, 5])
def test_the_program_may_change_dt(rule):
    """DT doubles at t = 1; exact for x' = 1, and the sampled times show the steps."""
    made = run(
        f"n = 0 | irule {rule} | x = 0 | TMAX = 3 | DT = 0.25 | NN = 4\ndrun\nDYNAMIC\nd/dt x = 1\nstep\n"
        "DT = 0.25 + 0.25*swtch(t - 0.99)\nn = n + 1\ndispt x, n\n"
    )
    assert made.rows[:, 0].tolist() == [0, 1, 2, 3]
    assert made.rows[:, 1].tolist() == [0, 1, 2, 3]
    assert made.record.steps == 4 + 2 + 2
