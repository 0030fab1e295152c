"""`desire_tui.run`: the same content as the JSON, as NumPy arrays."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.diagnostics import DesireError

DECAY = "TMAX = 1 | DT = 0.01 | NN = 11 | x = 1 | a = 1\nARRAY v[3] | v[2] = 4\ndrun\nwrite x\nDYNAMIC\nd/dt x = -a*x\nz = 2*x\ndispt x, z\n"


def test_curves_and_quantities():
    result = desire_tui.run(DECAY)
    assert result.status == "done"
    run = result.runs[0]
    assert run["x"] == pytest.approx(np.exp(-run.t), abs=1e-5)
    assert run["z"] == pytest.approx(2 * run["x"])
    assert result["v"].tolist() == [0, 4, 0]
    assert result["x"] == run["x"][-1]
    assert result.console.startswith("0.36788")
    with pytest.raises(KeyError):
        run["nope"]


def test_settings():
    assert desire_tui.run(DECAY, set={"a": 0})["x"] == 1.0
    result = desire_tui.run("input k | write 2*k\nSTOP\nwrite 'after'\n", input=["21"], go=True)
    assert result.console.split("\n") == ["k ? 21", "42", "after", ""]
    with pytest.raises(TypeError):
        desire_tui.run(DECAY, colour="red")


def test_settings_that_cannot_be():
    for wrong, kind, words in (
        ({"sett": {"a": 1}}, TypeError, "did you mean 'set'"),
        ({"backend": "nativ"}, ValueError, "did you mean 'native'"),
        ({"timeout": -1}, ValueError, "timeout=-1"),
        ({"timeout": "5"}, TypeError, "timeout is a number"),
        ({"input": "21"}, TypeError, "input is a list of lines"),
        ({"set": {"aa": 1}, "check": True}, DesireError, "'aa'"),
    ):
        with pytest.raises(kind, match=words):
            desire_tui.run(DECAY, **wrong)
    with pytest.raises(ValueError, match="'nativ' is unknown"):
        desire_tui.Session(backend="nativ")


def test_answers_may_come_from_a_generator():
    text = "input a | input b\nwrite a + b\n"
    assert [desire_tui.run(text, input=(str(k) for k in (1, 2)))["b"] for _ in range(3)] == [2, 2, 2]


def test_mistakes_do_not_raise():
    result = desire_tui.run("x = nope + 1\n")
    assert result.status == "failed"
    assert result.problems[0].code == 200
    assert (result.problems[0].line, result.problems[0].column) == (1, 5)


def test_a_stop_without_go():
    assert desire_tui.run("x = 1\nSTOP\nx = 2\n").status == "stopped"


def test_a_file(tmp_path):
    path = tmp_path / "p.src"
    path.write_bytes("-- caf\xe9\nx = 1\n".encode("latin-1"))
    assert desire_tui.run(path)["x"] == 1
    with pytest.raises(DesireError) as caught:
        desire_tui.run(str(tmp_path / "missing.src"))
    assert "error 38" in str(caught.value)


def test_both_back_ends_agree():
    native = desire_tui.run(DECAY)
    reference = desire_tui.run(DECAY, backend="reference")
    assert native.runs[0]["x"] == pytest.approx(reference.runs[0]["x"], rel=1e-13)
