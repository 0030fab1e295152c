"""`desire_tui.study`: what it returns is what the runs give one by one."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError
from desire_tui.engine import thread_count
from desire_tui.studies import plan as plan_module

SPRING = """k = 3 | r = 0.1 | w = 2*k | DT = 0.01 | TMAX = 1 | NN = 21 | irule 3
x = 1 | v = 0
drun
DYNAMIC
e = x*x
d/dt x = v
d/dt v = -w*x - r*v
OUT
big = max(big, x)
dispt x, e
"""
NOISY = """a = 1 | SEED 3 | DT = 0.01 | TMAX = 1 | NN = 11 | x = 0 | n = 0
drun
DYNAMIC
d/dt x = n - x
OUT
n = a*gauss(0)
dispt x
"""
LOOP = """gain = 2 | DT = 0.01 | TMAX = 1 | NN = 11 | ARRAY m[3]
for i = 1 to 3
  x = 0 | t = 0 | k = i*gain | drun | m[i] = x
next
best = m[3] - m[1]
DYNAMIC
d/dt x = k - x
dispt x
"""
EXAMPLES = Path(__file__).parents[2] / "examples"


def test_a_grid_gives_what_the_runs_give():
    found = desire_tui.study(
        SPRING,
        over={"k": "1:4:3", "r": [0.1, 0.2]},
        keep="x[end], top=max(e), x@0:1:0.25, t[x<0], v@0.5, w[end]",
    )
    assert found["x[end]"].dims == ("k", "r")
    assert found["x@0:1:0.25"].dims == ("k", "r", "t")
    assert found["k"].values.tolist() == [1, 2.5, 4]
    model = desire_tui.load(SPRING)
    for k in (1, 2.5, 4):
        for r in (0.1, 0.2):
            run, here = model.run(k=k, r=r, record=["v"]), found.sel(k=k, r=r)
            assert here["x[end]"] == run["x"][-1]
            assert here["top"] == run["e"].max()
            assert np.array_equal(here["x@0:1:0.25"], run["x"][::5])
            assert here["v@0.5"] == run["v"][10]
            assert here["w[end]"] == 2 * k
            below = np.flatnonzero(run["x"] < 0)
            assert (here["t[x<0]"] == run["t"][below[0]]) if len(below) else np.isnan(here["t[x<0]"])
    assert not found["error"].any()


def test_initial_values_lists_and_settings():
    table = {"x": [1.0, 0.5], "v": [0.0, 2.0]}
    found = desire_tui.study(SPRING, points=table, set={"r": 0}, keep="v^2 + w*x^2 [end], x@0")
    assert found["x@0"].values.tolist() == [1, 0.5]
    assert found["x"].dims == ("run",)
    assert found["v^2 + w*x^2 [end]"].values == pytest.approx([6, 4 + 6 * 0.25], rel=1e-6), "energy stays"
    assert found.attrs["set r"] == 0


def test_a_study_of_one_run_is_the_program():
    run = desire_tui.run(NOISY).runs[0]
    for settings in ({}, {"seed": 3}, {"over": {"a": [1, 2, 3]}}):
        found = desire_tui.study(NOISY, keep="x@0:1:0.1, mean(n)", **settings)
        assert np.array_equal(found["x@0:1:0.1"].values.reshape(-1, 11)[0], run["x"])
    other = desire_tui.study(NOISY, seed=4, keep="x@0:1:0.1")
    assert np.array_equal(
        other["x@0:1:0.1"][0], desire_tui.run(NOISY.replace("SEED 3", "SEED 4")).runs[0]["x"]
    )


def test_each_run_has_random_numbers_of_its_own():
    """Whatever the order, the threads, the chunks."""
    settings = {"runs": 300, "seed": 5, "keep": "x[end], mean(n)"}
    one = desire_tui.study(NOISY, threads=1, **settings)
    assert one.identical(desire_tui.study(NOISY, threads=3, **settings))
    ends = one["x[end]"].values
    assert len(np.unique(ends)) == 300
    assert desire_tui.study(NOISY, **settings | {"runs": 20})["x[end]"].values.tolist() == ends[:20].tolist()
    assert abs(one["mean(n)"].mean()) < 4 / np.sqrt(300 * 11)


def test_scripts_of_several_runs():
    found = desire_tui.study(LOOP, over={"gain": [2, 5]}, keep="best[end], m[2][end], x[end], k[end], max(x)")
    for gain in (2, 5):
        program = desire_tui.run(LOOP, set={"gain": gain})
        here = found.sel(gain=gain)
        assert here["best[end]"] == program["best"]
        assert here["m[2][end]"] == program["m"][1]
        assert here["x[end]"] == program.runs[-1]["x"][-1] == here["max(x)"]
        assert here["k[end]"] == 3 * gain
    assert found.identical(desire_tui.study(LOOP, over={"gain": [2, 5]}, keep=found.attrs["keep"], threads=2))


def test_scripts_that_draw():
    text = "TMAX = 1 | DT = 0.1 | NN = 11 | SEED 2 | x = ran()\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    found = desire_tui.study(text, runs=4, keep="x@0")["x@0"].values
    assert found[0] == desire_tui.run(text).runs[0]["x"][0]
    assert len(set(found.tolist())) == 4
    assert desire_tui.study(text, runs=2, seed=2, keep="x@0")["x@0"].values.tolist() == found[:2].tolist()


def test_what_changes_the_segment_itself():
    text = """m = 2 | TMAX = 1 | DT = 0.01 | NN = 11 | x = 1 | y = 0
drun
DYNAMIC
d/dt x = -x
dispt x, y
SAMPLE m
y = t
"""
    found = desire_tui.study(text, over={"m": [2, 3]}, keep="y@0:1:0.1")["y@0:1:0.1"].values
    for m, own in ((2, found[0]), (3, found[1])):
        assert np.array_equal(own, desire_tui.run(text, set={"m": m}).runs[0]["y"])
    model = desire_tui.load(text)
    assert np.array_equal(model.run(m=3)["y"], found[1])
    assert np.array_equal(model.run(m=2)["y"], found[0])


def test_a_run_that_fails_is_a_hole():
    text = "a = 1 | x = 1 | DT = 0.01 | TMAX = 1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = a*x*x\ndispt x\n"
    found = desire_tui.study(text, over={"a": [0.5, 3, 400, 0.1]}, keep="x[end], mean(x)")
    assert np.isnan(found["x[end]"]).values.tolist() == [False, True, True, False]
    assert found["error"].values[[0, 3]].tolist() == [0, 0]
    codes = found["error"].values[[1, 2]]
    assert (codes > 0).all()
    assert found.attrs["failed"] == 2
    assert found.attrs["failures"].startswith(f"2 runs: error {codes[0]}: ")
    assert "(first: run 1)" in found.attrs["failures"]
    assert found["x[end]"][0] == desire_tui.run(text, set={"a": 0.5}).runs[0]["x"][-1]


def test_a_script_without_a_run():
    text = "a = 1\nif a > 2 then drun | proceed\nDYNAMIC\nd/dt x = a\ndispt x\n"
    found = desire_tui.study(text.replace("a = 1", "a = 1 | TMAX = 1"), over={"a": [1, 3]}, keep="x[end]")
    assert np.isnan(found["x[end]"][0])
    assert found["x[end]"][1] == pytest.approx(3)
    assert "without a run to keep 'x[end]' of" in found.attrs["failures"]


def test_mistakes_are_said_before_the_first_run():
    calls = []
    for settings, message in (
        ({"over": {"q": [1]}}, "the program has no 'q'"),
        ({"over": {"k": [1]}, "keep": "y[end]"}, "undefined variable 'y'"),
        ({"over": {"k": [1]}, "keep": "max(x+)"}, "a value is missing"),
        ({"over": {"1k": [1]}}, "'1k' is no name"),
        ({"over": {"k": []}}, "'k' has no values"),
        ({"sample": {"k": "normal(1,2)"}}, "nobody says how often"),
        ({"over": {"k": [1]}, "keep": ""}, "nothing is kept"),
        ({"over": {"k": [1]}, "set": {"k": 2}}, "'k' is given twice"),
        ({"over": {"k": [1]}, "keep": "k=max(x)"}, "'k' varies"),
        ({"over": {"k": [1]}, "keep": "error=max(x)"}, "'error' is what the results call something else"),
        ({"runs": 2, "keep": "run=max(x)"}, "'run' is what the results call something else"),
    ):
        with pytest.raises(DesireError, match=message):
            desire_tui.study(SPRING, **{"keep": "x[end]", "progress": calls.append} | settings)
    for settings, kind, message in (
        ({"overs": {}}, TypeError, "no setting 'overs'; did you mean 'over'?"),
        ({"design": "latn"}, ValueError, "did you mean 'latin'?"),
        ({"over": {"k": [1, float("nan")]}}, ValueError, "k varies over finite numbers"),
        ({"threads": 0}, ValueError, "threads=0"),
        ({"threads": "2"}, TypeError, "threads is a whole number or None, not '2'"),
        ({"runs": 2.5}, TypeError, "runs is a whole number"),
        ({"runs": True}, TypeError, "runs is a whole number"),
        ({"seed": -1}, ValueError, "seed=-1 cannot be: give 0 or more"),
        ({"over": [1, 2]}, TypeError, "over is a mapping of names"),
        ({"over": {"k": ["a"]}}, ValueError, "k varies over finite numbers"),
        ({"sample": "k=normal(1,2)"}, TypeError, "sample is a mapping of names"),
        ({"set": 3}, TypeError, "set is a mapping of names"),
        ({"points": [[1, 2]]}, TypeError, "points is a CSV file's name"),
        ({"keep": 3}, TypeError, "keep is a text"),
        ({"input": "3"}, TypeError, "input is a list of lines"),
        ({"progress": 3}, TypeError, "progress is a function"),
        ({"store": "results.csv"}, ValueError, "end its name with .zarr"),
        ({"resume": True}, ValueError, "resume=True goes on with a store"),
    ):
        with pytest.raises(kind, match=message):
            desire_tui.study(SPRING, **{"keep": "x[end]"} | settings)
    assert not calls


def test_a_study_too_large_for_the_machine_is_refused_with_its_size(monkeypatch):
    monkeypatch.setattr(plan_module, "_memory_free", lambda: 1_000_000_000)
    with pytest.raises(DesireError) as error:
        desire_tui.study(SPRING, over={"k": "1:2:100000", "r": "1:2:10000"}, keep="x[end], max(x)")
    problem = error.value.diagnostics[0]
    assert problem.code == 512
    assert (
        "1000000000 runs of 2 numbers each take 18 GB; the machine's memory has 1 GB left" in problem.message
    )
    assert ".zarr" in problem.hint


def test_a_hypercube_too_large_for_the_memory_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr(plan_module, "_memory_free", lambda: 1_000_000)
    drawn = {"sample": {"k": "uniform(1,2)"}, "runs": 200_000, "keep": "x[end]", "store": tmp_path / "F.zarr"}
    with pytest.raises(DesireError, match=r"take 4\.8 MB; the machine's memory") as error:
        desire_tui.study(SPRING, design="latin", **drawn)
    assert "sobol" in error.value.diagnostics[0].hint


def test_curves_get_another_dimension_where_t_is_the_name_of_what_is_kept():
    found = desire_tui.study(SPRING, over={"k": [4]}, keep="t=max(x), x@0:1:0.5")
    assert found["t"].dims == ("k",)
    assert found["x@0:1:0.5"].dims == ("k", "t_2")


def test_a_library_that_is_missing_is_said_first(monkeypatch):
    real = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "xarray" else real(name))
    with pytest.raises(DesireError) as error:
        desire_tui.study(SPRING, keep="x[end]")
    assert error.value.diagnostics[0].hint == "pip install 'desire-tui[study]'"


def test_progress_is_told_and_ends_the_study():
    told = []
    desire_tui.study(SPRING, over={"k": "1:2:200"}, keep="x[end]", progress=told.append)
    assert told[-1].made == told[-1].runs == 200
    assert [each.made for each in told] == sorted({each.made for each in told})
    found = desire_tui.study(
        SPRING, over={"k": "1:2:2000"}, keep="x[end]", progress=lambda _: False, threads=1
    )
    made = (found["error"] == 0).values
    assert 0 < made.sum() < 2000
    assert np.isnan(found["x[end]"].values[~made]).all()
    assert (found["error"].values[~made] == -2).all()


ONE_RUN = [
    "ch1/step_response", "ch2/epidemic", "ch2/lorenz", "ch2/torpedo", "ch3/servo_pid", "ch3/digital_resonator",
    "ch4/backlash", "ch4/bang_bang_servo", "ch4/schmitt_trigger", "ch4/track_hold", "ch6/delays",
    "ch6/coupled_oscillators_matrix", "ch7/bouncing_ball", "ch7/pilot_ejection", "networks/fuzzy_servo",
    "appendix/van_der_pol_stiff",
]  # fmt: skip


@pytest.mark.parametrize("name", ONE_RUN)
def test_examples_of_one_run_and_their_studies_agree(name):
    """Bit for bit; a study's second run is another one, so that what it leaves behind shows."""
    path = EXAMPLES / f"{name}.src"
    shorter = {"NN": 101}
    program = desire_tui.run(path, set=shorter, go=True)
    run = program.runs[-1]
    curves = [curve.name for curve in run.curves if curve.name != "t"][:3]
    keep = ", ".join(f"{curve}[end], max({curve})" for curve in curves)
    found = desire_tui.study(
        path, set=shorter, over={"seven": [7, 8]} if "seven" in program else {}, runs=2, keep=keep
    )
    assert not found["error"].any(), found.attrs["failures"]
    for curve in curves:
        assert found[f"{curve}[end]"].values[0] == run[curve][-1], curve
        assert found[f"max({curve})"].values[0] == run[curve].max(), curve


LOOPS = [
    "ch1/step_response",
    "ch2/cannonball",
    "ch2/pendulum_phase_portrait",
    "ch2/van_der_pol",
    "ch3/servo_error_measure",
]
_LOOP = re.compile(r"^(?:for|repeat)\b.*?^(?:next|until[^\n]*)$", re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("name", LOOPS)
def test_loops_of_runs_and_their_studies_agree(name):
    """A study of the loop's body over what the loop varies gives the loop's numbers."""
    path = EXAMPLES / f"{name}.src"
    text = path.read_text("utf-8").partition("-- What it must show")[0]
    assert len(_LOOP.findall(text)) == 1
    program = desire_tui.run(text, set={"NN": 101})
    runs = program.runs
    begun = [{**run.parameters, **run.initial} for run in runs]
    varied = [key for key in begun[0] if len({each[key] for each in begun}) > 1]
    assert varied
    first = " | ".join(f"{key} = {value!r}" for key, value in begun[0].items())
    points = {key: [each[key] for each in begun] for key in varied}
    curves = [curve.name for curve in runs[0].curves if curve.name != "t"]
    keep = ", ".join(f"{curve}[end], min({curve})" for curve in curves)
    found = desire_tui.study(_LOOP.sub(f"{first}\ndrun", text), points=points, set={"NN": 101}, keep=keep)
    for curve in curves:
        assert found[f"{curve}[end]"].values.tolist() == [run[curve][-1] for run in runs]
        assert found[f"min({curve})"].values.tolist() == [run[curve].min() for run in runs]


def test_a_study_shares_the_threads_of_large_models_among_its_runs(monkeypatch):
    monkeypatch.setattr(thread_count, "_configured", lambda: 6)
    seen = []
    desire_tui.study(
        SPRING,
        over={"k": "1:4:3"},
        keep="x[end]",
        threads=2,
        progress=lambda _: seen.append(thread_count.thread_count()),
    )
    assert set(seen) == {3}
    assert thread_count.thread_count() == 6


def test_more_steps_than_a_number_can_count():
    """TMAX/DT is infinite; every run ends long before."""
    program = (
        "k = 1 | w = 2 | TMAX = 1E200 | DT = 1E-200 | NN = 2\ndrun\nDYNAMIC\n"
        "d/dt x = k*1E199*cos(w*t)\nterm x - 2\ndispt x\n"
    )
    found = desire_tui.study(program, over={"k": [1.0, 2.0]}, keep="x[end]")["x[end]"].values
    wanted = [desire_tui.load(program).run(k=k)["x"][-1] for k in (1.0, 2.0)]
    assert found.tolist() == wanted
    assert 2.0 < wanted[0] < 2.2
