"""Machines for which scikit-sundae has no wheel: the library is hidden, rules 14 and 15 run on our own solver."""

from __future__ import annotations

from math import exp, pi, sin

import pytest

from desire_tui.engine.codegen.stiff.solver_routines import SolverRoutines
from desire_tui.engine.integration import plan
from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.integration.sundials import library
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.programs.execution import execute

ONE_STATE = """irule {rule} | ERMAX = 1E-6 | x = 1 | DT = 0.01 | TMAX = 1 | NN = 11
drun
DYNAMIC
d/dt x = -x
dispt x
"""
N = 60
"""States, more than the dense matrix is chosen for where there is a choice."""
HEAT = f"""irule {{rule}} | ERMAX = 1E-7 | DT = 1E-5 | TMAX = 0.1 | NN = 3
STATE u[{N}]
for i = 1 to {N} | u[i] = sin(PI*i/{N + 1}) | next
drun
DYNAMIC
Vectr d/dt u = {(N + 1) ** 2}*(u{{{{1}}}} - 2*u + u{{{{-1}}}})
middle = u[{N // 2}]
dispt middle
"""
CACHES = (library.libraries, library.superlu, library.is_there)


@pytest.fixture
def hidden(monkeypatch):
    """Hide SUNDIALS from everything that looks for it from now on."""
    monkeypatch.setattr(library, "find_spec", lambda _name: None)
    for cache in CACHES:
        cache.cache_clear()
    yield
    for cache in CACHES:
        cache.cache_clear()


def final(program, backend, tmp_path):
    outcome = execute(program, backend, tmp_path)
    assert outcome.error is None, str(outcome.error)
    return outcome.quantities


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", [14, 15])
def test_rules_14_and_15_with_any_number_of_states(rule, backend, hidden, tmp_path):
    """The heat equation on a grid, whose slowest mode dies out at its exact rate."""
    rate = 4 * (N + 1) ** 2 * sin(pi / (2 * (N + 1))) ** 2
    u = final(HEAT.format(rule=rule), backend, tmp_path)["u"]
    for place in (0, N // 2 - 1, N - 1):
        assert u[place] == pytest.approx(exp(-0.1 * rate) * sin(pi * (place + 1) / (N + 1)), rel=1e-4)


@pytest.mark.parametrize("rule", [number for number in RULES if number])
def test_other_rules_say_what_is_missing(rule, hidden, tmp_path):
    outcome = execute(ONE_STATE.format(rule=rule), "reference", tmp_path)
    if rule in (9, 10, 11, 12, 13, 16):
        (problem,) = outcome.error.diagnostics
        assert problem.code == 460
        assert "scikit-sundae" in problem.message
        assert "14, 15" in problem.hint
    else:
        assert outcome.error is None
        assert outcome.quantities["x"] == pytest.approx(exp(-1), abs=0.01)


def test_native_code_is_made_without_the_library_too(hidden):
    """Nothing of it is kept from sessions that had the library."""
    routines = SolverRoutines()
    assert routines.first(3, own=True).interval
    session = Session()
    with pytest.raises(Exception, match="scikit-sundae"):
        session.erun(Source(ONE_STATE.format(rule=13)))


def test_with_the_library_many_states_are_its_own():
    assert library.is_there()
    linear = plan.SolverPlan(plan.Linear("dense"), plan.Matrix.TANGENT, tables=object())
    assert not plan.is_own(14, plan.DENSE_MOST + 1, linear)
    assert plan.is_own(14, plan.DENSE_MOST, linear)
