"""A relay behind `step` that slides: when errors may grow, and when ERMAX holds again."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import desire_tui
from desire_tui.engine.integration.problem import SLIDE_PARTS, SLIDE_STEPS, SLIDE_TURNS
from desire_tui.engine.integration.sliding import end_slide, follow_slide

STRICT = 1e-8
FRICTION = """
s = 0 | v = 0.3
TMAX = 2 | NN = 21 | DT = 0.001 | ERMAX = 1e-6 | irule {rule}
drun
DYNAMIC
d/dt x = v
d/dt v = -2*x - s
dispt x, v
step
s = sgn(v - 0.3)
"""
COUNTED = """
k = 0 | x = 1 | TMAX = 1 | NN = 3 | DT = 0.001 | ERMAX = 1e-8 | irule {rule}
drun
DYNAMIC
d/dt x = -x + 0*k
dispt x
step
k = k + 1
"""
X_END, V_END = 0.596337, 0.267279
"""x sticks to the belt until 2*x = 1, at t = 5/3; then x = 1/2 + 0.3/sqrt(2)*sin(sqrt(2)*(t - 5/3))."""


def memory(**parts):
    usual = {"returned": 1, "fresh": 1, "turns": 0, "relief": 1.0, "tolerance": STRICT, "absolute": 0.0}
    return SimpleNamespace(slide_size=1e-3, **{**usual, **parts})


def turn(problem, times, size=1e-5):
    for _ in range(times):
        problem.returned = 1
        follow_slide(problem, size)


def test_errors_grow_behind_many_returns_only():
    problem = memory()
    turn(problem, SLIDE_TURNS)
    assert problem.tolerance == STRICT
    turn(problem, 3)
    assert problem.tolerance == 8 * STRICT
    turn(problem, 3, size=1e-3)
    assert problem.tolerance == 8 * STRICT
    end_slide(problem)
    assert (problem.tolerance, problem.relief, problem.turns) == (STRICT, 1.0, 0)


@pytest.mark.parametrize("other", [{"returned": 0}, {"fresh": SLIDE_STEPS + 1}])
def test_an_input_that_does_not_return_at_once_ends_it(other):
    problem = memory()
    turn(problem, SLIDE_TURNS + 5)
    problem.__dict__.update(other)
    follow_slide(problem, 1e-5)
    assert (problem.tolerance, problem.turns) == (STRICT, 0)


@pytest.mark.parametrize("rule", range(9, 17))
def test_dry_friction_takes_thousands_of_steps_not_tens_of_thousands(rule):
    result = desire_tui.run(FRICTION.format(rule=rule))
    assert result["x"] == pytest.approx(X_END, abs=2e-4)
    assert result["v"] == pytest.approx(V_END, abs=2e-4)
    assert result.runs[-1].steps < 6000


@pytest.mark.parametrize("rule", [9, 14])
def test_an_input_that_counts_on_is_no_relay(rule):
    result = desire_tui.run(COUNTED.format(rule=rule))
    assert result["x"] == pytest.approx(0.36787944, abs=1e-5)
    assert result.runs[-1].steps > 2 * SLIDE_PARTS
