"""Runs in lock step give the bits of runs made alone, whatever differs between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from desire_tui.engine.codegen.lanes import shared_values
from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.studies import chunk as chunks
from desire_tui.studies.chunk import run_chunk
from desire_tui.studies.prepared_program import PreparedProgram
from desire_tui.studies.streams import streams
from desire_tui.studies.task import Task

HEAD = "k = 3 | r = 0.1 | DT = 0.01 | TMAX = 2 | NN = 21 | x = 1 | v = 0 | SEED 3\n"
RUNS = 37
"""More than go side by side."""
SPRING = "d/dt x = v\nd/dt v = -k*x - r*v\n"
FUNCTIONS = [
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "ln",
    "log",
    "sqrt",
    "abs",
    "sat",
    "SAT",
    "lim",
    "deadz",
    "deadc",
    "swtch",
    "sgn",
    "rect",
    "tri",
    "sinc",
    "sigmoid",
    "SIGMOID",
    "round",
    "trnc",
    "recip",
]

VECTORS = (
    "STATE y[5] | ARRAY w[5], s[5] | for i = 1 to 5 | y[i] = 0.1*i | w[i] = 0.3*i | next\ndrun\nDYNAMIC\n"
)
MODELS = {
    "RK2": "drun\nDYNAMIC\n" + SPRING,
    "Euler": "irule 2\ndrun\nDYNAMIC\n" + SPRING,
    "RK4": "irule 3\ndrun\nDYNAMIC\n" + SPRING,
    "rule 5": "irule 5\ndrun\nDYNAMIC\n" + SPRING,
    "follows": "w = 2*k + r | TMAX = 1\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -w*x\n",
    "a state that all share": "s = 1\ndrun\nDYNAMIC\nd/dt s = -s*cos(t)\n" + SPRING + "y = s + x\n",
    "every function": "drun\nDYNAMIC\n"
    + SPRING
    + "y = 0\n"
    + "".join(f"y = y + {name}(0.9*x)\n" for name in FUNCTIONS)
    + "y = y + max(x, v) + min(x, k) + comp(x, v, k) + atan2(v, k) + abs(x)^1.7 + x^3 + x^(-2) + k^x\n",
    "tables": "ARRAY f[8] | data -1, 0, 0.5, 1, 3, 1, -2, 0 | read f | ARRAY F[2,2], X[2], Y[2]\n"
    "F[1,1] = 1 | F[1,2] = 3 | X[2] = 1 | Y[2] = 2\n"
    "drun\nDYNAMIC\n" + SPRING + "y = func1(x; f) + func1(sin(t); f)\nz = func2(x, v; F, X, Y)\n",
    "if": "c = 0 | f = 0\ndrun\nDYNAMIC\nd/dt x = v\nif x > 0\nf = -k*x\nelse\nf = -2*k*x\nif v > 0 | c = c + 1 | end if\n"
    "end if\nif t > 1 | c = c + 0.5 | end if\nd/dt v = f - r*v^3\n",
    "what is remembered": "big = 0 | h = 0 | g = 0 | p = 0 | u = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "big = max(big, x)\ntrkhld h, g = v, x\ntrkhld p, u = sin(5*t), t\nOUT\nn = n + 1\n",
    "step and SAMPLE": "q = 0 | s = 0\ndrun\nDYNAMIC\n" + SPRING + "step\nq = q + x\nSAMPLE 3\ns = x + t\n",
    "noise": "q = 0 | n = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "if x > 0 | n = ran() | end if\nOUT\nq = q + gauss(0) + n\n",
    "term at steps": "n = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "term t - 0.3*k - 0.2345\nterm x - 0.99*k\nOUT\nn = n + 1 | y = x + v\n",
    "term for all at once": "drun\nDYNAMIC\n" + SPRING + "term t - 1.234\n",
    "seldom samples": "MM = 4\ndrun\nDYNAMIC\n" + SPRING + "term t - 0.3*k - 0.2345\n",
    "runs that fail": "drun\nDYNAMIC\nd/dt x = (k - 2)*x*x*x*x\nd/dt v = ln(x - k)\n",
    "gaps": "drun\nDYNAMIC\n" + SPRING + "y = 1/(x*x - x*x) + ln(x)\n",
    "histories": "ARRAY X[15], Y[21], D[9], E[30] | for i = 1 to 21 | Y[i] = 0.1*i | next | for i = 1 to 9 | D[i] = i | next\n"
    "y = 0 | q = 0 | w = 0\ndrun\nDYNAMIC\n" + SPRING + "store X = x\nget y = Y\ndelay q = D(x + v, 0.35)\n"
    "tdelay w = E(x, 0.17)\nz = y + q + w\n",
    "histories and term": "ARRAY X[25], D[9] | q = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "delay q = D(x, 0.2)\nterm t - 0.3*k - 0.2345\nstore X = q\nz = x + q\n",
    "histories that all share": "ARRAY D[9] | q = 0\ndrun\nDYNAMIC\ndelay q = D(sin(t), 0.2)\nd/dt x = -k*x + q\n",
    "clocks": "u = 0 | n = 0 | m = 0 | irule 3\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = u - k*x\ny = x + u\n"
    "every 0.137, 0.05\nu = -2*y*k | n = n + 1 | if x > 0 | v = 0.9*v | end if\nevery 0.3 | m = m + ran()\nOUT\nz = u + m\n",
    "clocks on the grid": "u = 0 | n = 0 | p = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "every 0.05\nu = x - u\nn = n + 1\n"
    "every 0.1, 0.05\np = n + u\nend event\nterm t - 0.3*k - 0.2345\nOUT\nq = u + p\n",
    "clocks and vectors": VECTORS
    + "Vectr d/dt y = w - k*y\n"
    + SPRING
    + "every 0.12\nVector w = y\na = y[1]\nb = w[5] + x\n",
    "clocks without states": "q = 0.3 | n = 0\ndrun\nDYNAMIC\nq = k*q*(1 - q)\nevery 0.25, 0.2\nn = n + q\nOUT\nx = q + t\n",
    "events": "u = 1 | n = 0 | x = 0\ndrun\nDYNAMIC\nd/dt x = (3*u - x)*k\nd/dt v = x - v\nevent x - 1.6\nu = 0 | n = n + 1\n"
    "event 1.2 - x\nu = 1 | n = n + 1\nend event\ny = n + x\n",
    "one event": "n = 0\ndrun\nDYNAMIC\nd/dt x = 5*v\nd/dt v = -5*k*x\nevent x - 0.3\nn = n + 1 | v = 1.1*v\nend event\ny = n + x\n",
    "events of states": "irule 3 | v = 2\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -9.8\nevent -x\nv = -v*(0.6 + 0.1*k) | x = 0\nOUT\nz = x + v\n",
    "events, clocks, noise": "u = 0 | n = 0 | m = 0 | h = 0 | c = 0\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = 0.1*ran() - k*x\n"
    "c = c + 0.1*x\ntrkhld h, n = v, x\nevent v + u\nm = m + ran() | u = 0.5 - u\nevery 0.11\nm = m + 1\nevent sin(5*t)\n"
    "x = x + 0.01*k\nOUT\nz = gauss(0) + m\nterm t - 0.4*k - 0.2345\n",
    "clocks that differ": "u = 0 | n = 0\ndrun\nDYNAMIC\n"
    + SPRING
    + "w = 0.07*k\nevery w, 0.1\nu = x\nn = n + 1\nOUT\nz = u + n\n",
    "an event that stands at 0": "x = 0.5 | v = 1 | a = 0 | n = 0 | DT = 0.25 | NN = 9\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = a\nd/dt y = k*x\n"
    "event x - 1\nv = -v | a = 16 | n = n + 1\n",
    "events that pile up": "x = 0.1\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -9.8\nevent -x\nv = -0.5*v | x = 0\n",
    "delays": "drun\nDYNAMIC\nd/dt x = v - 0.2*delay(v, 0.35)\nd/dt v = -k*delay(x, 0.13)\ny = delay(x*v, 0.2, 1)\nOUT\nz = delay(x, 0.1)\n",
    "delays that differ": "w = 0.1*k\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -k*x + delay(x, w)\ny = delay(v, 0.1 + 0.05*sin(t))\n",
    "delays and events": "u = 0 | NN = 201\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -k*delay(x, 0.05) + delay(u, 0.2)\nevent x\nu = 1\nevent -x\nu = 0\n"
    "event delay(v*x, 0.3) - 0.4\nx = x + 0.1\nend event\nterm t - 0.3*k - 1\ny = u + delay(v*x, 0.307)\n",
    "difference equations": "q = 0.3 | n = 0\ndrun\nDYNAMIC\nq = k*q*(1 - q)\nn = n + ran()\nterm n - 4*k\nOUT\nx = q + t\n",
    "vectors": VECTORS
    + "Vector s = sin(w)*exp(-y) + k\nVectr d/dt y = s - r*y{1} + y{-1}\n"
    + SPRING
    + "a = y[1] + s[3]\nb = y[5]\n",
    "functions of vectors": VECTORS
    + "Vector w = 0.45 + 0.4*cos(y)\nVector s = "
    + " + ".join(f"{name}(w)" for name in FUNCTIONS)
    + " + max(y, w) + abs(y)^1.7 + atan2(y, k)\nVectr d/dt y = tanh(s) + sin(t)*w - k*y\n"
    + SPRING
    + "a = y[1]\nb = y[5] + s[2]\n",
    "matrices": "STATE y[9] | ARRAY W[9,9]\nfor i = 1 to 9 | y[i] = 0.1*i | for j = 1 to 9 | W[i,j] = sin(i*j) | next | next\n"
    "drun\nDYNAMIC\nVectr d/dt y = tanh(W*y) - k*y + 0.1*(W%*y)\n" + SPRING + "a = y[1]\nb = y[9]\n",
    "matrix statements": "STATE P[3,3] | ARRAY A[3,3], Q[3,3], S[2,3], u[2], w[3], z[3] | e = 0 | g = 0\n"
    "for i = 1 to 3 | w[i] = 0.4*i | P[i,i] = i | for j = 1 to 3 | A[i,j] = 0.1*i - 0.2*j | next | next | u[1] = 1 | u[2] = -2\n"
    "drun\nDYNAMIC\nMATRIX Q = A + k*w*w\nMATRIX d/dt P = Q - P\nVector z = P*w\nDELTA S = 0.01*(u & z); -0.02, 0.5\n"
    "DOT e = z*P*w - w*1\nAVG g = w*w\n" + SPRING + "a = P[2,3] + S[2,1]\nb = S[1,3] + z[2] + e + g\n",
    "long sums": "STATE y[21] | ARRAY w[21] | for i = 1 to 21 | y[i] = 0.1*i | w[i] = sin(i) | next\ndrun\nDYNAMIC\n"
    "DOT a = y*w - y*1\nVectr d/dt y = a - k*y + 0.01*ran()\n" + SPRING + "b = y[21]\n",
    "vectors under conditions": VECTORS
    + "if x > 0 | Vector s = y | else | Vector s = 2*y*x | end if\nVectr d/dt y = -s\n"
    + SPRING
    + "OUT\nVectr delta w = 0.1*s\na = w[2] + y[1]\n",
    "noise in vectors": VECTORS
    + "Vectr d/dt y = s - k*y + 0.1*ran()\n"
    + SPRING
    + "a = y[1]\nb = y[5]\nOUT\nVector s = gauss(0) + ran()\nn = ran()\n",
    "functions of what all share": "ARRAY f[8] | data 0, 0.5, 1, 2.5, 1, 3, -2, 0 | read f | u = 0 | z = 0\n"
    "drun\nDYNAMIC\nd/dt x = v\nd/dt v = u*cos(3*t) - k*x + func1(t; f)\n"
    "every 0.137, 0.05\nu = x + sin(t)\nend event\ny = sinc(t) + exp(-t) + t^1.5 + atan2(t, 2)\n"
    "if t > 1 | z = tanh(t - 1) + x | end if\nterm t - 0.3*k - 0.2345\n",
    "nothing random differs but noise": "k = 1 | n = 0\ndrun\nDYNAMIC\nd/dt x = n\nOUT\nn = gauss(0)\n",
}


def names_of(text: str) -> list[str]:
    body = text.partition("DYNAMIC\n")[2].replace(" | ", "\n")
    assigned = [
        line.partition("=")[0].strip().removeprefix("d/dt ") for line in body.split("\n") if "=" in line
    ]
    return [name for name in dict.fromkeys(assigned) if name.isidentifier()]


def kept_of(names: list[str]) -> str:
    each = ", ".join(f"{name}[end], mean({name})" for name in names)
    return each + ", t[end], max(x), x@0:2:0.25, t[x<0.5], integral(x)"


def both(text: str, rows: np.ndarray, keep: str, **settings) -> tuple[chunks.Chunk, chunks.Chunk]:
    """Make the runs both ways; those that fail must be the only ones that lock step leaves to be made alone."""
    task = Task(text, "<text>", None, keep, ("k",), seed=5, **settings)
    with chunks._PROGRAMS.one(task) as program:
        assert isinstance(program, PreparedProgram)
        assert program.lock_step is not None, program.hindrance
        assert (program.lock_step.run(program.settings(rows), None).numbers is None) == ("@" in keep)
        begin = streams(program.first_state(), 0, len(rows))
        left = program.lock_step.run(program.settings(rows), begin).flagged
    found, alone = run_chunk(task, 0, rows), run_chunk(replace(task, lanes=False), 0, rows)
    assert left.tolist() == (alone.errors != 0).tolist()
    return found, alone


@pytest.mark.parametrize("name", MODELS)
def test_the_bits_of_runs_made_alone(name):
    text = HEAD + MODELS[name]
    if "n = n + 1" in text:
        text = text.replace("drun\n", "n = 0\ndrun\n", 1)
    names = names_of(text)
    rows = np.linspace(0.5, 4, RUNS)[:, None]
    found, alone = both(text + f"dispt {names[0]}\n", rows, kept_of(names))
    assert np.array_equal(found.numbers, alone.numbers, equal_nan=True)
    assert np.array_equal(found.errors, alone.errors)
    assert found.failures.by_code == alone.failures.by_code
    assert found.errors.any() == (name in {"runs that fail", "events that pile up"})


def test_what_all_share_is_the_same_where_memory_for_it_ends(monkeypatch):
    text = HEAD + MODELS["functions of what all share"]
    keep, rows = kept_of(names_of(text)), np.linspace(0.5, 4, RUNS)[:, None]
    found, alone = both(text + "dispt x\n", rows, keep)
    for size in (0, 4000):
        monkeypatch.setattr(shared_values, "_BYTES_MOST", size)
        found, _ = both(text + "dispt x\n", rows, keep)
        assert np.array_equal(found.numbers, alone.numbers, equal_nan=True)


@pytest.mark.parametrize(
    "name",
    [
        "RK4",
        "term at steps",
        "seldom samples",
        "gaps",
        "runs that fail",
        "difference equations",
        "events, clocks, noise",
    ],
)
def test_numbers_kept_without_samples(name):
    text = HEAD + MODELS[name]
    if "n = n + 1" in text:
        text = text.replace("drun\n", "n = 0\ndrun\n", 1)
    names = names_of(text)
    keep = ", ".join(
        f"{each}[end], mean({each}), max({each}), min({each}), integral({each})" for each in names
    )
    rows = np.linspace(0.5, 4, 21)[:, None]
    found, alone = both(text + f"dispt {names[0]}\n", rows, f"{keep}, t[x<0.5], t[end]")
    assert np.array_equal(found.numbers, alone.numbers, equal_nan=True)
    assert np.array_equal(found.errors, alone.errors)


def test_functions_of_the_vector_library_are_near():
    text = HEAD + MODELS["every function"] + "dispt x\n"
    found, alone = both(text, np.linspace(0.5, 4, 21)[:, None], "x[end], y@1", fast=True)
    assert found.numbers == pytest.approx(alone.numbers, rel=1e-12, nan_ok=True)


@pytest.mark.parametrize(
    ("text", "names", "why"),
    [
        ("irule 4\ndrun\nDYNAMIC\n" + SPRING, ("k",), "the rule varies its steps"),
        ("drun\nDYNAMIC\n" + SPRING, ("TMAX",), "times or settings of the run vary"),
        ("DT = 0.01*k\ndrun\nDYNAMIC\n" + SPRING, ("k",), "times or settings of the run vary"),
        ("irule 2\ndrun\nDYNAMIC\n" + SPRING + "step\nDT = 0.01\n", ("k",), "the program sets times or settings"),
        ("STATE y[300]\ndrun\nDYNAMIC\nVectr d/dt y = -k*y\n" + SPRING, ("k",), "the model is large"),
        ("ARRAY W[2,2], M[2,2], a[2]\ndrun\nDYNAMIC\nMATRIX W = [M] a*a\n" + SPRING, ("k",), "SetMat statements"),
        ("ARRAY f[4] | f[1] = k | f[2] = 9\ndrun\nDYNAMIC\n" + SPRING + "y = func1(x; f)\n", ("k",), "script has to run"),
        ("ARRAY f[4] | f[2] = 9\ndrun\nDYNAMIC\n" + SPRING + "y = func1(x; f)\n", ("f[3]",), "tables vary"),
        ("ARRAY D[9] | q = 0\ndrun\nDYNAMIC\n" + SPRING + "delay q = D(x, 0.1*k)\n", ("k",), "times of delays differ"),
        ("ARRAY D[9] | q = 0\ndrun\nDYNAMIC\n" + SPRING + "if x > 0 | delay q = D(x, 0.1) | end if\n", ("k",), "under a condition"),
        ("ARRAY D[9] | q = 0\ndrun\nDYNAMIC\n" + SPRING + "delay q = D(x, 0.1)\ny = D[2]\n", ("k",), "used in another way"),
        ("q = 0 | n = 0\ndrun\nDYNAMIC\nq = q + k\nevent q - 5\nn = 1\n", ("k",), "without states"),
        ("q = 0 | n = 0\ndrun\nDYNAMIC\nq = q + k\nevery 0.2*k\nn = 1\n", ("k",), "times of 'every' differ"),
        ("m = 2 | s = 0\ndrun\nDYNAMIC\n" + SPRING + "SAMPLE m\ns = t\n", ("m",), "the script has to run"),
    ],
)  # fmt: skip
def test_what_keeps_runs_from_lock_step(text, names, why):
    program = PreparedProgram(
        Task(HEAD + text + "dispt x\n" * ("d/dt x" in text), "<text>", None, "t[end]", names)
    )
    assert program.lock_step is None
    assert why in program.hindrance


def test_settings_of_all_runs_do_not_keep_them_from_it():
    text = HEAD + "w = 2*k | d = TMAX/2\ndrun\nDYNAMIC\nd/dt x = v - d\nd/dt v = -w*x\ndispt x\n"
    rows = np.linspace(1, 2, 9)[:, None]
    fixed = (("TMAX", 1.0), ("NN", 11.0), ("v", 2.0))
    found, alone = both(text, rows, "x[end], t[end], d[end], v@0", fixed=fixed)
    assert np.array_equal(found.numbers, alone.numbers)
    assert found.numbers[0, 1:].tolist() == [1, 0.5, 2]


def test_numbers_say_whether_they_are_wide():
    assert Number("%x", wide=True).wide
