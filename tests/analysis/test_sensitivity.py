"""`sensitivity`: exact derivatives, ranks, indices of functions whose indices are known."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.sensitivity.question import analyse
from desire_tui.engine.diagnostics import DesireError

DECAY = """k = 0.5 | c = 0 | unused = 3 | x = 2 | irule 3
TMAX = 4 | DT = 0.01 | NN = 41
drun
DYNAMIC
d/dt x = -k*x
y = 3*x + c
dispt x
"""
ISHIGAMI = """x1 = 0 | x2 = 0 | x3 = 0 | irule 0
TMAX = 1 | NN = 2
drun
DYNAMIC
y = sin(x1) + 7*sin(x2)^2 + 0.1*x3^4*sin(x1)
z = 2*x1 + x2
dispt y
"""
RANGES = ", ".join(f"{name} in [-3.141592653589793, 3.141592653589793]" for name in ("x1", "x2", "x3"))


def problem(subject, text, request):
    with pytest.raises(DesireError) as error:
        analyse(subject(text), request, unwatched)
    return error.value.diagnostics[0]


def test_curves_tables_and_ranks(subject):
    found = analyse(subject(DECAY), "k, x, unused of x, y", unwatched)
    t = found["t"]
    assert found["x"]["derivatives"][0] == pytest.approx(-2 * t * np.exp(-t / 2), abs=1e-8)
    assert found["x"]["derivatives"][1] == pytest.approx(np.exp(-t / 2), abs=1e-8)
    assert found["y"]["normalised"][1] == pytest.approx(np.exp(-t / 2), abs=1e-8)
    table = found.tables[0].columns
    assert table[""] == ["x", "k", "unused"]
    influence = [np.sqrt(np.mean(np.exp(-t))), np.sqrt(np.mean((t / 2) ** 2 * np.exp(-t))), 0.0]
    assert table["influence"] == pytest.approx(influence, abs=1e-8)
    assert found.notes == ["unused: no influence on x", "unused: no influence on y"]
    assert [chart.title for chart in found.charts] == [
        "Sensitivity of x", "Sensitivity of y", "Influence on x", "Influence on y",
    ]  # fmt: skip
    assert max(found.charts[2].series[0].y) == pytest.approx(influence[0])


def test_all_numbers_of_the_script_normalised(subject):
    found = analyse(subject(DECAY, settings={"k": 0.25}), "all of y normalised", unwatched)
    assert set(found["parameters"]) == {"k", "c", "unused"}
    t = found["t"]
    curve = next(series for series in found.charts[0].series if series.name == "k")
    assert curve.y == pytest.approx(-0.25 * t * np.exp(-t / 4), abs=1e-8)
    other = next(series for series in found.charts[0].series if series.name == "c")
    assert other.y == pytest.approx(np.full(41, 1 / 6))  # of a parameter that is 0: for a change by 1


def test_differences_say_so(subject):
    noisy = DECAY.replace("y = 3*x + c", "y = 3*x + c + 0*ran()").replace("-k*x", "-k*x + 0*ran()")
    found = analyse(subject(noisy.replace("irule 3", "irule 2")), "k of x", unwatched)
    assert "draws random numbers" in found.notes[-1]
    assert found["x"]["derivatives"][0, -1] == pytest.approx(-8 * np.exp(-2), rel=0.02)  # Euler's method


def test_sobol_indices_of_ishigami(subject):
    """Ishigami and Homma 1990; a = 7, b = 0.1."""
    a, b, pi4 = 7.0, 0.1, np.pi**4
    variance = a * a / 8 + b * pi4 / 5 + b * b * pi4**2 / 18 + 0.5
    first = np.array([(1 + b * pi4 / 5) ** 2 / 2, a * a / 8, 0.0]) / variance
    both = 8 * b * b * pi4**2 / 225 / variance
    found = analyse(subject(ISHIGAMI), f"global {RANGES} of y runs 20480", unwatched)["y[end]"]
    assert found["S1"] == pytest.approx(first, abs=0.02)
    assert found["ST"] == pytest.approx(first + np.array([both, 0.0, both]), abs=0.02)


def test_effects_of_a_plane(subject):
    found = analyse(
        subject(ISHIGAMI), "global x1 in [0, 1], x2 in [0, 4] of z, max(z) morris runs 60", unwatched
    )
    for label in ("z[end]", "max(z)"):
        assert found[label]["mu*"] == pytest.approx([2.0, 4.0])
        assert found[label]["sigma"] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert found.tables[0].columns[""] == ["x2", "x1"]


def test_a_logarithmic_range(subject):
    text = ISHIGAMI.replace("z = 2*x1 + x2", "z = ln(x1) + x2").replace("x1 = 0", "x1 = 1")
    found = analyse(subject(text), "global x1 in [0.1, 10] log, x2 in [0, 1] of z runs 4096", unwatched)
    share = np.log(100) ** 2 / (np.log(100) ** 2 + 1)
    assert found["z[end]"]["S1"][0] == pytest.approx(share, abs=0.02)


def test_it_can_be_stopped(subject):
    told = []

    def stop(part, what, so_far=None):
        told.append(what)
        return part is None or part < 0.2

    text = ISHIGAMI.replace("TMAX = 1 | NN = 2", "TMAX = 2 | NN = 2000")
    found = analyse(subject(text), f"global {RANGES} of y runs 40000", stop)
    assert found.is_partial
    assert told[-1].endswith("of 40960 runs") or "of 20480 runs" in told[-1]


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        (
            "",
            "the request ends where the name of a parameter, or of a state for its initial value is expected",
        ),
        ("kk of x", "'kk' is no parameter or state"),
        ("k, k of x", "'k' is given twice"),
        ("k of q", "'q' is to be recorded, but the program does not have it"),
        ("k of x fast", "'fast' stands at the end, where nothing is expected"),
        ("global k in [0, 1], c of x", "the range of c is missing"),
        ("global k in [0, 1] of x", "one quantity alone decides everything: name two or more"),
        ("global k in [0, 1], c in [1, 0] of x", "the interval from 1 to 0 holds nothing"),
        ("global k in [0, 1], c in [0, 1] of x@0:1:0.1", "'x@0:1:0.1' is not one number of a run"),
        ("global k in [0, 1], c in [0, 1] of x runs 3", "3 is no whole number from 32 on"),
        (
            "global k in [0, 1], c in [0, 1] of x@0 runs 64",
            "x@0 is 2 in all runs: nothing has an influence",
        ),
    ],
)
def test_mistakes(subject, request_, message):
    assert problem(subject, DECAY, request_).message == message


def test_a_run_that_fails_is_told(subject):
    assert "undefined" in problem(subject, DECAY.replace("-k*x", "-k*sqrt(x - 1.9) - 1"), "k of x").message


def test_ranges_where_runs_fail(subject):
    text = DECAY.replace("-k*x", "-ln(k)*x")
    found = analyse(subject(text), "global k in [-0.2, 1], x in [1, 2] of x morris runs 300", unwatched)
    assert any("left out" in note for note in found.notes)
    assert (
        "complete"
        in problem(subject, text, "global k in [-1, -0.5], x in [1, 2] of x morris runs 64").message
    )
