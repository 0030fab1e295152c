"""Rules 4, 7 and 8 with DTMAX above COMINT: steps go beyond communication points, samples are interpolated."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from desire_tui.engine.integration.tableaus import TABLEAUS
from tests.integration.stiff_programs import failure, run

RULES = (4, 7, 8)
BACKENDS = ("native", "reference")

ORBIT = """irule {rule} | TMAX = 8 | NN = {nn} | DT = 1/128 | ERMAX = {ermax} | {dtmax}
x = 0.7 | vy = sqrt(13/7)
drun
DYNAMIC
w = 1/(x^2 + y^2)^1.5
d/dt x = vx
d/dt y = vy
d/dt vx = -x*w
d/dt vy = -y*w
OUT
r = sqrt(x*x + y*y)
dispt x, y, r
"""


def orbit(rule, nn, *, dtmax="DTMAX = TMAX", ermax=1e-3, backend="native"):
    return run(ORBIT.format(rule=rule, nn=nn, dtmax=dtmax, ermax=ermax), backend)[0].runs[-1]


def samples(record):
    return record.rows[: record.count]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("rule", RULES)
def test_samples_cost_no_steps(rule, backend):
    """Steps, and what they lead to, are the same to the last bit with a thousand points as with two."""
    many, few = (orbit(rule, nn, backend=backend, ermax=1e-2) for nn in (1025, 2))
    assert (many.steps, many.rejected, many.dt_least, many.dt_most) == (
        few.steps, few.rejected, few.dt_least, few.dt_most
    )  # fmt: skip
    assert many.steps < 600
    assert many.count == 1025
    np.testing.assert_array_equal(samples(many)[:, 0], np.arange(1025) / 128)
    np.testing.assert_array_equal(samples(many)[-1], samples(few)[-1])
    assert many.derivative_calls == 1 + TABLEAUS[rule].stages * (many.steps + many.rejected) - many.rejected


@pytest.mark.parametrize("rule", RULES)
def test_the_same_bits(rule):
    native, reference = (orbit(rule, 301, backend=backend) for backend in BACKENDS)
    np.testing.assert_array_equal(samples(native), samples(reference))


@pytest.mark.parametrize("rule", RULES)
def test_order_of_samples(rule):
    """Halving all steps divides the largest error of the samples by two to the rule's order."""
    text = """irule {rule} | TMAX = 4 | NN = 1025 | DT = {h}/64 | DTMAX = {h} | ERMAX = 1e6 | ERMIN = 1e5
x = 1
drun
DYNAMIC
d/dt x = y
d/dt y = -x + exp(-t)
dispt x, y
"""
    errors = []
    for h in (0.125, 0.0625, 0.03125):
        record = run(text.format(rule=rule, h=h))[0].runs[-1]
        assert record.dt_most == h
        t, x, y = samples(record).T
        exact = 0.5 * (np.cos(t) + np.sin(t) + np.exp(-t))
        slope = 0.5 * (np.cos(t) - np.sin(t) - np.exp(-t))
        errors.append(max(np.abs(x - exact).max(), np.abs(y - slope).max()))
    for one, other in pairwise(errors):
        assert one / other == pytest.approx(2.0 ** TABLEAUS[rule].rule.order, rel=0.2)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("ermax", [1e-2, 1e-3])
def test_samples_keep_what_ermax_promises(rule, ermax):
    exact, free = orbit(17, 257, ermax=1e-13, dtmax="x = 0.7"), orbit(rule, 257, ermax=ermax)
    assert np.abs(samples(free) - samples(exact)).max() < 10 * ermax


POINTS = [
    "q = 0\nx = 1|d/dt x = -x + q\nSAMPLE 8\nq = 1 - q",
    "q = 0\nx = 1|d/dt x = -x + q\nstep\nq = swtch(x - 0.5)",
    "q = 0\nx = 1|d/dt x = -x\nOUT\nx = 0.99*x",
    "q = 0\nx = 1|d/dt x = -delay(x, 0.3)",
    "q = 0\nx = 1|DT = 0.125\nd/dt x = -x",
]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("model", POINTS)
def test_steps_end_where_points_change_what_they_integrate(model, backend):
    text = """irule 4 | TMAX = 4 | NN = 33 | DT = 1/32 | DTMAX = {dtmax} | ERMAX = 1e-3
{script}
drun
DYNAMIC
{equations}
dispt x
"""
    script, equations = model.split("|")
    wide, narrow = (
        run(text.format(dtmax=dtmax, script=script, equations=equations), backend)[0].runs[-1]
        for dtmax in ("TMAX", "TMAX/32")
    )
    np.testing.assert_array_equal(samples(wide), samples(narrow))
    assert wide.steps == narrow.steps


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("rule", RULES)
def test_switches_events_and_term_are_located(rule, backend):
    """A ball on a parabola, which a cubic is exactly: bounces at 1 and 3, a pulse of t between, `term` at 4."""
    text = """irule {rule} | TMAX = 40 | NN = 2561 | DT = 1/64 | DTMAX = 1 | ERMAX = 1
y = 5 | n = 0 | p = 0 | s = 0
drun
DYNAMIC
d/dt y = v
d/dt v = -10
d/dt p = swtch(t - 2.3) - swtch(t - 2.31)
d/dt s = swtch(v)
event -y
v = -v | n = n + 1
end event
term t - 4
dispt y, v, p, s
"""
    session, _ = run(text.format(rule=rule), backend)
    record = session.runs[-1]
    t, y, v, p, s = samples(record).T
    assert record.ended == "term"
    assert t[-1] == pytest.approx(4.0, abs=1e-9)
    assert session.values.cells[session.values.find("n").slot] == 2.0
    phase = np.mod(t + 1.0, 2.0) - 1.0
    inside = np.abs(np.mod(t, 2.0) - 1.0) > 1e-6
    assert y == pytest.approx(5.0 - 5.0 * phase**2, abs=1e-9)
    assert v[inside] == pytest.approx(-10.0 * phase[inside], abs=1e-9)
    assert p[-1] == pytest.approx(0.01, abs=1e-12)
    assert s[-1] == pytest.approx(2.0, abs=1e-9)  # rising from 1 to 2 and from 3 to 4
    assert record.steps < 150


FAULTS = {
    "deadlock": "d/dt x = 1E+4*sin(100*t)",
    "no number": "d/dt x = 1 - 2*sqrt(1.5 - t)\nd/dt z = 1",
}


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("model", FAULTS.values(), ids=FAULTS)
def test_runs_fail_as_they_do_with_steps_that_end_on_points(model, backend):
    text = """irule 4 | TMAX = 3 | NN = 31 | DT = 0.01 | DTMAX = {dtmax} | DTMIN = 0.001 | ERMAX = 1e-4
x = 1
drun
DYNAMIC
{model}
dispt x
"""
    (wide, first), (narrow, second) = (
        failure(text.format(dtmax=dtmax, model=model), backend) for dtmax in ("TMAX", "TMAX/30")
    )
    assert first.key == second.key
    assert first.facts.get("state") == second.facts.get("state")
    assert first.facts["t"] == pytest.approx(second.facts["t"], abs=0.1)
    counts = [session.runs[-1].count for session in (wide, narrow)]
    assert abs(counts[0] - counts[1]) <= 1


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_checked_state_and_the_next_run(backend):
    """CHECKN; the DT that a run has found is where the next one begins, as far as COMINT lets it."""
    text = """irule 4 | TMAX = 8 | NN = 65 | DT = 1/64 | DTMAX = TMAX | ERMAX = 1e-4 | CHECKN = 2
x = 1
drun
DYNAMIC
d/dt x = -x
u = 3
d/dt z = u/3
d/dt u = 2
dispt x, z
"""
    session, _ = run(text, backend)
    record = session.runs[-1]
    assert record.rejected == 0
    assert record.dt_most == 4.0  # 1/64, 1/32 … 2, 4 and a rest: z is integrated exactly
    assert samples(record)[:, 2] == pytest.approx(samples(record)[:, 0], abs=1e-12)
    assert session.values.cells[session.values.find("DT").slot] == 8.0
    session, _ = run(text.replace("drun\n", "drun\ndrun\n"), backend)
    assert session.runs[-1].dt_least == pytest.approx(0.125)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("rule", [4, 8])
def test_no_step_behind_an_event_passes_the_next(rule, backend):
    """A parabola has no error for these rules: steps as long as the run would let the ball through the floor."""
    text = """irule {rule} | TMAX = 200 | NN = 1001 | DT = 0.001 | DTMAX = {dtmax}
h = 50 | n = 0
drun
DYNAMIC
d/dt h = v
d/dt v = -9.81
event -h
v = -0.95*v | n = n + 1
end event
term n - 30.5
dispt h, v
"""
    (free, _), (ordinary, _) = (
        run(text.format(rule=rule, dtmax=dtmax), backend) for dtmax in ("TMAX", "TMAX/1000")
    )
    times = [session.runs[-1].rows[session.runs[-1].count - 1, 0] for session in (free, ordinary)]
    assert times[0] == pytest.approx(times[1], abs=1e-6)
    assert times[0] < 110.0
    assert free.runs[-1].steps < ordinary.runs[-1].steps / 2
