"""Rule 17 in whole runs: exact solutions, accuracy by ERMAX, samples, switches, Brouwer's law; both back ends."""

from __future__ import annotations

from math import acos, cos, exp, log, pi, sin, sqrt, tau

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from tests.codegen.conftest import run
from tests.integration.eight_problems import kepler

BACK_ENDS = ("native", "reference")
both = pytest.mark.parametrize("backend", BACK_ENDS)

OSCILLATOR = "x = 1 | v = 0\nTMAX = 20 | DT = 0.01 | NN = {nn}\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -x\n"
ORBIT = (
    "x = 0.1 | y = 0 | vx = 0 | vy = sqrt(19)\nTMAX = {t_max} | DT = 0.001 | NN = {nn}\ndrun\nDYNAMIC\n"
    "w = (x^2 + y^2)^(-1.5)\nd/dt x = vx\nd/dt y = vy\nd/dt vx = -x*w\nd/dt vy = -y*w\ndispt x, y, vx, vy\n"
)
"""Kepler's, eccentricity 0.9; a turn takes 2π."""


def made(text, ermax, backend="native", **more):
    """Run a program under rule 17."""
    return run(f"irule 17 | ERMAX = {ermax!r}\n{text.format(**more)}", backend)


@both
@pytest.mark.parametrize(("ermax", "order"), [(1e-2, 6), (1e-5, 11), (1e-9, 18), (1e-15, 20), (0.0, 20)])
def test_order_follows_ermax(ermax, order, backend):
    """⌈-0.7·ln(ERMAX/10)⌉ + 1, at most 20."""
    found = made(OSCILLATOR + "dispt x\n", ermax, backend, nn=2)
    assert found.record.order == order


@both
def test_errors_follow_ermax(backend):
    """One turn of the orbit: below ERMAX times 10, and less with each smaller one."""
    errors = []
    for ermax in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        found = made(ORBIT, ermax, backend, t_max=1.0, nn=2)
        end = found.rows[-1, 1:]
        errors.append(np.max(np.abs(end - kepler(1.0, 0.9)) / (1.2, 0.436, 2.3, 4.36)))
        assert errors[-1] < 10 * ermax
    assert errors == sorted(errors, reverse=True)


@both
def test_no_ermax_is_the_machines_precision(backend):
    found = made(OSCILLATOR + "dispt x, v\n", 0.0, backend, nn=41)
    t, x, v = found.rows.T
    assert np.abs(x - np.cos(t)).max() < 1e-15
    assert np.abs(v + np.sin(t)).max() < 1e-15


@both
def test_polynomials_are_exact_in_one_step(backend):
    found = made(
        "x = 2\nTMAX = 3 | DT = 0.1 | NN = 4\ndrun\nDYNAMIC\nd/dt x = 4*t^3 - 2*t\ndispt x\n", 1e-9, backend
    )
    assert found.record.steps == 1
    assert found.rows[:, 1] == pytest.approx([2, 2, 14, 74], rel=1e-15)


@both
def test_samples_cost_no_steps(backend):
    few = made(ORBIT, 1e-12, backend, t_max=2 * pi, nn=2)
    many = made(ORBIT, 1e-12, backend, t_max=2 * pi, nn=3001 if backend == "native" else 301)
    assert many.record.steps <= 1.2 * few.record.steps
    exact = np.array([kepler(t, 0.9) for t in many.rows[1:-1, 0]])
    assert np.abs(many.rows[1:-1, 1:] - exact).max() < 1e-9  # a turn multiplies errors by hundreds


def test_what_a_point_changes_ends_a_step_there():
    """u follows SAMPLE: a staircase that derivatives read."""
    text = "x = 0 | u = 1\nTMAX = 4 | DT = 0.1 | NN = 5\ndrun\nDYNAMIC\nd/dt x = u\nSAMPLE 1\nu = u + 1\ndispt x\n"
    found = {backend: made(text, 1e-9, backend).rows[:, 1] for backend in BACK_ENDS}
    assert found["native"] == pytest.approx([0, 2, 5, 9, 14], abs=1e-12)
    assert found["native"] == pytest.approx(found["reference"], abs=1e-13)


CROSSINGS = {
    "term v - 0.99999": pi + acos(sqrt(1 - 0.99999**2)),
    "term (x - (1 - 1e-10))*swtch(t - 1)": 2 * pi - acos(1 - 1e-10),
}
"""What ends the run, and when."""


@both
@pytest.mark.parametrize("line", CROSSINGS)
def test_a_short_visit_beyond_a_threshold_is_never_missed(line, backend):
    """x = cos t stays above 1 - 1e-10 for 3e-5 only, in the middle of a step of 0.9."""
    found = made(OSCILLATOR + f"{line}\ndispt x\n", 0.0, backend, nn=2)
    assert found.record.ended == "term"
    assert found.record.end_time == pytest.approx(CROSSINGS[line], abs=3e-10)
    assert found.record.steps < 40


@both
def test_term_ends_a_run_at_its_root(backend):
    text = "x = 1\nTMAX = 10 | DT = 0.1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = -x\nterm 0.1 - x\ndispt x\n"
    found = made(text, 0.0, backend)
    assert found.record.end_time == pytest.approx(log(10), rel=1e-15)


@both
def test_kinks_by_states_and_by_time(backend):
    """x' = |v| with v = cos t: x(T) = ∫|cos|; y' = |sin t|, both over four turns; z' by max."""
    text = (
        "v = 1 | w = 0 | x = 0 | y = 0 | z = 0\nTMAX = 8*PI | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\n"
        "d/dt v = w\nd/dt w = -v\nd/dt x = abs(v)\nd/dt y = abs(sin(t))\nd/dt z = max(v, 0.5)\ndispt x, y, z\n"
    )
    found = made(text, 1e-13, backend)
    most = 4 * (2 * sin(pi / 3) + 0.5 * (2 * pi - 2 * pi / 3))
    assert found.rows[-1, 1:] == pytest.approx([16, 16, most], rel=1e-12)


@both
def test_jumps_and_branches(backend):
    """A relay's time on either side, `if`, a table: all located."""
    text = (
        "ARRAY F[6]\ndata 0, 1, 3; 0, 2, -2\nread F\n"
        "x = 1 | q = 0 | p = 0 | c = 0 | TMAX = 5 | DT = 0.1 | NN = 2\ndrun\nDYNAMIC\n"
        "d/dt x = -x\nd/dt q = swtch(x - 0.25)\nif x - 0.5 | s = 2 | else | s = t | proceed\nd/dt p = s\n"
        "d/dt c = func1(t; F)\ndispt x, q, p, c\n"
    )
    found = made(text, 1e-12, backend)
    half = log(2)
    assert found.rows[-1, 1:] == pytest.approx(
        [exp(-5), log(4), 2 * half + 12.5 - half**2 / 2, 1 + 0 - 4], rel=1e-11
    )


@both
def test_events(backend):
    """A ball from 1 m that keeps half its speed: heights between impacts are parabolas."""
    text = (
        "y = 1 | v = 0 | g = 9.81 | TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\n"
        "d/dt y = v\nd/dt v = -g\ndispt y, v\nevent -y\nv = -0.5*v | y = 0\n"
    )
    found = made(text, 1e-12, backend)
    fall = sqrt(2 / 9.81)
    speed = 0.5 * 9.81 * fall
    since = 1.0 - fall - 2 * speed / 9.81
    speed *= 0.5
    assert found.rows[-1, 1] == pytest.approx(speed * since - 9.81 * since**2 / 2, abs=1e-11)


def test_both_back_ends_agree_on_chaos():
    text = (
        "x = 1 | y = 1 | z = 1 | TMAX = 10 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\n"
        "d/dt x = 10*(y - x)\nd/dt y = x*(28 - z) - y\nd/dt z = x*y - 8/3*z\ndispt x, y, z\n"
    )
    native, reference = (made(text, 0.0, backend) for backend in BACK_ENDS)
    assert native.rows == pytest.approx(reference.rows, abs=1e-10)
    assert native.record.steps == reference.record.steps


def test_errors_of_rounding_do_not_drift():
    """The orbit's energy over 1000 turns of eccentricity 0.2, 70,000 steps' worth at other rules: Brouwer's law."""
    text = (
        ORBIT.replace("x = 0.1", "x = 0.8")
        .replace("sqrt(19)", "sqrt(1.5)")
        .replace("dispt x", "e = 0.5*(vx^2 + vy^2) - 1/sqrt(x^2 + y^2)\ndispt e, x")
    )
    found = made(text, 0.0, t_max=2 * pi * 1000, nn=1001)
    energy = found.rows[:, 1]
    assert np.abs(energy / energy[0] - 1).max() < 1e-16 * sqrt(found.record.steps)  # a random walk
    assert found.rows[-1, 0] == pytest.approx(2000 * pi)


@pytest.mark.parametrize(
    ("line", "named", "instead"),
    [
        ("d/dt x = -delay(x, 1)", "a delay", 4),
        ("q = q + 1 | d/dt x = q", "read before", 1),
        ("d/dt x = func2(x, t; F, G, H)", "this table", 9),
        ("d/dt x = func1(x; T)", "this table", 9),
        ("v[1] = x | MATRIX W = v*v | Vector u = W*v | d/dt x = -u[1]", "a matrix that changes in a step", 9),
        ("v[1] = x | Vector u^ = v | d/dt x = u[1] - x", "this operation on arrays", 9),
    ],
)
@both
def test_what_has_no_series_is_refused(line, named, instead, backend):
    """The message tells the statement, and a rule that takes it."""
    start = "ARRAY F[2,2], G[2], H[2], T[200], v[2], u[2], W[2,2] | x = 1 | q = 0\nG[2] = 1 | H[2] = 1\n"
    start += (
        "for i = 1 to 100\nT[i] = i/100 | T[100 + i] = i\nnext\nTMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\n"
    )
    with pytest.raises(DesireError) as caught:
        made(f"{start}{line}\ndispt x\n", 1e-6, backend)
    (problem,) = caught.value.diagnostics
    assert problem.code == 540
    assert named in problem.message
    assert problem.facts["instead"].startswith((f"rule {instead}", f"rules {instead} to"))
    assert run(f"irule {instead} | {start}{line}\ndispt x\n", backend).record.count == 3


def test_a_pole_is_told_with_its_state():
    with pytest.raises(DesireError) as caught:
        made(
            "x = 1 | y = 1 | TMAX = 2 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\nd/dt x = -x\nd/dt y = y*y\ndispt x\n",
            1e-9,
        )
    (problem,) = caught.value.diagnostics
    assert 220 <= problem.code <= 228
    assert "'y'" in problem.message
    assert "t = 1 " in problem.message


@both
def test_many_numbers_that_are_alike_become_arrays(backend):
    """A chain of 150, every second with a square: exp(-t)·… by hand for the first two, the rest as rule 4 finds it."""
    n = 150
    lines = ["d/dt x0 = 1 - x0"]
    lines += [f"d/dt x{i} = x{i - 1} - x{i}{f' - 0.1*x{i}*x{i}' if i % 2 else ''}" for i in range(1, n)]
    start = " | ".join(f"x{i} = 0" for i in range(n))
    text = (
        f"{start}\nTMAX = 2 | DT = 0.01 | NN = 2\ndrun\nDYNAMIC\n"
        + "\n".join(lines)
        + "\ndispt x0, x1, x2, x9\n"
    )
    found = made(text, 1e-12, backend)
    other = run(f"irule 3\n{text.replace('DT = 0.01', 'DT = 0.001')}")
    assert found.rows[-1, 1] == pytest.approx(1 - exp(-2), rel=1e-12)
    assert found.rows[-1] == pytest.approx(other.rows[-1], rel=1e-9, abs=1e-14)
    assert found.record.steps < 40


@both
def test_states_next_to_nothing_at_the_start(backend):
    """A wave leaves such numbers far away; one over 1e-320 is none, and a run may begin with them."""
    text = "x = 1 | y = 1E-320\nTMAX = 1 | DT = 1 | NN = 2\ndrun\nDYNAMIC\nd/dt x = -x | d/dt y = -y\ndispt x, y\n"
    found = made(text, 1e-9, backend).rows[-1]
    assert found[1:] == pytest.approx([exp(-1), 0.0], rel=1e-8, abs=1e-300)


@both
def test_bodies_attract_each_other(backend):
    """Five of equal mass on a ring turn as a rigid body: products for each pair are made as arrays."""
    n = 5
    pull = sum(1 / (4 * sin(pi * j / n)) for j in range(1, n))  # towards the middle, radius and masses 1
    speed = sqrt(pull)
    script, lines, sums = [], [], {i: ([], []) for i in range(n)}
    for i in range(n):
        x, y = cos(tau * i / n), sin(tau * i / n)
        script.append(f"x{i} = {x!r} | y{i} = {y!r} | u{i} = {-speed * y!r} | v{i} = {speed * x!r}")
        for j in range(i + 1, n):
            lines += [
                f"p{i}{j} = x{j} - x{i} | q{i}{j} = y{j} - y{i}",
                f"w{i}{j} = (p{i}{j}^2 + q{i}{j}^2)^(-1.5)",
            ]
            for axis, name in enumerate("pq"):
                sums[i][axis].append(f"+ {name}{i}{j}*w{i}{j}")
                sums[j][axis].append(f"- {name}{i}{j}*w{i}{j}")
    for i in range(n):
        lines += [f"d/dt x{i} = u{i} | d/dt y{i} = v{i}"]
        lines += [f"d/dt u{i} = 0 {' '.join(sums[i][0])} | d/dt v{i} = 0 {' '.join(sums[i][1])}"]
    script, body = "\n".join(script), "\n".join(lines)
    text = f"{script}\nTMAX = 1 | DT = 0.01 | NN = 2\ndrun\nDYNAMIC\n{body}\ndispt x0, y0, x3\n"
    found = made(text, 0.0, backend).rows[-1, 1:]
    assert found == pytest.approx([np.cos(speed), np.sin(speed), np.cos(speed + tau * 3 / n)], abs=1e-14)


@both
def test_derivatives_in_both_branches(backend):
    """The branches' derivatives are handed on by a number of their own, which each pass sets."""
    text = (
        "x = 0 | TMAX = 3 | DT = 0.1 | NN = 2\ndrun\nDYNAMIC\n"
        "if 1.25 - t\nd/dt x = 1\nelse\nd/dt x = 2*t\nend if\ndispt x\n"
    )
    assert made(text, 1e-12, backend).rows[-1, 1] == pytest.approx(1.25 + 9 - 1.25**2, rel=1e-12)


@both
def test_a_short_visit_sets_off_an_event(backend):
    """cos t is above 0.999 for 0.09 around each whole turn: in the middle of a step of 0.9."""
    text = (
        "x = 1 | v = 0 | n = 0 | TMAX = 20 | DT = 0.01 | NN = 2\ndrun\nDYNAMIC\n"
        "d/dt x = v\nd/dt v = -x\ndispt x\nevent x - 0.999\nn = n + 1\n"
    )
    assert made(text, 0.0, backend).scalar("n") == 3


@both
@pytest.mark.parametrize(
    ("states", "equation", "end"),
    [
        ("y = 1", "d/dt y = -sqrt(y)", 2.0),
        ("y = 0", "d/dt y = sqrt(1 - y*y)", pi / 2),
        ("STATE y[5]\nfor i = 1 to 5\n  y[i] = i\nnext", "Vectr d/dt y = -sqrt(y)", 2.0),
    ],
)
def test_no_step_goes_through_the_zero_of_a_square_root(states, equation, end, backend):
    """The series goes on below 0: a tank would fill again, y = sin(t) come back from its top."""
    text = f"irule 17 | ERMAX = 1e-9\n{states}\nTMAX = 4 | DT = 0.01 | NN = 3\ndrun\nDYNAMIC\n{equation}\ndispt t\n"
    with pytest.raises(DesireError) as caught:
        run(text, backend)
    assert caught.value.diagnostics[0].key.startswith("solver-derivative")
    assert caught.value.diagnostics[0].facts["t"] == pytest.approx(end, abs=1e-7)
