"""What ends at a singularity of its equations ends with an error: no step goes through it on a straight line."""

from __future__ import annotations

import pytest

from tests.integration.stiff_programs import failure

SQUARE_ROOT = """STATE y[{states}] | irule {rule} | ERMAX = 1e-6
for i = 1 to {states}
  y[i] = 1
next
TMAX = 2 | DT = 0.001 | NN = 3
drun
DYNAMIC
Vectr d/dt y = -1/(2*y)
dispt y[1]
"""
"""y = sqrt(1 - t) until t = 1; behind that there is no solution."""


@pytest.mark.parametrize(("rule", "states"), [(14, 2), (14, 31), (10, 2)])
def test_division_by_a_state_that_falls_to_0(rule, states):
    """Our own solver, CVODE's BDF and its Adams method: all went through without a word."""
    session, problem = failure(SQUARE_ROOT.format(rule=rule, states=states))
    assert problem.facts["state"].startswith("y[")
    assert problem.facts["t"] == pytest.approx(1.0, abs=1e-5)
    assert session.runs[-1].ended == "failed"
