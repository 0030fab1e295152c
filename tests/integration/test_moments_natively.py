"""Events and clocks under rules 9 to 17 go on in native code, and steps do not end where samples are taken."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.programs.execution import execute

PROGRAM = """\
irule {rule} | ERMAX = 1e-6 | DT = 0.01 | TMAX = {end} | NN = {samples}
u = 1
drun
DYNAMIC
d/dt x = u - x
d/dt y = x - y
dispt x, y
every 1
u = 1 - u
event x - 0.5
n = n + 1
"""
RULES = (9, 10, 11, 12, 13, 14, 15, 16, 17)


def calls(rule, end):
    """Return how many Python functions a run calls in the thread that makes it, and what it ended with."""
    found = 0

    def count(_frame, event, _argument):
        nonlocal found
        found += event == "call"

    text = PROGRAM.format(rule=rule, end=end, samples=11)
    execute(text, "native", Path.cwd())
    sys.setprofile(count)
    try:
        outcome = execute(text, "native", Path.cwd())
    finally:
        sys.setprofile(None)
    assert outcome.error is None
    return found, outcome


@pytest.mark.parametrize("rule", RULES)
def test_no_python_between_moments(rule):
    few, _ = calls(rule, 2)
    many, outcome = calls(rule, 200)
    assert outcome.quantities["n"] == 100  # whenever u is 1
    assert many < few + 200


@pytest.mark.parametrize("back_end", ["native", "reference"])
@pytest.mark.parametrize("rule", [9, 14, 17])
def test_samples_end_no_steps(rule, back_end):
    few, many = (execute(PROGRAM.format(rule=rule, end=4, samples=n), back_end, Path.cwd()) for n in (3, 401))
    assert many.runs[0].steps == few.runs[0].steps
    assert many.quantities["n"] == few.quantities["n"] == 2
    assert abs(many.quantities["y"] - few.quantities["y"]) < 1e-12


@pytest.mark.parametrize("back_end", ["native", "reference"])
@pytest.mark.parametrize("rule", [3, 9, 14, 17])
def test_a_sample_at_a_strike_shows_what_is_behind_it(rule, back_end):
    """The third strike of 0.1 is one rounding error behind the sample at 0.3, the sixth behind that at 0.6."""
    text = f"irule {rule} | ERMAX = 1e-6 | DT = 0.05 | TMAX = 0.9 | NN = 4\nx = 0 | n = 0\ndrun\nDYNAMIC\n"
    outcome = execute(text + "d/dt x = 1\ndispt n\nevery 0.1\nn = n + 1", back_end, Path.cwd())
    assert [row[-1] for row in outcome.runs[0].rows[:4]] == [1, 4, 7, 10]
