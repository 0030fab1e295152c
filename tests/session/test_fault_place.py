"""Runs that end by an inf or nan name the part of an expression that made it."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

ROOT = (
    "irule {rule}\nTMAX = 4 | NN = 5 | DT = 0.01 | ERMAX = 1e-6\nx = 1\n{more}\n"
    "drun\nDYNAMIC\nd/dt x = -sqrt(x)\ndispt x\n"
)


def failure(text: str, backend: str = "native"):
    session = Session(backend=backend)
    with pytest.raises(DesireError) as caught:
        session.erun(Source(text, "p"))
    return caught.value.diagnostics[0], session


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_a_corrector_that_met_a_root_of_a_negative_number_says_so(backend) -> None:
    problem, session = failure(ROOT.format(rule=14, more=""), backend)
    assert problem.key == "solver-corrector-part"
    assert problem.message.startswith("the corrector of rule 14 did not converge: 'sqrt(x)' is the root of -")
    text = problem.source.text
    assert text[problem.span.start : problem.span.end] == "sqrt(x)"
    assert session.runs[0].message == problem.message


def test_of_a_large_model_no_copy_is_kept_and_the_solver_speaks() -> None:
    problem, _ = failure(ROOT.format(rule=9, more="ARRAY A[30000]"))
    assert problem.key == "solver-derivative"


@pytest.mark.parametrize("rule", [1, 4])
def test_what_the_run_left_is_not_touched_by_the_search(rule) -> None:
    text = (
        "irule {r}\nTMAX = 4 | NN = 41 | DT = 0.01\nx = 1 | n = 0\ndrun\nDYNAMIC\n"
        "d/dt x = -x*sqrt(1.5 - t)\ndispt x\nOUT\nn = n + 1\nq = ran()\n"
    )
    problem, session = failure(text.format(r=rule))
    assert problem.key == "not-finite-part"
    assert problem.facts["part"] == "sqrt(1.5 - t)"
    values = session.values
    count = session.runs[0].count
    assert count in {15, 16}
    assert values.cells[values.find("n").slot] == count
    assert session.runs[0].t[-1] == pytest.approx(0.1 * (count - 1))


def test_a_part_of_a_defined_variable_and_of_vectors() -> None:
    text = (
        "TMAX = 4 | NN = 5 | DT = 0.1\nSTATE v[3]\nARRAY w[3]\ndata 1, 2, 3 | read v\ndrun\nDYNAMIC\n"
        "g = 2 + 1/(t - t)\nVector w = v*(2 + recip(g - g))\nVectr d/dt v = w\n"
    )
    problem, _ = failure(text)
    assert problem.facts["part"] == "1/(t - t)"
    assert problem.facts["cause"] == "1 divided by 0"
    problem, _ = failure(text.replace("1/(t - t)", "1"))
    assert problem.facts["part"] == "recip(g - g)"


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", [3, 14])
def test_what_looks_into_the_past_is_not_made_again_without_it(rule, backend) -> None:
    """By the method of steps: x = 1 + (2 + ln 1.7) t up to 0.5, and the logarithm's argument is 0 half a unit after x is 2.7."""
    text = (
        f"irule {rule} | ERMAX = 1e-6\nTMAX = 4 | NN = 5 | DT = 0.01 | x = 1\ndrun\nDYNAMIC\n"
        "d/dt x = 2 + ln(2.7 - delay(x, 0.5))\ndispt x\n"
    )
    problem, _ = failure(text, backend)
    assert problem.key in {"not-finite", "solver-derivative"}
    assert problem.facts["t"] > 1.1


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_nor_are_steps_that_events_cut(backend) -> None:
    text = "irule 3\nTMAX = 4 | NN = 5 | DT = 0.03 | x = 1\ndrun\nDYNAMIC\nd/dt x = ln(x)\nevery 1, 0.5\nx = -1\n"
    problem, _ = failure(text, backend)
    assert problem.key == "not-finite"
    assert problem.facts["t"] > 0.5


def test_the_place_does_not_depend_on_where_blocks_begin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps in the middle begin with derivatives from before OUT: made again from there they would differ."""
    program = """k = -0.8 | DT = 0.01 | TMAX = 3 | NN = 301 | x = 1 | n = 0
drun
DYNAMIC
d/dt x = n - k*x^3
OUT
n = 3*gauss(0)
dispt x
"""
    found = set()
    for seconds in (1e-9, 0.02, 10.0):
        monkeypatch.setattr("desire_tui.engine.runtime.simulator.BLOCK_SECONDS", seconds)
        found |= {(seed, failure(f"SEED {seed}\n{program}")[0].message) for seed in (3, 4, 5)}
    assert all("'x^3' is too large for a number" in message for _, message in found)
    assert len(found) == 3
