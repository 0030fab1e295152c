"""Rules 9 … 16 under way: paused, resumed, ended, continued, ended by `term`; wrong settings of DT and ERMAX."""

from __future__ import annotations

import threading
from math import exp, inf, log, nan, sin

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import rules_of
from desire_tui.engine.session.session import Session
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept, failure, ran, value
from tests.runtime.test_run_control import PATIENCE

RULES = rules_of("multistep", "series")
MULTISTEP = rules_of("multistep")

MODEL = """irule {rule} | ERMAX = 1E-6 | x = 1 | v = 0 | DT = 0.001 | TMAX = 5 | NN = 101
drun
DYNAMIC
d/dt x = v
d/dt v = 5*(1 - x*x)*v - x
dispt x, v, DT
"""


class Holding(Kept):
    """Calls `action` when the run is at its n-th block of samples, on the run's own thread."""

    def __init__(self, action, rows):
        super().__init__()
        self.action, self.rows, self.session, self.done = action, rows, None, False

    def watch(self, session):
        """Look at every sample: blocks of one."""
        self.session = session
        real = session._control.clear_to_run

        def looked(memory):
            if memory.row >= self.rows and not self.done:
                self.done = True
                self.action(session)
            memory.row_limit = min(memory.row + 1, memory.row_limit)
            return real(memory)

        session._control.clear_to_run = looked


def steered(text, action, rows):
    """Run a program and do something when `rows` samples are there; return session and error."""
    kept = Holding(action, rows)
    session = Session(kept, backend=running.BACKEND)
    kept.watch(session)
    error = None
    try:
        session.erun(Source(text, "test.src"))
    except DesireError as problem:
        error = problem
    assert kept.done, error
    return session, error


def pause_for_a_moment(session):
    session.pause()
    assert session.status.state is State.PAUSED
    threading.Timer(0.05, session.resume).start()


@pytest.mark.parametrize("rule", RULES)
def test_a_paused_run_gives_exactly_what_an_undisturbed_one_gives(rule):
    undisturbed, _ = ran(MODEL.format(rule=rule))
    paused, error = steered(MODEL.format(rule=rule), pause_for_a_moment, 3)
    assert error is None
    one, other = undisturbed.runs[-1], paused.runs[-1]
    assert other.rows[:101].tolist() == one.rows[:101].tolist()
    counts = (
        "count",
        "steps",
        "rejected",
        "derivative_calls",
        "jacobian_calls",
        "order",
        "ended",
        "dt_least",
    )
    assert [getattr(other, name) for name in counts] == [getattr(one, name) for name in counts]


@pytest.mark.parametrize("rule", [9, 10, 12, 14, 15, 16])
def test_a_run_held_inside_a_communication_interval_goes_on_as_if_nothing_had_been(rule):
    """One interval with thousands of steps; the stop flag is raised again and again from another thread."""
    t_max = 400 if running.BACKEND == "native" else 30  # long enough for the other thread to come by
    undisturbed, held, disturbed = _held_inside_an_interval(rule, t_max)
    while not held:  # it did not come by: a busy machine
        t_max *= 4
        undisturbed, held, disturbed = _held_inside_an_interval(rule, t_max)
    assert disturbed.runs[-1].rows[:2].tolist() == undisturbed.runs[-1].rows[:2].tolist()
    assert disturbed.runs[-1].steps == undisturbed.runs[-1].steps


def _held_inside_an_interval(rule, t_max):
    """Run undisturbed and held again and again; return both sessions, and how often between them."""
    text = MODEL.format(rule=rule).replace("TMAX = 5 | NN = 101", f"TMAX = {t_max} | NN = 2 | DTMAX = 0.02")
    undisturbed, _ = ran(text)
    session = Session(Kept(), backend=running.BACKEND)
    nudging = threading.Event()
    held = 0

    def nudge():
        nonlocal held
        while not nudging.wait(0.002):
            status = session.status
            if status.state is State.RUNNING and status.steps:
                held += 1
                session.pause()
                session.resume()

    thread = threading.Thread(target=nudge, daemon=True)
    thread.start()
    session.erun(Source(text, "test.src"))
    nudging.set()
    thread.join(PATIENCE)
    return undisturbed, held, session


@pytest.mark.parametrize("rule", RULES)
def test_an_ended_run_keeps_its_samples_and_the_next_one_goes_on_from_there(rule):
    undisturbed, _ = ran(MODEL.format(rule=rule))
    session, error = steered(MODEL.format(rule=rule), Session.end, 9)
    assert error.diagnostics[0].code == 301
    record = session.runs[-1]
    assert record.ended == "stopped"
    assert 9 <= record.count < 101
    assert record.rows[: record.count].tolist() == undisturbed.runs[-1].rows[: record.count].tolist()
    where = value(session, "t"), value(session, "x"), value(session, "v")
    assert where[0] == record.end_time
    session.execute("TMAX = 5 - t | NN = 2")
    session.execute("drun")
    assert value(session, "t") == pytest.approx(5, rel=1e-12)
    assert value(session, "x") == pytest.approx(undisturbed.runs[-1].values("x")[-1], abs=2e-3)


@pytest.mark.parametrize("rule", MULTISTEP)
def test_runs_one_after_the_other(rule):
    """x' = cos t − 20(x − sin t) keeps to sin t; three runs, one clock, the joints not twice in store."""
    text = f"""ARRAY X[31]
irule {rule} | ERMAX = 1E-7 | DT = 0.0001 | TMAX = 1 | NN = 11
drun | drun | drun
DYNAMIC
d/dt x = cos(t) - 20*(x - sin(t))
dispt x, DT
store X = x
"""
    session, _ = ran(text)
    t = np.concatenate([run.t for run in session.runs])
    x = np.concatenate([run.values("x") for run in session.runs])
    assert t == pytest.approx([k / 10 for k in (*range(11), *range(10, 21), *range(20, 31))], abs=1e-12)
    assert x == pytest.approx(np.sin(t), abs=2e-5)
    stored = session.values.view(session.values.find("X"))
    assert stored == pytest.approx(np.sin(np.arange(31) / 10), abs=2e-5)
    assert session.runs[1].dt == session.runs[0].values("DT")[-1]  # the first step is the last one taken
    session.execute("reset")
    assert (value(session, "t"), value(session, "DT")) == (2.0, session.runs[2].dt)
    assert value(session, "x") == session.runs[1].values("x")[-1]


@pytest.mark.parametrize("rule", RULES)
def test_term_ends_a_run_at_a_step_and_its_sample_is_the_last(rule):
    text = f"""irule {rule} | ERMAX = 1E-7 | DT = 0.0001 | x = 1 | TMAX = 10 | NN = 5
drun
DYNAMIC
d/dt x = -x
d/dt y = 1000*(x - y)
term 0.5 - x
term 0.4 - x
dispt x, y
"""
    session, _ = ran(text)
    record = session.runs[-1]
    assert record.ended == "term"
    assert record.t[-1] == record.end_time == value(session, "t")
    assert record.end_time == pytest.approx(log(2), abs=1e-6)  # at the crossing, in the first interval
    assert record.count == 2
    assert record.values("x")[-1] == pytest.approx(exp(-record.end_time), abs=1e-5)
    session.execute("drun")  # x is below 0.5 at the joint and falls on: one step
    assert session.runs[-1].ended == "term"
    assert session.runs[-1].steps == 1
    session.execute("reset | x = 0.45 | drun")  # a run that continues none ends where it begins
    assert (session.runs[-1].ended, session.runs[-1].steps, session.runs[-1].count) == ("term", 0, 1)


@pytest.mark.parametrize("rule", RULES)
def test_a_difference_equation_that_changes_a_state_begins_anew(rule):
    """x' = −30(x − 1); every half second OUT takes 0.8 off: the kicks must act at once and exactly."""
    text = f"""irule {rule} | ERMAX = 1E-8 | DT = 0.0001 | TMAX = 2 | NN = 5 | n = 0
drun
DYNAMIC
d/dt x = -30*(x - 1)
dispt x, n
OUT
n = n + 1
x = x - 0.8
"""
    session, _ = ran(text)
    x, expected = 0.0, []
    for _ in range(5):
        x -= 0.8
        expected.append(x)
        x = 1 + (x - 1) * exp(-15)
    shown = session.runs[-1].values("x")
    assert shown == pytest.approx(expected, abs=3e-6)
    assert list(session.runs[-1].values("n")) == [1, 2, 3, 4, 5]
    assert value(session, "x") == shown[-1]


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(
    ("dt", "code"),
    [("0.5", 110), ("1.0E+30", 110)],
)
def test_a_first_step_that_is_none(rule, dt, code):
    text = MODEL.format(rule=rule).replace("DT = 0.001", f"DT = {dt}")
    problems = failure(text)
    assert [p.code for p in problems] == [code]
    assert "DT" in problems[0].message
    assert problems[0].span is not None


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("dt", ["1E-300", "1E-30", "0.05"])
def test_a_first_step_far_off_is_mended(rule, dt):
    """x' = −50(x − cos t); exact solution from 0."""
    text = f"""irule {rule} | ERMAX = 1E-6 | DT = {dt} | TMAX = 1 | NN = 21
drun
DYNAMIC
d/dt x = -50*(x - cos(t))
dispt x
"""
    session, _ = ran(text)
    t = session.runs[-1].t
    exact = (2500 * np.cos(t) + 50 * np.sin(t) - 2500 * np.exp(-50 * t)) / 2501
    assert session.runs[-1].values("x") == pytest.approx(exact, abs=3e-5)


@pytest.mark.parametrize("rule", MULTISTEP)
@pytest.mark.parametrize("ermax", [None, "0", "-1"])
def test_without_a_positive_error_bound_a_thousandth_is_taken(rule, ermax):
    setting = "" if ermax is None else f"ERMAX = {ermax} |"
    text = MODEL.format(rule=rule).replace("ERMAX = 1E-6 |", setting).replace("drun", "drun | drun")
    session, kept = ran(text)
    assert value(session, "ERMAX") == 0.001
    assert session.runs[-1].error_max == 0.001
    (problem,) = [p for p in kept.problems_shown if p.key != "jacobian-not-diagonal"]
    assert (problem.code, problem.severity) == (87, "warning")
    assert "ERMAX" in problem.message
    assert problem.span is not None


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("dt", ["0", "-0.001"])
def test_a_first_step_that_is_none_is_half_an_interval(rule, dt):
    session, kept = ran(MODEL.format(rule=rule).replace("DT = 0.001", f"DT = {dt}"))
    assert session.runs[-1].dt == 0.025
    assert [p.key for p in kept.problems_shown if p.code == 87] == ["setting-not-positive"]


@pytest.mark.parametrize("name", ["DT", "ERMAX", "TMAX", "DTMAX"])
@pytest.mark.parametrize("number", [inf, nan])
def test_settings_that_are_no_numbers(name, number):
    """A script cannot compute inf or nan, but a segment can, and a script may hand it on."""
    session, _ = ran(MODEL.format(rule=14))
    session.execute("reset")
    session.values.assign(session.values.find(name).slot, number)
    if name == "DTMAX" and number == inf:  # no limit
        session.execute("drun")
        assert session.runs[-1].ended == "tmax"
        return
    with pytest.raises(DesireError) as caught:
        session.execute("drun")
    assert caught.value.diagnostics[0].code == 87
    assert name in caught.value.diagnostics[0].message


@pytest.mark.parametrize("rule", RULES)
def test_a_run_that_cannot_go_on_says_when_with_which_step_and_which_state(rule):
    """y' = y² from 1 has a pole at 1; x is innocent."""
    text = f"""irule {rule} | ERMAX = 1E-6 | y = 1 | DT = 0.0001 | TMAX = 2 | NN = 21
drun
DYNAMIC
d/dt x = -x
d/dt y = y*y
dispt y
"""
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    with pytest.raises(DesireError) as caught:
        session.erun(Source(text, "test.src"))
    (problem,) = caught.value.diagnostics
    record = session.runs[-1]
    assert record.ended == "failed"
    assert record.end_time == pytest.approx(1, abs=2e-3)
    assert 220 <= problem.code <= 228
    assert f"t = {record.end_time:.6g}" in problem.message
    assert "DT = " in problem.message
    assert "'y'" in problem.message
    assert problem.source.position(problem.span.start).row == 5  # the line of y
    assert record.values("y")[:10] == pytest.approx([1 / (1 - 0.1 * k) for k in range(10)], rel=2e-4)
    assert kept.events[-1] == ("ended", 1, "failed")
    session.execute("y = 1 | t = 0 | TMAX = 0.5 | DT = 0.0001 | NN = 6")  # and the session goes on
    session.execute("drun")
    assert session.runs[-1].values("y")[-1] == pytest.approx(2, rel=2e-4)


@pytest.mark.parametrize("rule", [10, 14])
def test_a_jacobian_of_the_wrong_size(rule):
    body = "\nDYNAMIC\nd/dt x = -x\nd/dt y = -y\ndispt x\nJACOBIAN\nJ[1,1] = -1 | J[2,2] = -1\n"
    head = f"irule {rule} | ERMAX = 1E-6 | DT = 0.001 | TMAX = 1 | NN = 3 | ARRAY J"
    for shape in ("[1,1]", "[3,3]", "[2,3]", "[4]"):
        problems = failure(f"{head}{shape}\ndrun{body}")
        assert {p.code for p in problems} <= {69, 230}, [p.message for p in problems]
        assert len(problems) >= 1
    session, _ = ran(f"{head}[2,2] | x = 1\ndrun{body}")
    assert value(session, "x") == pytest.approx(exp(-1), abs=1e-5)


@pytest.mark.parametrize("rule", [10, 11, 14, 15])
def test_a_singular_jacobian_does_no_harm(rule):
    """x + y is constant and z depends on nothing: a row of zeros and two that are opposite."""
    text = f"""ARRAY J[3,3]
irule {rule} | ERMAX = 1E-7 | x = 1 | z = 5 | DT = 0.0001 | TMAX = 0.1 | NN = 11
drun
DYNAMIC
d/dt x = 100*(y - x)
d/dt y = 100*(x - y)
d/dt z = 0
dispt x, y, z
JACOBIAN
J[1,1] = -100 | J[1,2] = 100
J[2,1] = 100 | J[2,2] = -100
"""
    session, kept = ran(text)
    record = session.runs[-1]
    assert record.values("x") == pytest.approx(0.5 + 0.5 * np.exp(-200 * record.t), abs=2e-6)
    assert record.values("x") + record.values("y") == pytest.approx(np.ones(11), abs=1e-12)
    assert set(record.values("z")) == {5.0}
    assert not [event for event in kept.events if event[0] == "problems"]


@pytest.mark.parametrize("rule", RULES)
def test_a_right_hand_side_that_jumps(rule):
    """x' = 10·(s − x), s = 1 while t < 1, else −1; y counts the area under s exactly piece by piece."""
    text = f"""irule {rule} | ERMAX = 1E-6 | DT = 0.0001 | TMAX = 2.1 | NN = 22
drun
DYNAMIC
s = sgn(1 - t)
d/dt x = 10*(s - x)
d/dt y = s
dispt x, y
"""
    session, _ = ran(text)
    t = session.runs[-1].t
    up = 1 - np.exp(-10 * t)
    down = -1 + (2 - exp(-10)) * np.exp(-10 * (t - 1))
    assert session.runs[-1].values("x") == pytest.approx(np.where(t <= 1 + 1e-9, up, down), abs=1e-4)
    assert session.runs[-1].values("y") == pytest.approx(1 - np.abs(1 - t), abs=1e-4)


def test_step_statements_switch_under_a_stiff_rule():
    """A thermostat behind `step`: the relay turns at the first step end beyond the band."""
    text = """irule 15 | ERMAX = 1E-6 | DT = 0.0001 | DTMAX = 0.01 | TMAX = 8 | NN = 81 | on = 1 | x = 0
drun
DYNAMIC
d/dt x = 2*on - x
d/dt s = 500*(x - s)
dispt x, s, on
step
on = comp(on - 0.5, swtch(0.9 - x), swtch(1.1 - x))
"""
    session, _ = ran(text)
    record = session.runs[-1]
    x = record.values("x")[30:]
    assert 0.88 < x.min() < 0.93
    assert 1.07 < x.max() < 1.12
    assert np.abs(record.values("s") - x_of(record))[1:].max() < 0.01
    period = log((2 - 0.9) / (2 - 1.1)) + log(1.1 / 0.9)  # up to 1.1 and down to 0.9 again
    on = record.values("on")
    turns = int((np.diff(on) > 0).sum())
    assert turns == pytest.approx((8 - log(2 / 0.9)) / period, abs=3)  # each turn up to a step late


def x_of(record):
    return record.values("x")


@pytest.mark.parametrize("rule", RULES)
def test_an_oscillator_with_time_running_on_from_where_it_is(rule):
    """t starts at 100: nothing may assume that runs begin at 0."""
    text = f"""irule {rule} | ERMAX = 1E-8 | DT = 0.0001 | t = 100 | x = sin(100) | TMAX = 1 | NN = 6
drun
DYNAMIC
d/dt x = cos(t)
dispt x
"""
    session, _ = ran(text)
    assert session.runs[-1].t == pytest.approx([100, 100.2, 100.4, 100.6, 100.8, 101], abs=1e-12)
    assert session.runs[-1].values("x")[-1] == pytest.approx(sin(101), abs=1e-6)
