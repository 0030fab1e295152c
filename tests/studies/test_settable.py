"""What values a study may give: those that would do nothing are refused before its first run."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError

HEAD = "k = 3 | e = 0 | x = 1 | DT = 0.01 | TMAX = 1 | NN = 11 | ARRAY y[3], w[3], m[3], B[9]\n"
COMPUTED = {
    "a defined variable": ("e", "e = k*x\nd/dt x = -e"),
    "one that is computed again": ("e", "e = k*x\ne = e + 1\nd/dt x = -e"),
    "in front of conditions": ("e", "e = k\nif x - 0.5\nd/dt x = -e\nelse\nd/dt x = e\nend if"),
    "a vector's element": ("y[2]", "Vector y = k*w + 1\nd/dt x = -y[2]"),
    "an element alone": ("y[2]", "y[2] = k*x\nd/dt x = -y[2]"),
    "a clock's start": ("e", "e = 0.3\nd/dt x = -x\nevery 0.5, e\nx = x + 1"),
    "a product": ("e", "DOT e = w*m\nd/dt x = e - x"),
}
READ = {
    "a parameter": ("e", "d/dt x = -e"),
    "before it is assigned": ("e", "d/dt x = -e\ne = k*x"),
    "by itself": ("e", "e = 0.5*e + x\nd/dt x = -e"),
    "in a branch": ("e", "if 0.5 - x\ne = k\nend if\nd/dt x = -e"),
    "at communication points": ("e", "d/dt x = -e\nOUT\ne = 0.5*x"),
    "as what grows": ("y[2]", "Vectr delta y = 0*w\nd/dt x = -y[2]"),
    "by a delay's time": ("e", "tdelay q = B(x, e/50)\ne = k\nd/dt x = -q - e*0"),
    "by a delay's history": ("e", "d/dt x = -delay(x + e, 0.5)\ne = k"),
}


def program(body, script=""):
    return f"{HEAD}{script}drun\nDYNAMIC\ndispt x\n{body}\n"


def ends(text, name):
    """Return the curves of two runs with the values 1 and 2."""
    return [desire_tui.run(text, set={name: value}).runs[0]["x"] for value in (1, 2)]


@pytest.mark.parametrize("case", COMPUTED)
def test_what_the_segment_computes_anyway_is_refused(case):
    name, body = COMPUTED[case]
    text = program(body)
    assert np.array_equal(*ends(text, name)), "nothing would have varied"
    for settings in ({"over": {name: [1, 2]}}, {"points": {name: [1, 2]}}):
        with pytest.raises(DesireError, match="is computed here in every run") as error:
            desire_tui.study(text, keep="x[end]", **settings)
        (problem,) = error.value.diagnostics
        assert problem.code == 517
        assert problem.line == text[: text.index(body)].count("\n") + 1


@pytest.mark.parametrize("case", READ)
def test_what_is_read_before_it_is_assigned_varies(case):
    name, body = READ[case]
    text = program(body)
    assert not np.array_equal(*ends(text, name))
    found = desire_tui.study(text, over={name: [1, 2]}, keep="x[end]")["x[end]"].values
    assert found.tolist() == [curve[-1] for curve in ends(text, name)]


def test_what_the_script_computes_from_a_defined_variable_varies():
    text = program("e = k*x\nd/dt x = -e", "k = 2*e\n")
    found = desire_tui.study(text, over={"e": [1, 2]}, keep="x[end]")["x[end]"].values
    assert found.tolist() == [curve[-1] for curve in ends(text, "e")]


def test_the_hint_names_what_can_vary():
    with pytest.raises(DesireError) as error:
        desire_tui.study(program("e = k*sin(x)\nd/dt x = -e"), over={"e": [1, 2]}, keep="x[end]")
    assert error.value.diagnostics[0].hint == "vary what it is computed from: k, x"
    with pytest.raises(DesireError) as error:
        desire_tui.study(program("e = 4\nd/dt x = -e"), over={"e": [1, 2]}, keep="x[end]")
    assert "out of the DYNAMIC segment" in error.value.diagnostics[0].hint


@pytest.mark.parametrize("script", ["", "drun\nt = 0\n"], ids=["one run", "two runs"])
def test_elements_that_no_run_has_are_refused(script):
    text = program("d/dt x = -y[3]", script)
    for name, code in (("y[4]", 2), ("y[0]", 2), ("y[1,2]", 53)):
        with pytest.raises(DesireError) as error:
            desire_tui.study(text, over={name: [1, 2]}, keep="x[end]")
        (problem,) = error.value.diagnostics
        assert (problem.code, problem.line) == (code, 1)
    assert not desire_tui.study(text, over={"y[3]": [1, 2]}, keep="x[end]").attrs["failed"]


def test_sizes_that_the_script_computes():
    text = program("d/dt x = -a[1]", "n = 2\nARRAY a[n + 1]\n")
    with pytest.raises(DesireError, match="subscript 4 is not between 1 and 3"):
        desire_tui.study(text, over={"a[4]": [1, 2], "k": [1, 2]}, keep="x[end]")
    found = desire_tui.study(text, over={"a[4]": [1, 2], "n": [2, 3]}, keep="x[end]")
    assert found["error"].values.tolist() == [[2, 0], [2, 0]], "only where there are fewer"
