"""When what happens: guards, samples, term, continued runs, histories."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.reference.runs import array, run, value


def test_rule_0_counts_points():
    session = run("NN = 5 | x = 10\ndrun\nDYNAMIC\nx = x + t\ndispt x")
    assert list(session.runs[0].t) == [1, 2, 3, 4, 5]
    assert list(session.runs[0].values("x")) == [11, 13, 16, 20, 25]


def test_term_is_tested_at_step_ends():
    """Falling body of the book's 2.2.1: stops at t = 2.493, the first step end below the ground."""
    session = run(
        "TMAX = 5 | DT = 0.001 | NN = 501 | g = 32.2 | y = 100\ndrun\nDYNAMIC\n"
        "d/dt y = ydot\nd/dt ydot = -g\nterm -y\ndispt y"
    )
    record = session.runs[0]
    assert record.t[-1] == pytest.approx(2.493, abs=1e-12)
    assert record.values("y")[-1] == pytest.approx(100 - 16.1 * 2.493**2, abs=1e-9)
    assert record.ended == "term"


def test_term_at_the_very_first_point():
    session = run("TMAX = 1 | DT = 0.1 | NN = 11 | y = -1\ndrun\nDYNAMIC\nd/dt y = 1\nterm -y\ndispt y")
    assert session.runs[0].count == 1


def test_the_last_sample_after_term_runs_out_code_once():
    session = run(
        "TMAX = 1 | DT = 0.01 | NN = 3 | n = 0 | m = 0\ndrun\nDYNAMIC\nd/dt x = 1\nz = 2*x\nterm x - 0.205\n"
        "n = n + 1\nOUT\nm = m + 1\nX = 3*z\ndispt X"
    )
    record = session.runs[0]
    assert record.t[-1] == pytest.approx(0.21)
    assert record.values("X")[-1] == pytest.approx(6 * 0.21)
    assert value(session, "m") == 2  # the point at 0 and the end
    assert value(session, "n") == 21 * 2 + 1  # twice in each of 21 steps (Heun), once at t = 0.21


def test_out_and_step_and_later_stages():
    body = "TMAX = 1 | DT = 0.1 | NN = 6 | a = 0 | b = 0 | c = 0\ndrun\nDYNAMIC\nd/dt x = 1\na = a + 1\nstep\nb = b + 1\nOUT\nc = c + 1"
    session = run(body)
    assert value(session, "a") == 10 * 2 + 1
    assert value(session, "b") == 11
    assert value(session, "c") == 6


def test_sample_counts_the_first_point_as_number_one():
    body = (
        "TMAX = 1 | DT = 0.1 | NN = 11 | h = 0\ndrun\ndrun\nDYNAMIC\nd/dt x = 1\nSAMPLE 4\nh = h + 1\nARR = t"
    )
    session = run(body)
    # points 4, 8 of the first run; 12, 16, 20 of both together (21 points, the joint counts once)
    assert value(session, "h") == 5
    assert value(session, "ARR") == pytest.approx(1.9)


def test_mm_never_drops_the_last_sample():
    session = run("TMAX = 1 | DT = 0.1 | NN = 11 | MM = 4\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x")
    assert list(session.runs[0].t) == pytest.approx([0, 0.4, 0.8, 1.0])


def test_continued_runs_store_the_joint_once():
    session = run(
        "TMAX = 1 | DT = 0.01 | NN = 11 | ARRAY X[50]\ndrun | drun | drun\nDYNAMIC\nd/dt x = 1\nstore X = x"
    )
    assert array(session, "X")[:31] == pytest.approx(np.arange(31) / 10)
    assert not array(session, "X")[31:].any()


def test_store_stops_at_the_arrays_end_and_reset_rewinds():
    session = run(
        "TMAX = 1 | DT = 0.05 | NN = 11 | ARRAY X[4]\ndrunr\nx = 5\ndrunr\nDYNAMIC\nd/dt x = 1\nstore X = x"
    )
    assert array(session, "X") == pytest.approx([5, 5.1, 5.2, 5.3])


def test_get_is_constant_between_points():
    session = run(
        "TMAX = 1 | DT = 0.1 | NN = 3 | ARRAY X[3]\nX[1] = 1 | X[2] = 3 | X[3] = 7\ndrun\nDYNAMIC\n"
        "get u = X\nd/dt x = u\ndispt u, x"
    )
    assert list(session.runs[0].values("u")) == [1, 3, 7]
    # Heun's second stage of the last step before a point still sees the old u
    assert list(session.runs[0].values("x")) == pytest.approx([0, 0.5, 2])


def test_tdelay_is_a_shifted_copy():
    session = run(
        "TMAX = 1 | DT = 0.01 | NN = 101 | ARRAY D[40]\ndrun\nDYNAMIC\nd/dt x = cos(t)\ntdelay y = D(x, 0.25\ndispt x, y"
    )
    x, y = session.runs[0].values("x"), session.runs[0].values("y")
    assert y[25:] == pytest.approx(x[:-25], abs=1e-15)
    assert not y[:25].any()


def test_delay_works_at_points():
    session = run(
        "TMAX = 1 | DT = 0.01 | NN = 11 | ARRAY D[40]\ndrun\nDYNAMIC\nd/dt x = 1\ndelay y = D(x, 0.3\ndispt x, y"
    )
    assert list(session.runs[0].values("y")) == pytest.approx([0, 0, 0, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])


def test_a_buffer_keeps_what_it_holds():
    session = run(
        "TMAX = 1 | DT = 0.1 | NN = 11 | ARRAY D[10]\nfor i = 1 to 10 | D[i] = 5 | next\ndrun\nDYNAMIC\n"
        "d/dt x = 1\ntdelay y = D(x, 0.3\ndispt y"
    )
    assert list(session.runs[0].values("y")[:5]) == pytest.approx([5, 5, 5, 0, 0.1])


def test_track_and_hold():
    session = run(
        "NN = 6 | ARRAY P[6]\nP[2] = 1 | P[3] = 1 | P[5] = 1\ndrun\nDYNAMIC\nget p = P\ntrkhld y, y0 = p, t\ndispt y"
    )
    assert list(session.runs[0].values("y")) == [0, 0, 2, 2, 3, 3]


def test_guarded_derivatives_are_held():
    """Euler: the held derivative is the one of the step's start for every rule."""
    session = run("irule 3\nTMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nstep\nd/dt x = -x")
    # the held value is computed before the derivative reads it, so this is Euler's rule
    assert value(session, "x") == pytest.approx(0.9**10, rel=1e-14)


def test_if_else_chooses_each_pass():
    body = "TMAX = 2 | DT = 0.01 | NN = 3\ndrun\nDYNAMIC\nif t - 1\nu = 1\nelse\nu = -1\nend if\nd/dt x = u"
    assert value(run(body), "x") == pytest.approx(0, abs=0.021)


def test_a_state_of_another_segment_stands_still():
    session = run(
        "TMAX = 1 | DT = 0.1 | NN = 2 | x = 1 | y = 1\ndrun\nt = 0\ndrun other\nDYNAMIC\nd/dt x = x\nlabel other\nd/dt y = x"
    )
    e = (1 + 0.1 + 0.005) ** 10
    assert value(session, "x") == pytest.approx(e, rel=1e-14)
    assert value(session, "y") == pytest.approx(1 + e, rel=1e-14)


def test_a_difference_equation_runs_in_every_pass():
    session = run("TMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\nn = n + 1\nd/dt x = 1")
    assert value(session, "n") == 21


def test_final_values_reach_the_script():
    session = run("TMAX = 1 | DT = 0.01 | NN = 11 | x = 1\ndrun\nz = 2*y\nDYNAMIC\ny = x + 1\nd/dt x = -x")
    assert value(session, "z") == pytest.approx(2 * (1 + math.exp(-1)), rel=1e-4)
