"""Run-time faults name the variable, the time and the defining line (language.md 9.8)."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError, render
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept, failure, session_for


def failed(text):
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    with pytest.raises(DesireError) as caught:
        session.erun(Source(text, "test.src"))
    return session, caught.value.diagnostics[0]


def test_a_state_that_grows_without_bound():
    session, problem = failed(
        "TMAX = 10 | DT = 0.01 | NN = 101 | x = 1\ndrun\nDYNAMIC\ny = 1\nd/dt x = x*x*x\ndispt x\n"
    )
    lines = render(problem).split("\n")
    assert lines[0].startswith("test.src:5:")
    assert "'x' became" in lines[0]
    assert " at t = 0.54: " in lines[0]  # the pole is at t = 1/2; the next sample, at 0.6, notices
    assert lines[1].strip() == "d/dt x = x*x*x"
    record = session.runs[0]
    assert record.ended == "failed"
    assert "'x' became" in record.message
    assert record.t == pytest.approx([0, 0.1, 0.2, 0.3, 0.4, 0.5])  # the samples stay


def test_a_displayed_variable_that_is_undefined():
    _, problem = failed(
        "TMAX = 2 | DT = 0.01 | NN = 21\ndrun\nDYNAMIC\nd/dt x = 1\nz = sqrt(1.05 - x)\ndispt z\nOUT\nsum = sum + z\n"
    )
    assert problem.message == "'z' became undefined (nan) at t = 1.1"
    assert problem.source.position(problem.span.start).row == 5


def test_an_element_of_a_vector_state():
    _, problem = failed(
        "STATE v[3] | v[2] = 1 | TMAX = 9 | DT = 0.01\ndrun\nDYNAMIC\nVectr d/dt v = v*v\ndispt v[1]\n"
    )
    assert "'v[2]' became" in problem.message
    assert problem.source.position(problem.span.start).row == 4


def test_variable_step_deadlock_tells_its_facts():
    session, problem = failed(
        "TMAX = 2 | DT = 0.1 | NN = 21 | irule 4 | ERMAX = 1.0E-06\ndrun\nDYNAMIC\nd/dt x = 100*sigmoid(1E+6*(t - 1.03))\ndispt x\n"
    )
    assert problem.code == 94
    assert "'x'" in problem.message
    assert "ERMAX = 1e-06" in problem.message
    errmax = session.values.cells[session.values.find("ERRMAX").slot]
    assert errmax > 1e-6


@pytest.mark.parametrize(("tau", "size", "needed"), [("1", 9, 10), ("2.05", 10, 20)])
def test_a_delay_says_the_size_it_needs(tau, size, needed):
    (problem,) = failure(
        f"ARRAY D[{size}] | TMAX = 3 | DT = 0.1 | NN = 31\ndrun\nDYNAMIC\nd/dt x = 1\ntdelay y = D(x, {tau}\ndispt y\n"
    )
    assert problem.code == 105
    assert f"ARRAY D[{needed}]" in problem.hint
    session_for(
        f"ARRAY D[{needed}] | TMAX = 3 | DT = 0.1 | NN = 31\ndrun\nDYNAMIC\nd/dt x = 1\ntdelay y = D(x, {tau}\ndispt y\n"
    )


def test_a_step_delay_needs_constant_steps():
    (problem,) = failure(
        "ARRAY D[50] | TMAX = 1 | irule 4\ndrun\nDYNAMIC\nd/dt x = 1\ntdelay y = D(x, 0.1\ndispt y\n"
    )
    assert problem.code == 122


def test_delay_of_a_ramp():
    """y(t) = t - tau once the buffer has been filled."""
    record = session_for(
        "ARRAY D[20] | TMAX = 3 | DT = 0.1 | NN = 31\ndrun\nDYNAMIC\nd/dt x = 1\ntdelay y = D(x, 1\ndispt y\n"
    ).runs[0]
    late = record.t > 1.15
    assert record.values("y")[late] == pytest.approx(record.t[late] - 1.0, abs=1e-9)


def test_after_a_fault_the_session_goes_on():
    session, _ = failed("TMAX = 10 | DT = 0.01 | x = 1\ndrun\nDYNAMIC\nd/dt x = x*x\ndispt x\n")
    session.execute("reset")
    session.execute("TMAX = 0.5 | drun")
    assert session.runs[-1].ended == "tmax"
    assert session.runs[-1].values("x")[-1] == pytest.approx(2.0, rel=1e-3)  # 1/(1 - t)
