"""CLEARN, PLEARN and INTP do what docs/neural.md says."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.reference.runs import array, run

BACKENDS = ("reference", "native")


@pytest.mark.parametrize("backend", BACKENDS)
def test_templates_move_to_the_centres_of_clusters(backend):
    session = run(
        "NN = 3000 | SEED 3 | ARRAY W[3,2], v[3], x[2], C[3,2]\n"
        "data 0,0; 4,0; 0,4\nread C\ndata 1,1; 3,1; 1,3\nread W\niRow = 1\ndrun\nDYNAMIC\n"
        "iRow = t\nVector x = C# + 0.1*gauss(0)\nCLEARN v = W(x) 0.02, -1",
        backend=backend,
    )
    assert array(session, "W") == pytest.approx(np.array([[0, 0], [4, 0], [0, 4]], dtype=float), abs=0.06)
    assert sorted(array(session, "v")) == [0, 0, 1]


@pytest.mark.parametrize("backend", BACKENDS)
def test_conscience_wakes_idle_templates(backend):
    """Two templates far off never win without it."""
    script = (
        "NN = 2000 | SEED 3 | ARRAY W[3,1], v[3], h[3], x[1]\ndata 0; 4; 5\nread W\n"
        "data 1, 1, 1 | read h\nDRUN DYNAMIC\n"
        "Vector x = ran()\nCLEARN v = W(x) 0.05, crit\nVectr delta h = v"
    ).replace("DRUN ", "crit = {}\ndrun\n")
    plain = array(run(script.format(-1), backend=backend), "W").ravel()
    assert list(plain[1:]) == [4, 5]
    fair = array(run(script.format(0), backend=backend), "W").ravel()
    assert np.abs(fair).max() < 1


@pytest.mark.parametrize("backend", BACKENDS)
def test_vigilance_commits_rows_until_none_is_left(backend):
    """The fifth input is near neither of two committed rows: the sample stays, the run ends there (error 232)."""
    session = Session(backend=backend)
    text = (
        "NN = 6 | ARRAY W[2,2], v[2], h[2], x[2], P[6,2]\ndata 1,0; 1.5,0; 0,4; 0,4.5; 9,9; 1,0\nread P\n"
        "data 1,0; 0,5\nread W\niRow = 1\ndrun\n"
        "DYNAMIC\niRow = t\nVector x = P#\nCLEARN v = W(x) 0.5, 1\ntype v[1], v[2]"
    )
    with pytest.raises(DesireError) as caught:
        session.erun(Source(text, "t"))
    assert [d.code for d in caught.value.diagnostics] == [232]
    assert text[slice(*caught.value.diagnostics[0].span)] == "CLEARN v = W(x) 0.5, 1"
    record = session.runs[0]
    shown = np.array([record.values("v[1]"), record.values("v[2]")]).T
    assert shown.tolist() == [[1, 0], [1, 0], [0, 1], [0, 1], [0, 0]]
    assert array(session, "W") == pytest.approx(np.array([[1.25, 0], [0, 4.5]]))
    session.execute("for i = 1 to 6 | P[i,1] = 1 | P[i,2] = 0 | next")
    session.execute("t = 1 | drun")
    assert len(session.runs[1].values("v[1]")) == 6, "the next run begins anew"


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("criterion", ["0", "crit"])
@pytest.mark.parametrize("declared", ["v[2]", "v[2], h[3]", "v[2], h[2,1]", "h[2], v[2]"])
def test_a_criterion_of_0_or_more_needs_a_vector_behind_the_output(backend, criterion, declared):
    text = f"NN = 3 | crit = 0.5 | ARRAY W[2,1], x[1], {declared}\ndrun\nDYNAMIC\nCLEARN v = W(x) 0.5, {criterion}"
    with pytest.raises(DesireError) as caught:
        Session(backend=backend).erun(Source(text, "t"))
    assert [d.code for d in caught.value.diagnostics] == [475]
    Session(backend=backend).erun(
        Source(text.replace("0.5, 0", "0.5, -2").replace("crit = 0.5", "crit = -2"))
    )


@pytest.mark.parametrize("backend", BACKENDS)
def test_sangers_rule_finds_principal_components(backend):
    session = run(
        "NN = 20000 | SEED 11 | ARRAY W[2,3], v[2], x[3]\ndata 0.3,0.1,-0.2; 0.1,0.2,0.3\nread W\ndrun\nDYNAMIC\n"
        "a = 3*gauss(0) | b = gauss(0)\nx[1] = a + 0.1*gauss(0) | x[2] = a + b | x[3] = b - a\nPLEARN v = W*x; 0.0007",
        backend=backend,
    )
    covariance = 9 * np.outer([1, 1, -1], [1, 1, -1]) + np.outer([0, 1, 1], [0, 1, 1])
    vectors = np.linalg.eigh(covariance + np.diag([0.01, 0, 0]))[1][:, ::-1].T
    for found, exact in zip(array(session, "W"), vectors[:2], strict=True):
        assert abs(found @ exact) == pytest.approx(1, abs=0.03)
        assert np.linalg.norm(found) == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize("backend", BACKENDS)
def test_template_test(backend):
    session = run(
        "NN = 2 | ARRAY W[3,2], v[3], x[2]\ndata 1,0; 0,1; 1,1\nread W\nx[1] = 0.4 | x[2] = 0.7\ndrun\nDYNAMIC\n"
        "INTP v = W*x; 0.5",
        backend=backend,
    )
    assert list(array(session, "v")) == [0, 1, 1]
