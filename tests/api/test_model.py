"""`desire_tui.load` and `Model.run`: parameters, starts, times, what is recorded, mistakes."""

from __future__ import annotations

import re

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError

DECAY = """a = 1 | b = 2*a | TMAX = 1 | DT = 0.01 | NN = 11
x = 1 | y = 3
drun
write "behind the run"
DYNAMIC
k = a
d/dt x = -k*x
d/dt y = b
dispt x
"""


@pytest.fixture(scope="module")
def decay():
    return desire_tui.load(DECAY)


def test_what_a_model_says_of_itself(decay):
    assert decay.parameters == {"a": 1.0, "b": 2.0}
    assert decay.states == {"x": 1.0, "y": 3.0}
    assert repr(decay) == "<Model <text>: 2 states x, y; parameters a=1, b=2>"


def test_a_run_is_a_mapping_of_samples(decay):
    run = decay.run()
    assert list(run) == ["t", "x"]
    assert len(run) == 2
    assert "x" in run
    assert "k" not in run
    assert run["x"] == pytest.approx(np.exp(-run["t"]), abs=1e-5)
    assert repr(run) == "<Run of <text>: 11 samples of x, t = 0 … 1; rule 1, 100 steps>"
    with pytest.raises(KeyError, match="'y' was not recorded"):
        run["y"]


def test_a_parameter_holds_for_one_run_and_what_the_script_computes_from_it_follows(decay):
    assert decay.run(a=3).parameters == {"a": 3.0, "b": 6.0}
    assert decay.run(a=3)["x"][-1] == pytest.approx(np.exp(-3), abs=1e-4)
    assert decay.run(b=5).parameters == {"a": 1.0, "b": 5.0}
    assert decay.run().parameters == {"a": 1.0, "b": 2.0}


def test_names_of_other_arguments_go_through_set():
    model = desire_tui.load("set = 2 | TMAX = 1 | DT = 0.1\nx = 0\ndrun\nDYNAMIC\nd/dt x = set\n")
    assert model.run(set={"set": 5}).state == pytest.approx([5])


@pytest.mark.parametrize(
    "program",
    [
        "for i = 1 to 3 | r = r + i | next | s = r",
        "if r > 2 then | s = 10*r | else | s = r | proceed",
        "s = 2*r | r = r + 1 | q = r",
        "s = 2 | s = s*r | s = s + 1",
        "PROCEDURE f(u; V)\nV = u*r\nend\ncall f(2; s)",
        "FUNCTION f(u) = u*r\ns = f(3)",
        "ARRAY A[3] | A[2] = r | s = A[2]*2 | A[2] = 7 | q = A[2]",
        "s = 0\nlabel l\ns = s + r\nif s < 20 then | go to l | proceed",
        "SEED 3 | s = r + ran()",
        "data 4, 5 | read r | s = r",
    ],
)
def test_dependent_values_are_those_of_the_whole_script(program):
    text = f"r = 4 | s = 0 | q = 0\n{program}\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = r + s + q\n"
    run = desire_tui.load(text).run(r=3)
    whole = desire_tui.run(text, set={"r": 3})
    assert run.parameters == whole.runs[0].parameters


def test_a_loop_around_the_run_leaves_its_variable_to_the_caller():
    text = "TMAX = 1 | DT = 0.5\nfor r = 1 to 3\nq = 2*r | x = 0\ndrun\nnext\nDYNAMIC\nd/dt x = q\n"
    model = desire_tui.load(text)
    assert model.run().state == pytest.approx([2])
    assert model.run(r=5).state == pytest.approx([10])


def test_arrays_and_their_elements():
    text = "ARRAY a[3] | a[2] = 1\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = a[1] + a[2] + a[3]\n"
    model = desire_tui.load(text)
    assert model.run(set={"a[3]": 4}).state == pytest.approx([5])
    assert model.run(a=[1, 2, 3]).state == pytest.approx([6])
    assert model.run().state == pytest.approx([1])


def test_a_size_of_arrays():
    text = "n = 2\nSTATE x[n] | ARRAY v[n]\nfor i = 1 to n | v[i] = i | next\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nVectr d/dt x = v\n"
    model = desire_tui.load(text)
    assert list(model.states) == ["x[1]", "x[2]"]
    assert model.run(n=3).state == pytest.approx([1, 2, 3])
    assert model.run().state == pytest.approx([1, 2])


def test_a_number_that_code_is_compiled_with():
    text = "k = 4 | m = 2*k | q = 0 | TMAX = 10 | NN = 101 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = 1\ny = q\ndispt y\nSAMPLE m\nq = x\n"
    model = desire_tui.load(text)
    for settings in ({"k": 10}, {"m": 7}, {}):
        assert np.array_equal(model.run(**settings)["y"], desire_tui.run(text, set=settings).runs[0]["y"])


def test_lines_for_input_are_there_each_time_the_script_runs():
    text = "input n | input k\nARRAY v[n] | v[1] = k\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = v[1]\n"
    model = desire_tui.load(text, input=["2", "7"])
    assert model.run(n=3).state == pytest.approx([2])  # the line that `n` would read is left for `k`
    assert model.run().state == pytest.approx([7])


def test_ways_in_which_parameters_take_effect_follow_one_another():
    text = "n = 2 | a = 3 | b = 2*a\nARRAY v[n] | v[1] = b\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = b + v[1]\n"
    model = desire_tui.load(text)
    assert [
        model.run(**s).state[0] for s in ({"a": 1}, {"n": 4}, {"a": 1}, {"b": 1, "n": 1}, {})
    ] == pytest.approx([4, 12, 4, 2, 12])


def test_starts_by_name_and_as_an_array(decay):
    assert decay.run(initial={"x": 5})["x"][0] == 5
    assert decay.run(initial=[2, 7]).initial == {"x": 2.0, "y": 7.0}
    half = decay.run(t=(0, 0.5))
    end = decay.run(initial=half.state, t=(0.5, 1))
    assert end["t"][0] == 0.5
    assert end.state == pytest.approx(decay.run().state, rel=1e-12)


def test_quantities_and_derivatives_are_recorded_on_demand(decay):
    run = decay.run(record=["k", "xdot", "d/dt y"], a=3)
    assert list(run) == ["t", "x", "k", "xdot", "d/dt y"]
    assert run["xdot"] == pytest.approx(-3 * run["x"])
    assert run["d/dt y"] == pytest.approx(6)
    assert list(decay.run()) == ["t", "x"]


def test_whole_arrays_and_derivatives_of_vectors_are_recorded():
    text = "STATE x[2] | x[1] = 1 | x[2] = 2\nTMAX = 1 | DT = 0.5\ndrun\nDYNAMIC\nVectr d/dt x = 2*x\n"
    run = desire_tui.load(text).run(record=["x", "d/dt x[2]", "xdot"])
    assert list(run) == ["t", "x[1]", "x[2]", "d/dt x[2]", "d/dt x[1]"]
    assert run["d/dt x[2]"] == pytest.approx(2 * run["x[2]"])


def test_a_program_without_drun_has_a_run_and_one_with_stop_goes_on():
    assert desire_tui.load(
        "TMAX = 1 | DT = 0.5\nSTOP\nr = 2\nDYNAMIC\nd/dt x = r\n"
    ).run().state == pytest.approx([2])


def test_one_of_several_segments():
    text = "TMAX = 1 | DT = 0.5\ndrun\nx = 0\ndrun B\nDYNAMIC\nd/dt x = 1\nlabel B\nd/dt x = 2\n"
    assert desire_tui.load(text).run().state == pytest.approx([1])
    assert desire_tui.load(text, segment="B").run().state == pytest.approx([2])


@pytest.mark.parametrize(
    ("arguments", "kind", "words"),
    [
        ({"aa": 1}, TypeError, "run() has no parameter or setting 'aa'"),
        ({"initail": {}}, TypeError, "did you mean 'initial'?"),
        ({"set": {"sigm": 1}}, DesireError, "the program has no 'sigm'"),
        ({"record": ["nope"]}, DesireError, "'nope' is to be recorded"),
        ({"initial": {"z": 1}}, DesireError, "no such state"),
        ({"initial": [1]}, ValueError, "has 2 states"),
        ({"timeout": -1}, ValueError, "timeout=-1"),
        ({"t": 5}, TypeError, "t is a pair"),
        ({"record": 3}, TypeError, "record is a name or a list of names, not 3"),
        ({"record": ["xdt"]}, DesireError, "did you mean 'xdot'"),
        ({"initial": {"z": 1}}, DesireError, "its states are x, y"),
        ({"on_block": 3}, TypeError, "on_block is a function or None"),
        ({"a": "many"}, ValueError, "many"),
        ({"a": float("nan")}, ValueError, "a cannot be nan"),
    ],
)
def test_wrong_arguments(decay, arguments, kind, words):
    with pytest.raises(kind, match=re.escape(words)):
        decay.run(**arguments)
    assert decay.run()["x"][0] == 1


def test_mistakes_of_a_program_are_raised_by_load_with_their_place(tmp_path):
    path = tmp_path / "wrong.src"
    path.write_text("TMAX = 1\ndrun\nDYNAMIC\nd/dt x = y\n")
    with pytest.raises(DesireError) as caught:
        desire_tui.load(path)
    error = caught.value
    assert (error.number, error.line, error.column) == (200, 4, 10)
    assert error.file is not None
    assert error.file.endswith("wrong.src")
    assert str(error).splitlines()[1:3] == ["    d/dt x = y", "             ^"]
    with pytest.raises(ValueError, match="did you mean 'native'"):
        desire_tui.load(path, backend="nativ")


def test_a_run_that_fails_keeps_its_samples():
    model = desire_tui.load(
        "TMAX = 2 | DT = 0.01 | NN = 201 | x = 1\ndrun\nDYNAMIC\nd/dt x = x*x\nz = ln(1.5 - t)\ndispt x, z\n"
    )
    run = model.run(set={"DT": 0.001})
    assert run.ended == "failed"
    assert run.error is not None
    assert 100 <= len(run["t"]) < 201
    with pytest.raises(DesireError):
        model.run(check=True)


def test_states_and_quantities_that_are_not_there_are_named(decay):
    with pytest.raises(desire_tui.DesireError, match="'xx'"):
        decay.run(initial={"xx": 1})
    with pytest.raises(desire_tui.DesireError, match="'nothing'"):
        decay.run(record=["nothing"])
