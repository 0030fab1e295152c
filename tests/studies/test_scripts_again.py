"""Scripts run again and again in one session give what a session of its own gives each run."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.session import kept_expressions
from desire_tui.studies.script_program import ScriptProgram
from desire_tui.studies.task import Task

HEAD = "DT = 0.01 | TMAX = 0.5 | NN = 11 | x = 1 | v = 0 | k = 3 | c = 0\n"
SPRING = "d/dt x = v\nd/dt v = -k*x\ndispt x\n"
AGAIN = "x = 1 | v = 0 | t = 0\n"
SCRIPTS = {
    "two runs": f"drun\nk = k + x\n{AGAIN}drun\nDYNAMIC\n" + SPRING,
    "sizes that vary": f"n = 10*m | ARRAY a[n], b[3] | a[1] = k | b[2] = 5\ndrun\n{AGAIN}drun\nDYNAMIC\nc = b[2] + x\n" + SPRING,
    "numbers compiled in": f"ARRAY a[9] | for i = 1 to 9 | a[i] = i | next\ndrun\n{AGAIN}drun\nDYNAMIC\nc = a[m]\n" + SPRING,
    "segments and rules": f"drun\nirule 3\n{AGAIN}drun P\nirule m\n{AGAIN}drun\nDYNAMIC\n{SPRING}label P\nd/dt x = -k*x\nc = x\n",
    "names that not every run makes": f"if m > 4 then q = 2 | k = k + q | else proceed\ndrun\n{AGAIN}w = x\ndrun\nDYNAMIC\n"
    + SPRING,
    "events": f"drun\n{AGAIN}ARRAY z[4] | z[1] = 7\ndrun\nk = k + z[1]\nDYNAMIC\n{SPRING}event x - 0.5\nv = 0.9*v | c = c + 1\n",
    "random numbers": f"k = 3 + ran()\ndrun\n{AGAIN}drun\nDYNAMIC\n{SPRING}OUT\nc = c + ran()\n",
    "a delay line": f"ARRAY D[9] | q = 0\ndrun\n{AGAIN}drun\nDYNAMIC\ndelay q = D(x, 0.1)\nc = q\n" + SPRING,
}  # fmt: skip


@pytest.mark.parametrize("name", SCRIPTS)
def test_runs_are_those_of_sessions_of_their_own(name):
    script = f"m = 3\n{HEAD}{SCRIPTS[name]}"
    task = Task(script, "<text>", None, "x[end], max(c), k[end]", ("m",), seed=5)
    rows = np.array([3.0, 5, 5, 3, 2, 5])[:, None]
    found = ScriptProgram(task).chunk(0, rows, lambda: False)
    alone = [
        ScriptProgram(task).chunk(number, rows[number : number + 1], lambda: False)
        for number in range(len(rows))
    ]
    assert not found.errors.any()
    assert np.array_equal(found.numbers, np.concatenate([each.numbers for each in alone]))


def test_segments_are_lowered_once(monkeypatch):
    made = []
    lower = kept_expressions.lower
    monkeypatch.setattr(kept_expressions, "lower", lambda *given: made.append(given) or lower(*given))
    task = Task(HEAD + SCRIPTS["two runs"], "<text>", None, "x[end]", ("k",), seed=5)
    program = ScriptProgram(task)
    for _ in range(2):
        program.chunk(0, np.array([3.0, 4, 5])[:, None], lambda: False)
    assert len(made) == 1
