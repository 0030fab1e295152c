"""Events and `term` under rule 17 by the roots of their conditions' polynomials, in both back ends."""

from __future__ import annotations

from math import asin, pi
from pathlib import Path

import numpy as np
import pytest

from desire_tui.engine.integration.taylor.isolation import begin_walk, next_part
from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from tests.programs.execution import execute

PROGRAM = """\
irule 17 | ERMAX = 1e-12 | DT = 0.01 | TMAX = {end} | NN = 3
{start}
drun
DYNAMIC
{body}
"""
LINE, CIRCLE = "d/dt x = 1\ndispt x\n", "d/dt x = y\nd/dt y = -x\ndispt x\n"


def run(body, end, back_end, start=""):
    start = f"x = 0 | y = 1 | n = 0 | {start or 'm = 0'}"
    outcome = execute(PROGRAM.format(body=body, end=end, start=start), back_end, Path.cwd())
    assert outcome.error is None
    assert outcome.runs[0].steps < 10 + 2 * end + 10 * outcome.quantities["n"]  # steps are long
    return outcome.quantities


BACK_ENDS = pytest.mark.parametrize("back_end", ["native", "reference"])


@BACK_ENDS
@pytest.mark.parametrize("apart", [1e-2, 1e-4, 1e-6])
def test_two_roots_close_together(back_end, apart):
    found = run(LINE + f"event {apart**2 / 4} - (x - 1.2345)^2\nn = n + 1 | m = t", 4, back_end)
    assert found["n"] == 1
    assert found["m"] == pytest.approx(1.2345 - apart / 2, abs=1e-9 / apart**0.5)


@BACK_ENDS
def test_a_short_fall_below_0(back_end):
    found = run(LINE + "event (x - 1.2345)^2 - 1e-8/4\nn = n + 1 | m = t", 4, back_end)
    assert (found["n"], found["m"]) == (1, pytest.approx(1.23455, abs=1e-9))


@BACK_ENDS
@pytest.mark.parametrize("condition", ["-(x - 1.2345)^2", "-(x - 1)^2", "-(x - 2)^4", "(x - 1.2345)^2"])
def test_what_touches_0_is_no_event(back_end, condition):
    assert run(LINE + f"event {condition}\nn = n + 1", 4, back_end)["n"] == 0


@BACK_ENDS
def test_roots_at_halves_of_the_step(back_end):
    found = run(LINE + "event (x - 0.25)*(x - 0.5)*(x - 0.75)\nn = n + 1 | m = t", 1, back_end)
    assert (found["n"], found["m"]) == (2, pytest.approx(0.75, abs=1e-14))


@BACK_ENDS
def test_events_of_many_conditions_come_in_their_order(back_end):
    body = (
        "event x - 0.3\nn = n + 1 | if m <> 1\nk = k + 1 | end if\nm = 1\n"
        "event y - 0.2\nn = n + 1 | if m <> 2\nk = k + 1 | end if\nm = 2\n"
        "event x*y - 0.4999999\nn = n + 1"
    )
    found = run(CIRCLE + body, 100, back_end, "m = 0 | k = 0")
    turns = 100 / (2 * pi)
    first, second = asin(0.3), 2 * pi - asin((1 - 0.04) ** 0.5)
    expected = sum(
        int(turns - at / (2 * pi)) + 1 for at in (first, second, pi / 4 - 2e-4, pi / 4 - 2e-4 + pi)
    )
    assert found["n"] == expected
    assert found["k"] == int(turns - first / (2 * pi)) + int(turns - second / (2 * pi)) + 2  # by turns


@BACK_ENDS
def test_what_comes_first_is_found_beside_close_roots(back_end):
    """The other condition's first root has a part of the step for itself that begins behind 0.2."""
    body = "event x - 0.2\nm = t\nevent (x - 0.3)*(0.45 - x)\nn = n + 1 | k = t"
    found = run(LINE + body, 1, back_end, "m = 0 | k = 0")
    assert (found["m"], found["k"]) == (pytest.approx(0.2, abs=1e-14), pytest.approx(0.3, abs=1e-14))
    body = "d/dt x = 1\nd/dt y = swtch(x - 0.2)\nd/dt z = swtch((x - 0.3)*(0.45 - x))\ndispt y"
    found = run(body, 1, back_end, "y = 0 | z = 0")
    assert (found["y"], found["z"]) == (pytest.approx(0.8, abs=1e-14), pytest.approx(0.15, abs=1e-14))


@BACK_ENDS
def test_falls_of_two_conditions(back_end):
    """Both are above 0 at first, fall below and rise again, all in one step."""
    body = "event (x - 0.2)*(x - 0.6)\nn = n + 1 | m = t\nevent (x - 0.3)*(x - 0.4)\nn = n + 1 | k = t"
    found = run(LINE + body, 1, back_end, "m = 0 | k = 0")
    assert found["n"] == 2
    assert (found["m"], found["k"]) == (pytest.approx(0.6, abs=1e-14), pytest.approx(0.4, abs=1e-14))
    body = "event x - 0.55\nn = n + 1 | m = t\nevent (x - 0.3)*(x - 0.6)\nn = n + 1 | k = t"
    found = run(LINE + body, 1, back_end, "m = 0 | k = 0")
    assert found["n"] == 2
    assert (found["m"], found["k"]) == (pytest.approx(0.55, abs=1e-14), pytest.approx(0.6, abs=1e-14))


@BACK_ENDS
@pytest.mark.parametrize("condition", ["abs(y) - 0.5", "swtch(abs(y) - 0.5) - 0.5"])
def test_a_condition_without_a_series_is_looked_at_in_places(condition, back_end):
    body = f"e = {condition}\nevent e\nn = n + 1 | m = t\nevent y - 0.9999999\nm = t"
    assert run(CIRCLE + body, 100, back_end)["n"] == 32  # at every pi·(k + 1/2) + pi/6


@BACK_ENDS
def test_term_between_two_roots(back_end):
    found = run(LINE + "term 1e-12 - (x - 1.2345)^2", 4, back_end)
    assert found["t"] == pytest.approx(1.2345 - 1e-6, abs=1e-9)


@BACK_ENDS
def test_a_threshold_that_points_set(back_end):
    """Steps end where code at points sets what a condition reads."""
    body = "d/dt x = 1\ndispt x\nevent x - level\nn = n + 1 | m = t\nOUT\nlevel = 5 - 8.8*t"  # 0.6 from t = 0.5 on
    found = run(body, 1, back_end, "level = 9 | m = 0")
    assert (found["n"], found["m"]) == (1, pytest.approx(0.6, abs=1e-14))


def test_every_root_is_in_a_part_of_its_own():
    rng = np.random.default_rng(1)
    layout = type(
        "Layout",
        (),
        {"pieces": [], "room": ORDER_MOST + 1, "arguments": [(0, 1)], "roots": [], "mode_count": 1},
    )
    solver = TaylorSolver(0, 0, 0, 0, layout)
    for _ in range(100):
        roots = np.sort(rng.choice(np.arange(1, 64) / 64, rng.integers(1, 6), replace=False))
        outside = rng.choice((-2.0, -1.0, 2.0, 3.0), 4)
        coefficients = np.polynomial.polynomial.polyfromroots([*roots, *outside])
        s = solver.taylor
        s.order = len(coefficients)
        solver.coefficients[: len(coefficients)] = coefficients
        assert begin_walk(s, 0, 0.0, 1.0)
        ends = []
        while next_part(s):
            ends.append((s.left, s.right))
        for root in roots:
            assert any(left <= root + 1e-9 and root - 1e-9 <= right for left, right in ends)
        signs = np.sign(np.polynomial.polynomial.polyval([0.0, *(right for _, right in ends)], coefficients))
        changes = np.count_nonzero(np.diff(signs[signs != 0]))
        assert changes in {len(roots), len(roots) - 1}  # the last root may lie on the last part's end


@BACK_ENDS
@pytest.mark.parametrize("ermax", [1e-4, 1e-12])
def test_steps_are_short_enough_for_a_condition_that_moves_faster_than_states(ermax, back_end):
    """cos(8·sin t) comes above 0.95 in visits that are counted and measured on a fine grid."""
    text = PROGRAM.replace("1e-12", f"{ermax}").format(
        end=20, start="x = 0 | y = 1 | z = 0 | n = 0 | m = 0",
        body=CIRCLE + "d/dt z = swtch(cos(8*x) - 0.95)\nevent cos(8*x) - 0.95\nn = n + 1 | m = t",
    )  # fmt: skip
    outcome = execute(text, back_end, Path.cwd())
    t = np.linspace(0.0, 20.0, 400_001)
    above = np.cos(8 * np.sin(t)) > 0.95
    rises = t[1:][above[1:] & ~above[:-1]]
    assert outcome.error is None
    assert outcome.quantities["n"] == len(rises) == 19
    assert outcome.quantities["m"] == pytest.approx(rises[-1], abs=1e-4 + 20 * ermax)
    assert outcome.quantities["z"] == pytest.approx(20 * above.mean(), abs=1e-3 + 20 * ermax)
