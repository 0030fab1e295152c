"""Integration rules against closed formulas."""

from __future__ import annotations

import math

import pytest

from tests.reference.runs import run, value

GROWTH = {
    1: lambda h: 1 - h + h**2 / 2,
    2: lambda h: 1 - h,
    3: lambda h: 1 - h + h**2 / 2 - h**3 / 6 + h**4 / 24,
    5: lambda h: 1 - h + h**2 / 2,
}


@pytest.mark.parametrize("rule", GROWTH)
def test_decay_is_the_rules_own_polynomial(rule):
    session = run(f"irule {rule}\nTMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x")
    (record,) = session.runs
    assert record.count == 11
    for point in range(11):
        assert record.values("x")[point] == pytest.approx(GROWTH[rule](0.1) ** point, rel=1e-14)
        assert record.t[point] == pytest.approx(0.1 * point, abs=1e-15)


@pytest.mark.parametrize(("rule", "order"), [(1, 2), (2, 1), (3, 4), (5, 2), (4, 4), (7, 2), (8, 3)])
def test_order_of_convergence(rule, order):
    """x' = x cos t: x = exp(sin t). Variable rules are held at fixed steps by wide limits."""
    errors = []
    for n in (20, 40):
        session = run(
            f"irule {rule}\nTMAX = 2 | NN = {n + 1} | DT = TMAX/(NN - 1) | x = 1 | ERMAX = 1e9 | ERMIN = 1e-99\n"
            "drun\nDYNAMIC\nd/dt x = x*cos(t)"
        )
        errors.append(abs(value(session, "x") - math.exp(math.sin(2))))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.25)


def test_variable_rules_keep_the_tolerance_and_end_on_points():
    for rule in (4, 7, 8):
        session = run(
            f"irule {rule}\nTMAX = 3 | NN = 8 | DT = 0.3 | ERMAX = 1e-5 | DTMIN = 1e-7 | x = 1\n"
            "drun\nDYNAMIC\nd/dt x = -10*(x - cos(t))\ndispt x"
        )
        (record,) = session.runs
        assert record.rejected > 0
        assert [float(t) for t in record.t] == pytest.approx([3 * k / 7 for k in range(8)], rel=1e-14)
        exact = [(100 * math.cos(t) + 10 * math.sin(t) + math.exp(-10 * t)) / 101 for t in record.t]
        assert list(record.values("x")) == pytest.approx(exact, abs=1e-3)


def test_the_step_doubles_up_to_its_limit():
    session = run(
        "irule 4\nTMAX = 1 | NN = 3 | DT = 0.001 | DTMAX = 0.064 | x = 1\ndrun\nDYNAMIC\nd/dt x = -0.001*x"
    )
    (record,) = session.runs
    assert record.dt_most == pytest.approx(0.064)
    assert value(session, "DT") == pytest.approx(0.064)


def test_a_step_shortened_for_a_point_does_not_double():
    """DT = 0.3 with points every 0.5: 0.3, 0.2 (cut), then 0.3 or 0.6 must not come from the cut step."""
    session = run(
        "irule 7\nTMAX = 1 | NN = 3 | DT = 0.3 | DTMAX = 0.3 | ERMAX = 1 | x = 1\ndrun\nDYNAMIC\nd/dt x = 0*x"
    )
    (record,) = session.runs
    assert record.steps == 4
    # with a difference below ERMIN the whole steps double, the cut ones do not; q, which derivatives read,
    # changes at the points: steps end there though DTMAX is above COMINT
    session = run(
        "irule 7\nTMAX = 1 | NN = 3 | DT = 0.3 | DTMAX = 9 | x = 1 | q = 0\ndrun\n"
        "DYNAMIC\nd/dt x = 0*q\nSAMPLE 1\nq = q + 1"
    )
    (record,) = session.runs
    # 0.3 (whole: DT 0.6), 0.2 cut, 0.5 cut
    assert record.steps == 3
    assert value(session, "DT") == pytest.approx(0.6)


def test_deadlock_is_error_94():
    from desire_tui.engine.diagnostics import DesireError

    with pytest.raises(DesireError) as caught:
        run(
            "irule 4\nTMAX = 1 | NN = 3 | DT = 0.01 | ERMAX = 1e-9 | x = 1\ndrun\nDYNAMIC\nd/dt x = 1E+4*sin(1E+6*t)"
        )
    assert caught.value.diagnostics[0].code == 94


def test_time_does_not_drift():
    session = run("TMAX = 1000 | DT = 0.1 | NN = 11 | x = 0\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x")
    assert session.runs[0].t[-1] == 10000 * 0.1


def test_samples_lie_at_step_ends():
    session = run("TMAX = 1 | NN = 3 | DT = 0.3\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x")
    assert list(session.runs[0].t) == pytest.approx([0, 0.6, 1.2])


def test_dt_may_change_under_rule_5():
    body = "irule 5\nTMAX = 1 | NN = 2 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = 1\nn = n + 0\nstep\nDT = 0.05\nn = n + 1"
    session = run(body)
    assert session.runs[0].steps == 20
    assert value(session, "x") == pytest.approx(1, rel=1e-14)


def test_a_nan_names_the_state():
    from desire_tui.engine.diagnostics import DesireError

    with pytest.raises(DesireError) as caught:
        run(
            "TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = 1\ny = sqrt(0.45 - x)\nd/dt z = y\ndispt x, y"
        )
    problem = caught.value.diagnostics[0]
    assert problem.facts["name"] == "z"  # y alone would leave a gap in its curve
    with pytest.raises(DesireError) as caught:
        run("TMAX = 9 | DT = 0.01 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = x*x")
    assert caught.value.diagnostics[0].facts["name"] == "x"
