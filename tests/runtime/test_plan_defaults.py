"""Defaults at drun: language.md 8.1, book 1.2.4, 4.1, 8.2.1."""

from __future__ import annotations

import pytest

from desire_tui.engine.data_classes import replace
from desire_tui.engine.runtime.plan import RunPlan
from tests.runtime.running import failure, ran, session_for, value

MODEL = "DYNAMIC\nd/dt x = 1\ndispt x\n"
MAP = "DYNAMIC\nx = x + 1\ndispt x\n"


def only_run(text):
    return session_for(text).runs[-1]


def test_tmax_is_reminded_of_where_drun_stands():
    (problem,) = failure("NN = 5\ndrun\n" + MODEL)
    assert problem.code == 87
    assert problem.source.position(problem.span.start) == (2, 1)
    assert "TMAX = 10" in problem.hint


def test_tmax_must_not_be_0():
    assert failure(f"TMAX = 0 | drun\n{MODEL}")[0].code == 87


@pytest.mark.parametrize(
    ("settings", "nn", "dt"),
    [
        ("TMAX = 10", 251, 10 / 250 / 2),  # nothing set but TMAX
        ("TMAX = 10 | DT = 0.1", 101, 0.1),  # the smaller of 251 and TMAX/DT + 1
        ("TMAX = 10 | DT = 0.001", 251, 0.001),
        ("TMAX = 10 | NN = 1001", 1001, 0.005),
        ("TMAX = 10 | NN = 1", 251, 0.02),  # NN = 1 would make COMINT infinite [B 8.2.4]
        ("TMAX = 10 | NN = 11 | DT = 1", 11, 1.0),  # DT = COMINT is legal
        ("TMAX = 0.3 | DT = 0.1", 4, 0.1),  # 0.3/0.1 is a little less than 3
    ],
)
def test_samples_and_step(settings, nn, dt):
    record = only_run(f"{settings} | drun\n{MODEL}")
    assert (record.nn, record.count) == (nn, nn)
    assert record.dt == pytest.approx(dt, rel=1e-14)
    assert record.rule == 1


def test_dt_above_comint_is_error_110():
    (problem,) = failure("TMAX = 10 | NN = 11 | DT = 1.001 | drun\n" + MODEL)
    assert problem.code == 110
    # rounding is no reason: 1 - 9 * 0.1 is 0.1 but for the last bits
    assert only_run("TMAX = 0.7 | NN = 8 | DT = 0.1 | drun\n" + MODEL).count == 8


def test_a_default_step_follows_tmax():
    session = session_for("TMAX = 10 | drun\nTMAX = 1 | drun\n" + MODEL)
    assert [r.dt for r in session.runs] == pytest.approx([0.02, 0.002])
    assert value(session, "DT") == pytest.approx(0.002)  # the script can read it
    session = session_for("TMAX = 10 | DT = 0.02 | drun\nTMAX = 1 | NN = 11 | drun\n" + MODEL)
    assert session.runs[-1].dt == 0.02  # what the program set itself stays


def test_without_derivatives_time_counts_samples():
    session = session_for("NN = 10 | x = 0 | drun\n" + MAP)
    record = session.runs[-1]
    assert record.rule == 0
    assert record.t.tolist() == list(range(1, 11))
    assert record.t_max == 9
    record = only_run("x = 0 | drun\n" + MAP)
    assert (record.count, record.t0, record.t[-1]) == (251, 1.0, 251.0)


def test_rule_zero_takes_times_that_are_set():
    record = only_run("x = 0 | t = -2 | TMAX = 4 | NN = 5 | drun\n" + MAP)
    assert record.t.tolist() == [-2, -1, 0, 1, 2]


def test_rule_zero_is_for_this_run_only():
    session = session_for(
        "x = 0 | TMAX = 1 | irule 3 | drun | t = 0 | drun C\n" + MAP + "label C\nd/dt z = 1\n"
    )
    assert [r.rule for r in session.runs] == [0, 3]
    assert session.rule == 3


def test_initial_t_defaults_to_zero_with_derivatives():
    assert only_run("TMAX = 1 | drun\n" + MODEL).t0 == 0.0


@pytest.mark.parametrize("rule", [4, 7, 8])
@pytest.mark.parametrize(
    ("name", "taken"),
    [("DT", 0.05), ("DTMAX", 0.1), ("DTMIN", 0.05 / 65536), ("ERMAX", 0.001), ("ERMIN", 1e-5)],
)
@pytest.mark.parametrize("number", ["0", "-2"])
def test_a_setting_that_cannot_be_is_replaced_with_one_warning(rule, name, taken, number):
    text = f"irule {rule} | TMAX = 1 | NN = 11 | {name} = {number}\nwrite {name}\ndrunr | drunr\n{MODEL}"
    session, kept = ran(text)
    if name != "DT":  # DT is what the rule made of it
        assert value(session, name) == pytest.approx(taken)
    assert session.runs[0].dt == 0.05
    (problem,) = kept.problems_shown
    assert (problem.key, problem.severity) == ("setting-not-positive", "warning")
    assert name in problem.message
    assert problem.facts["taken"] == pytest.approx(taken)


@pytest.mark.parametrize("rule", [1, 2, 3, 5])
def test_rules_that_look_at_no_error_leave_its_bounds_alone(rule):
    session, kept = ran(f"irule {rule} | TMAX = 1 | ERMAX = 0 | DTMIN = -1\ndrun\n{MODEL}")
    assert (value(session, "ERMAX"), value(session, "DTMIN")) == (0, -1)
    assert kept.problems_shown == []


def test_variable_step_defaults_can_be_read_afterwards():
    session = session_for("TMAX = 1 | NN = 11 | DT = 0.01 | irule 4 | drun\n" + MODEL)
    assert value(session, "ERMAX") == 0.001
    assert value(session, "ERMIN") == pytest.approx(0.001 / 100)
    assert value(session, "DTMAX") == pytest.approx(0.1)
    assert value(session, "DTMIN") == pytest.approx(0.01 / 65536)


def test_checkn_beyond_the_last_state_is_error_93():
    assert failure("TMAX = 1 | irule 4 | CHECKN = 2 | drun\n" + MODEL)[0].code == 93


def test_too_many_samples_are_refused_before_the_run():
    (problem,) = failure("TMAX = 1 | NN = 1.0E+09 | drun\n" + MODEL)
    assert problem.code == 470
    assert "MM" in problem.hint
    # ten million of them are not too many: room costs nothing before it is used
    record = only_run("TMAX = 1 | NN = 1.0E+07 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\nterm 1\n")
    assert record.count == 1


def test_erun_forgets_what_the_last_program_set():
    session, kept = ran("TMAX = 1 | irule 3 | scale = 5 | drun\n" + MODEL)
    session.erun()
    assert session.rule == 3  # the program sets it again
    session.execute("zz")
    assert kept.events.count(("started", 1)) == 3


def test_closer_samples_do_not_set_steps_free():
    """A comparison samples more often; only DTMAX of the program's own lets steps go beyond points."""
    plan = RunPlan(
        rule=4, t0=0.0, t_max=4.0, nn=5, comint=1.0, dt=0.5, dt_max=1.0, dt_min=1e-6, error_max=1e-3,
        error_min=1e-5, every=1, checked=0, scale=1.0,
    )  # fmt: skip
    closer = plan.sampled_every(0.25)
    assert (closer.nn, closer.comint, closer.dt, closer.dt_max) == (17, 0.25, 0.25, 0.25)
    assert not plan.is_free
    assert not closer.is_free
    wide = replace(plan, dt_max=2.0)
    assert wide.is_free
    assert wide.sampled_every(0.25).dt_max == 2.0
    assert not replace(wide, nn=2, comint=4.0, dt_max=9.0).is_free
    assert not replace(wide, rule=3).is_free
    assert replace(plan, rule=14).sampled_every(0.25).dt_max == 1.0
