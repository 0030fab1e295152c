"""nan, infinities, -0 and counts beyond all reason, on their way through a program into its results."""

from __future__ import annotations

from io import StringIO

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.outputs.csv_file import write_csv
from desire_tui.engine.outputs.json_file import as_json
from desire_tui.engine.values import Values

BACKENDS = ["native", "reference"]


def test_results_that_would_fill_the_memory(monkeypatch):
    monkeypatch.setattr(Values, "spare", property(lambda values: 50))
    result = desire_tui.run("write 'ready'\nARRAY a[60]\na[1] = 1\n")
    assert (result.status, [problem.code for problem in result.problems]) == ("failed", [40])
    assert (result.console, result.quantities) == ("ready\n", {})


@pytest.mark.parametrize("backend", BACKENDS)
def test_minus_zero_is_shown_everywhere(backend):
    result = desire_tui.run(
        "a = -0 | NN = 2 | TMAX = 1 | ARRAY v[2] | v[2] = -0\nwrite a\ndrun\nDYNAMIC\ny = -0*t\ntype y\ndispt y\n",
        backend=backend,
    )
    assert result.status == "done", result.problems
    assert result.console.startswith("-0\n")
    assert result.console.count("-0") == 3, result.console
    assert np.signbit([result["a"], *result["v"][1:], *result.runs[0]["y"]]).all()
    assert '"a": -0.0' in as_json(result)
    table = StringIO()
    write_csv(result.runs, table)
    assert table.getvalue().splitlines()[1].endswith(",-0.0")


ROWS = "NN = 3 | TMAX = 2 | DT = 1 | none = 0 | ARRAY P[3,2], y[2]\ndata 1, 2, 3, 4, 5, 6 | read P\niRow = 1\ndrun\nDYNAMIC\n"


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(
    ("row", "first"), [("none/none", 1), ("1/none", 1), ("2^63", 1), ("2^70", 1), ("1e300", 1), ("5.9", 3)]
)
def test_rows_beyond_all_reason_are_the_first(backend, row, first):
    result = desire_tui.run(f"{ROWS}iRow = {row}\nVector y = P#\nz = y[1]\ndispt z\n", backend=backend)
    assert result["y"][0] == first


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("row", ["0", "-2", "-1e300"])
def test_rows_that_there_are_not(backend, row):
    result = desire_tui.run(f"{ROWS}iRow = {row}\nVector y = P#\nz = y[1]\ndispt z\n", backend=backend)
    assert [problem.code for problem in result.problems] == [124]


@pytest.mark.parametrize("kind", ["ARRAY", "STATE"])
@pytest.mark.parametrize("count", ["0", "-3", "2^63", "1e18", "1e300"])
@pytest.mark.parametrize("shape", ["{}", "2,{}"])
def test_dimensions_that_there_are_not(kind, count, shape):
    result = desire_tui.run(f"{kind} a[{shape.format(count)}]\n")
    assert [problem.code for problem in result.problems] == [32]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(
    ("bounds", "left"), [("u, 1", [-2, 0.5, 1]), ("0, u", [0, 0.5, 2]), ("u, u", [-2, 0.5, 2])]
)
def test_a_bound_that_is_no_number_bounds_nothing(backend, bounds, left):
    text = (
        "NN = 2 | TMAX = 1 | none = 0 | ARRAY W[1,3]\ndata -2, 0.5, 2 | read W\ndrun\nDYNAMIC\n"
        "u = none/none\nMATRIX W = W; {}\ndispt u\n"
    )
    result = desire_tui.run(text.format(bounds), backend=backend)
    assert result["W"].tolist() == [left]
