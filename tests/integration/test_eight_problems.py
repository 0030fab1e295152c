"""Every rule on every problem: as accurate as docs/rules.md says, or the documented error."""

from __future__ import annotations

import pytest

from desire_tui.engine.integration.tableaus import TABLEAUS
from tests.integration.eight_problems import ERMAX, RULES, kepler, limit, problems, solve

PROBLEMS = problems()


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda p: p.name)
def test_every_rule(problem):
    wrong = {}
    for rule in RULES:
        outcome = solve(problem, rule, ERMAX)
        if outcome.code is not None or not outcome.error <= limit(rule):
            wrong[rule] = outcome
    assert not wrong


@pytest.mark.parametrize(
    "problem", [p for p in PROBLEMS if p.name in {"Robertson", "HIRES", "Lorenz"}], ids=lambda p: p.name
)
@pytest.mark.parametrize("rule", [10, 11, 14, 15])
def test_both_back_ends_agree(problem, rule):
    native, reference = (solve(problem, rule, ERMAX, backend) for backend in ("native", "reference"))
    assert native.steps == reference.steps
    assert native.error == pytest.approx(reference.error, rel=1e-3)


def test_tighter_is_better():
    """Rules 14 and 15 follow ERMAX over five decades."""
    problem = next(p for p in PROBLEMS if p.name == "HIRES")
    for rule in (14, 15):
        errors = [solve(problem, rule, 10.0**-k).error for k in (4, 6, 8, 9)]
        assert errors[0] > errors[1] > errors[2] > errors[3]
        assert errors[3] < 1e-7


def test_the_exact_orbit_is_exact():
    """Kepler's equation against the energy and the angular momentum of the starting point."""
    x, y, vx, vy = kepler(1.0, 0.9)
    assert x * vy - y * vx == pytest.approx(0.1 * (1.9 / 0.1) ** 0.5, rel=1e-12)
    assert 0.5 * (vx**2 + vy**2) - 1 / (x**2 + y**2) ** 0.5 == pytest.approx(-0.5, rel=1e-12)


def test_the_rules_are_all_there():
    assert sorted(RULES) == sorted([*TABLEAUS, *range(9, 18)])
