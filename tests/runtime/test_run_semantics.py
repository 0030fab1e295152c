"""The run algorithm as sessions show it: language.md 8.2; models.md 1.2.4.1, 3.3.2, 1.1.2."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.runtime.running import ran, session_for, value


def test_fixed_steps_postpone_samples():
    """Model 1.2.4.1: the middle sample is due at 0.5, where a step ends."""
    record = session_for("TMAX = 1 | NN = 3 | DT = 0.1 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\n").runs[0]
    assert record.t == pytest.approx([0.0, 0.5, 1.0], abs=1e-12)
    late = session_for("TMAX = 1 | NN = 4 | DT = 0.1 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\n").runs[0]
    assert late.t == pytest.approx([0.0, 0.4, 0.7, 1.0], abs=1e-12)
    assert late.values("x") == pytest.approx(late.t, abs=1e-12)


def test_savings_grow_as_the_formula_says():
    """Model 3.3.1 (a): 20 updates of 5 %."""
    session = session_for("x = 1000 | NN = 20 | drun\nDYNAMIC\nx = 1.05 * x\ndispt x\n")
    assert value(session, "x") == pytest.approx(2653.297705, abs=1e-6)


def test_difference_equations_listing():
    """Model 3.3.2: header, then t and three columns, line by line."""
    session, kept = ran(
        "x = 5 | y = 10 | NN = 10\ndrun\n"
        "DYNAMIC\nxx = x | yy = y | p = x\ntype xx, yy, p\nx = x + 3 | y = y + 1\n"
    )
    lines = kept.text.split("\n")
    assert lines[0] == "t,   xx,yy,p"
    expected = [f"{k:<13.5e}{5 + 3 * (k - 1):13.5e} {9 + k:13.5e} {2 + 3 * k:13.5e} " for k in range(1, 11)]
    assert lines[1:11] == expected
    assert lines[10] == "1.00000e+01    3.20000e+01   1.90000e+01   3.20000e+01 "
    assert (value(session, "x"), value(session, "y")) == (35, 20)


def test_a_listing_may_go_to_a_channel(tmp_path):
    _, kept = ran(
        "x = 0 | NN = 2\nconnect 'out.txt' as output 2\ndrun\ndisconnect 2\nDYNAMIC\nx = x + 1\ntype #2, x\n",
        folder=tmp_path,
    )
    assert kept.text == ""
    assert (
        tmp_path / "out.txt"
    ).read_text() == "t,   x\n1.00000e+00    1.00000e+00 \n2.00000e+00    2.00000e+00 \n"


def test_continued_runs_go_on_and_reset_returns_to_the_last_start():
    program = "TMAX = 1 | DT = 0.01 | NN = 11 | x = 1\ndrun | drun\na = t | b = x\nreset\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    session = session_for(program)
    assert value(session, "a") == pytest.approx(2.0, abs=1e-12)
    assert value(session, "b") == pytest.approx(math.exp(-2), rel=1e-4)
    assert [r.t0 for r in session.runs] == pytest.approx([0, 1], abs=1e-12)
    # the start of the second run, not of the first
    assert value(session, "t") == pytest.approx(1.0, abs=1e-12)
    assert value(session, "x") == pytest.approx(math.exp(-1), rel=1e-4)


def test_drunr_leaves_only_other_variables_changed():
    session = session_for(
        "TMAX = 1 | DT = 0.1 | NN = 11 | x = 2 | n = 0\ndrunr | drunr\nDYNAMIC\nd/dt x = -x\nOUT\nn = n + 1\ndispt n\n"
    )
    assert (value(session, "x"), value(session, "t")) == (2, 0)
    assert value(session, "n") == 22  # a difference equation keeps what it has


def test_continued_runs_store_the_joint_point_once():
    session = session_for(
        "ARRAY X[9] | TMAX = 4 | NN = 5 | DT = 0.5\ndrun | drun\nDYNAMIC\nd/dt x = 1\nstore X = x\ndispt x\n"
    )
    stored = session.values.view(session.values.find("X"))
    assert stored == pytest.approx(np.arange(9.0), abs=1e-12)


def test_reset_rewinds_store():
    session = session_for(
        "ARRAY X[9] | TMAX = 4 | NN = 5 | DT = 0.5 | b = 0\ndrunr\nb = 10 | drun\n"
        "DYNAMIC\nd/dt x = 1\ny = x + b\nstore X = y\ndispt x\n"
    )
    assert session.values.view(session.values.find("X")) == pytest.approx(
        [10, 11, 12, 13, 14, 0, 0, 0, 0], abs=1e-12
    )


def test_dummy_integration_repeats_the_joint_and_does_not_count_it():
    session = session_for(
        "ARRAY X[6] | NN = 3 | x = 0\ndrun | drun\nDYNAMIC\nx = x + 1\nstore X = x\ndispt x\n"
    )
    assert [r.t.tolist() for r in session.runs] == [[1, 2, 3], [3, 4, 5]]
    assert session.values.view(session.values.find("X")).tolist() == [1, 2, 3, 5, 6, 0]


def test_what_a_segment_sets_can_be_read_by_the_script():
    session = session_for(
        "ARRAY v[3] | TMAX = 1 | drun\nw = y + v[2]\nDYNAMIC\nd/dt x = 1\ny = 2 * x\nVector v = y + 1\ndispt y\n"
    )
    assert value(session, "y") == pytest.approx(2.0)
    assert value(session, "w") == pytest.approx(5.0)


def test_term_ends_a_run_after_a_last_sample():
    """Model 2.1.3: tested at step ends."""
    record = session_for(
        "g = 32.2 | y = 100 | TMAX = 5 | DT = 0.001 | NN = 501\ndrun\n"
        "DYNAMIC\nd/dt y = v | d/dt v = -g\nterm -y\ndispt y\n"
    ).runs[0]
    assert record.ended == "term"
    assert record.t[-1] == pytest.approx(2.493, abs=1e-9)
    assert record.values("y")[-1] == pytest.approx(-0.0622889, abs=1e-6)


def test_mm_never_drops_the_last_sample():
    record = session_for(
        "TMAX = 1 | NN = 11 | DT = 0.1 | MM = 4 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
    ).runs[0]
    assert record.t == pytest.approx([0.0, 0.4, 0.8, 1.0], abs=1e-12)


def test_parameters_do_not_compile_again(monkeypatch):
    from desire_tui.engine.lowering import lowering

    calls = []
    real = lowering.lower
    monkeypatch.setattr(lowering, "lower", lambda *a, **k: calls.append(1) or real(*a, **k))
    session_for(
        "TMAX = 1\nfor k = 1 to 5\na = k | x = 1 | DT = 0.001 * k\ndrunr\nnext\nDYNAMIC\nd/dt x = -a*x\ndispt x\n"
    )
    assert len(calls) == 1


def test_statistics():
    record = session_for(
        "TMAX = 1 | DT = 0.1 | NN = 11 | irule 3 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
    ).runs[0]
    assert record.steps == 10
    assert record.rejected == 0
    assert (record.dt_least, record.dt_most) == (0.1, 0.1)
    assert record.seconds > 0


def test_runs_need_no_request():
    session, kept = ran("TMAX = 1 | drun\nDYNAMIC\nd/dt x = 1\n")
    assert session.runs[0].count == 251
    assert session.graph is None
    assert ("ended", 1, "tmax") in kept.events


def test_two_segments_share_time_and_values():
    session = session_for(
        "TMAX = 1 | STATE q\ndrun | drun second\nDYNAMIC\nd/dt q = 1\ndispt q\nlabel second\nd/dt p = q\ndispt p\n"
    )
    assert [r.segment for r in session.runs] == [None, "second"]
    assert value(session, "t") == pytest.approx(2.0)
    assert value(session, "q") == pytest.approx(1.0)  # it does not move during the other segment's run
    assert value(session, "p") == pytest.approx(1.0)


def test_no_such_segment_is_error_215():
    from tests.runtime.running import failure

    (problem,) = failure("TMAX = 1 | drun nowhere\nDYNAMIC\nd/dt x = 1\n")
    assert problem.code in (68, 215)


def test_show_keeps_a_picture_of_each_sample():
    session = session_for(
        "ARRAY A[6] | TMAX = 2 | NN = 3 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = 1\nVector A = x\nSHOW A, 3\ndispt x\n"
    )
    pictures = session.runs[0].pictures
    assert [film[0].tolist() for film in pictures] == [[0.0] * 6, [1.0] * 6, [2.0] * 6]
    shown = session.graph.shown[0]
    assert shown.latest().shape == (2, 3)


def test_a_program_without_a_segment_cannot_run_one():
    from tests.runtime.running import failure

    (problem,) = failure("TMAX = 1\ndrun\n")
    assert problem.code == 215
    assert problem.source.position(problem.span.start).row == 2


@pytest.mark.parametrize("rule", [1, 2, 3, 4, 8])
def test_divisions_by_zero_at_every_stage(rule):
    """What plain Python refuses to compute goes another way, which is made at need and for each stage."""
    session = session_for(
        f"a = 2 | zero = 0 | irule {rule} | TMAX = 1 | DT = 0.25 | NN = 3 | drun\n"
        "DYNAMIC\nd/dt x = atan(a/zero)\nd/dt y = t\nd/dt w = exp(-a/zero) + 2\n"
    )
    assert value(session, "x") == pytest.approx(math.pi / 2, abs=1e-12)
    assert value(session, "w") == pytest.approx(2.0, abs=1e-12)
    if rule != 2:
        assert value(session, "y") == pytest.approx(0.5, abs=1e-12)
