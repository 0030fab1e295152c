"""A run that would take days ends with what can be said of it; one that only takes its time goes on."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import pytest

from desire_tui.engine.runtime import headway
from desire_tui.engine.runtime.headway import SPAN_STEPS, Headway
from tests.integration.stiff_programs import failure

END = 100.0


def looked_at(times, rule=9, rejected=0.0):
    """What is found of a run that has come to these times, a span of steps between."""
    run, found = Headway(rule), None
    assert not run.is_due(SPAN_STEPS - 1)
    for number, t in enumerate(times, 1):
        steps = number * SPAN_STEPS
        assert run.is_due(steps)
        found = found or run.look(steps, int(rejected * steps), t, END - t, np.array([1.0, t, -t]))
    return found


@pytest.mark.parametrize("rule", [1, 4, 9, 14, 17])
def test_a_steady_pace_that_would_take_days_is_none(rule):
    found = looked_at([1e-5 * k for k in range(5)], rule)
    assert found is not None
    assert found.why == "what is left would take 5e+12 steps"
    assert found.state == 1


def test_advice_depends_on_rule_and_failures():
    slow = [1e-5 * k for k in range(5)]
    assert "DT larger" in looked_at(slow, 3).advice
    assert "rule 14" in looked_at(slow, 4).advice
    assert "oscillates" in looked_at(slow, 14).advice
    assert "jump, noise or chatter" in looked_at(slow, 14, rejected=0.5).advice


def test_steps_that_become_shorter_without_end():
    assert "shorter" in looked_at([1 - 2.0**-k for k in range(6)]).why


def test_time_that_grows_as_the_logarithm_of_steps():
    """sin(exp(t)) followed closely: the same part of a period in each step."""
    found = looked_at(40.0 + np.log(np.arange(1, 12)))
    assert found is not None
    assert "shorter" in found.why
    assert looked_at(40.0 + np.log(np.arange(1, 8))) is None  # too early to tell


@pytest.mark.parametrize(
    "times",
    [
        [30 * k**0.5 for k in range(1, 10)],  # slower and slower, but it will come to its end
        [0.5 * k for k in range(20)],  # a hundred million steps
        [1e-5 * 3**k for k in range(12)],  # a transient at the start
        [1e-5 * k for k in range(4)],  # not yet
        [10 * (1 - 0.7**k) for k in range(6)],  # a slow stretch
    ],
)
def test_what_takes_its_time_goes_on(times):
    assert looked_at(times) is None


@pytest.mark.parametrize(
    ("rule", "equation", "part"),
    [
        (9, "d/dt y = 1e9*z\nd/dt z = -1e9*y", "what is left would take"),
        (14, "d/dt y = sin(1/(1 - t))/(1 - t)", "shorter and shorter"),
        (2, "d/dt y = -1e-9*y", "what is left would take"),
    ],
)
def test_runs_without_end_are_errors(rule, equation, part):
    text = f"y = 1 | irule {rule} | TMAX = 1e7 | DT = 1e-6 | NN = 3 | ERMAX = 1e-6\ndrun\nDYNAMIC\n{equation}\ndispt y\n"
    with patch.object(headway, "SPAN_STEPS", 5000):
        session, problem = failure(text)
    assert (problem.key, problem.facts["rule"], problem.facts["state"][0] in "yz") == (
        "no-headway",
        rule,
        True,
    )
    assert part in problem.message
    assert session.runs[-1].ended == "failed"
