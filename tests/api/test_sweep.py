"""`Model.sweep`: runs over a grid as an xarray data set."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError

DECAY = "k = 1 | a = 1 | c = 2*k | x = 1 | TMAX = 1 | DT = 0.01 | NN = 11\nirule 3\ndrun\nDYNAMIC\nd/dt x = -k*x\ny = a*x + c\ndispt x, y\n"


@pytest.fixture(scope="module")
def decay():
    return desire_tui.load(DECAY)


def test_curves_over_the_grid_are_those_of_single_runs(decay):
    found = decay.sweep(k=[1, 2, 4], a=[3, 5], record="xdot")
    assert dict(found.sizes) == {"k": 3, "a": 2, "t": 11}
    assert set(found.data_vars) == {"x", "y", "xdot", "message"}
    assert (found["message"] == "").all()
    for k in (1, 2, 4):
        for a in (3, 5):
            run, place = decay.run(k=k, a=a, record="xdot"), found.sel(k=k, a=a)
            assert np.array_equal(place["t"], run["t"])
            assert all(np.array_equal(place[name], run[name]) for name in ("x", "y", "xdot"))
    assert found["x"].sel(t=1, a=3).values == pytest.approx(np.exp([-1, -2, -4]), abs=1e-8)


@pytest.mark.parametrize(
    ("keep", "expected"),
    [
        ("last", np.exp([-1, -2])),
        ("max", [1, 1]),
        ("min", np.exp([-1, -2])),
        ("mean", [np.exp(-np.linspace(0, 1, 11)).mean(), np.exp(-2 * np.linspace(0, 1, 11)).mean()]),
        ("state", np.exp([-1, -2])),
        (lambda run: {"x": run["x"][-1]}, np.exp([-1, -2])),
    ],
)
def test_a_number_of_each_run(decay, keep, expected):
    assert decay.sweep(k=[1, 2], keep=keep)["x"].values == pytest.approx(np.array(expected), abs=1e-8)


def test_a_function_may_return_a_number_or_arrays(decay):
    assert decay.sweep(k=[1, 2], keep=lambda run: run.parameters["k"])["kept"].values.tolist() == [1, 2]
    assert decay.sweep(k=[1, 2], keep=lambda run: {"two": run["x"][:2]})["two"].dims == ("k", "two_0")


def test_what_is_given_for_all_runs_and_where_a_state_begins(decay):
    found = decay.sweep(x=[1, 2], k=3, t=(1, 2), keep="last")
    assert found["x"].dims == ("x(0)",)
    assert found.attrs == {"program": "<text>", "k": 3.0}
    assert found["x"].values == pytest.approx(np.exp(-3) * np.array([1, 2]), abs=1e-7)
    assert decay.sweep(set={"k": [1, 2]}, initial={"x": 5}, keep="max")["x"].values.tolist() == [5, 5]


def test_a_run_that_fails_is_a_hole_with_a_message():
    model = desire_tui.load(
        "r = 1 | x = 1 | TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = ln(r)\ndispt x\n"
    )
    found = model.sweep(r=[1, -1, 2])
    assert np.isnan(found["x"].sel(r=-1)).all()
    assert not np.isnan(found["x"].sel(r=2)).any()
    assert [bool(message) for message in found["message"].values] == [False, True, False]
    assert "logarithm" in found["message"].values[1]
    assert "DT" in model.sweep(DT=[0.01, 5.0], keep="last")["message"].values[1]


def test_times_that_differ_are_a_variable_and_runs_that_end_early_are_filled_up(decay):
    found = decay.sweep(TMAX=[1, 2])
    assert found["t"].dims == ("TMAX", "sample")
    assert found["t"].values[:, -1].tolist() == [1, 2]
    model = desire_tui.load(
        "v = 1 | TMAX = 1 | DT = 0.01 | NN = 11\ndrun\nDYNAMIC\nd/dt x = v\nterm x - 0.55\ndispt x\n"
    )
    found = model.sweep(v=[0, 1])
    assert found["x"].dims[0] == "v"
    assert not np.isnan(found["x"].values[0]).any()
    assert np.isnan(found["x"].values[1, -1])


def test_threads_and_progress_change_nothing(decay):
    told = []
    k = np.linspace(0, 5, 40)
    alone = decay.sweep(k=k, a=[1, 2], workers=1)
    others = decay.sweep(k=k, a=[1, 2], workers=3, progress=lambda done, total: told.append((done, total)))
    assert alone.identical(others)
    assert told[-1] == (80, 80)


def test_an_array_size_may_vary():
    model = desire_tui.load(
        "n = 2\nARRAY v[n]\nfor i = 1 to n | v[i] = i | next\nTMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nDOT s = v*v\nd/dt x = s\ndispt x\n"
    )
    assert model.sweep(n=[1, 2, 3], keep="last", workers=2)["x"].values == pytest.approx([1, 5, 14])


def test_an_exception_of_a_function_reaches_the_caller(decay):
    def fails(run):
        raise RuntimeError("of the caller")

    for workers in (1, 2):
        with pytest.raises(RuntimeError, match="of the caller"):
            decay.sweep(k=[1, 2, 3], keep=fails, workers=workers)


def test_a_time_limit_is_each_runs(decay):
    found = decay.sweep(TMAX=[1, 1e9], keep="last", timeout=0.05)
    assert "0.05 second" in found["message"].values[1]


@pytest.mark.parametrize(
    ("arguments", "kind", "words"),
    [
        ({"k": 1}, ValueError, "nothing varies"),
        ({"k": []}, ValueError, "k=\\[\\]"),
        ({"k": [1, float("nan")]}, ValueError, "k="),
        ({"kk": [1, 2]}, TypeError, "sweep\\(\\) has no parameter or setting 'kk'"),
        ({"k": [1], "wrokers": 2}, TypeError, "did you mean 'workers'"),
        ({"k": [1], "keep": "lats"}, ValueError, "did you mean 'last'"),
        ({"k": [1], "keep": 3}, TypeError, "keep is a word or a function"),
        ({"k": [1], "workers": 0}, ValueError, "workers=0"),
        ({"k": [1], "record": "nope"}, DesireError, "'nope'"),
        ({"k": [1], "initial": {"z": 1}}, DesireError, "'z'"),
        ({"k": ["a"]}, ValueError, "a"),
        ({"k": [1], "timeout": -1}, ValueError, "timeout"),
    ],
)
def test_wrong_arguments_are_refused_before_the_first_run(decay, arguments, kind, words):
    with pytest.raises(kind, match=words):
        decay.sweep(**arguments)
    assert decay.run()["x"][0] == 1


def test_nothing_recorded():
    model = desire_tui.load("k = 1 | TMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = k\n")
    with pytest.raises(ValueError, match="nothing is recorded"):
        model.sweep(k=[1, 2])
    assert model.sweep(k=[1, 2], keep="state")["x"].values == pytest.approx([1, 2])
