"""Events whose conditions or blocks meet what switches, under every kind of rule and in both back ends."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from tests.programs.execution import execute

EVERY_KIND = pytest.mark.parametrize("rule", [3, 4, 9, 14, 17])
BACK_ENDS = pytest.mark.parametrize("back_end", ["native", "reference"])


def run(rule, back_end, text):
    outcome = execute(f"irule {rule} | ERMAX = 1e-9 | DT = 0.001 | w = 0\n{text}", back_end, Path.cwd())
    assert outcome.error is None
    return outcome


@BACK_ENDS
@EVERY_KIND
def test_what_has_switched_at_the_start_sets_off_nothing(rule, back_end):
    """w is 0.3 from the start, 0 while y < 0: a rise at y = 0 alone."""
    outcome = run(
        rule, back_end,
        "x = 0 | y = 1 | n = 0 | TMAX = 6 | NN = 3\ndrun\nDYNAMIC\nw = swtch(y)*0.3\nd/dt x = y + 0*w\nd/dt y = -x\n"
        "dispt x\nevent w - 0.1\nn = n + 1 | m = t",
    )  # fmt: skip
    assert outcome.quantities["n"] == 1
    assert outcome.quantities["m"] == pytest.approx(1.5 * pi, abs=1e-3 if rule == 3 else 1e-6)


@BACK_ENDS
@EVERY_KIND
def test_samples_show_what_blocks_make_switch(rule, back_end):
    """At t = 0, 1 and 2 the block turns x round; the samples there are those behind it."""
    outcome = run(
        rule, back_end,
        "x = 1 | TMAX = 2 | NN = 5\ndrun\nDYNAMIC\nw = swtch(x)*0.3\nd/dt x = 0.1*w\ndispt w\nevery 1\nx = -x",
    )  # fmt: skip
    assert [row[1] for row in outcome.runs[0].rows[:5]] == [0, 0, 0.3, 0.3, 0]
    assert outcome.quantities["x"] == pytest.approx(-1.03, abs=1e-9)


@BACK_ENDS
@EVERY_KIND
def test_conditions_read_what_blocks_make_switch(rule, back_end):
    """The clock turns y round; which of x and y is w is then another matter, and sets off both events."""
    outcome = run(
        rule, back_end,
        "x = 0.3 | y = 0.9 | n = 0 | m = 0 | TMAX = 6 | NN = 3\ndrun\nDYNAMIC\nw = max(x, y)\nd/dt x = y\n"
        "d/dt y = -x + 0.1*w\ndispt x, y\nevent w - 0.1\nx = 0 | y = 1 | n = n + 1\nevery 0.37, 0.25\ny = -0.8*y\n"
        "event y - 0.2\ny = -0.8*y | m = m + 1",
    )  # fmt: skip
    assert (outcome.quantities["n"], outcome.quantities["m"]) == (14, 15)
