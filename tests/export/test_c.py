"""Runs exported to C, compiled by the machine's compiler: the engine's samples, bit for bit."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import desire_tui
from desire_tui.cli import main
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Source
from desire_tui.export.c.content import content
from desire_tui.export.c.expressions import bare, number
from desire_tui.export.formats import Export

SCALAR = """a = 0.7 | b = -0.3 | x = 0.4 | y = 1.2 | z = 0 | q = 0 | hold = 0 | last = 0 | delayed = 0
ARRAY F[8], past[40], buffer[30]
data 0, 1, 2, 4 | data 1, 3, 2, 5 | read F
TMAX = 4 | DT = 0.01 | NN = 101 | irule {rule} | MM = 1
drun
DYNAMIC
u = sin(a*t) + cos(t)*tan(0.1*t) - exp(-t)/(1 + t^3)
w = func1(t; F) + atan2(x, y + 2) + sqrt(abs(x)) + ln(2 + t) + log(3 + t) + (abs(x) + 1)^1.5
s = sat(x) + SAT(y) + deadz(2*x) + lim(b) + sinc(t - 1) + sigmoid(x) + SIGMOID(y) + tri(x)
k = sgn(b) + rect(x) + comp(b, 2, 3) + swtch(a) + round(1.5*a) + trnc(2.7*a) + max(x, y) + min(x, y)
d/dt x = -a*x + 0.1*u
d/dt y = x - 0.3*y*abs(y) + 0.01*w + 0.001*(s + k)
OUT
z = x*y + sinh(x) - cosh(y) + tanh(x) + asin(0.1) + acos(0.2) + atan(y)
SAMPLE 5
q = q + x
dispt x, y, z, q, u, w, s, k
"""
MEMORY = """x = 1 | v = 0 | y = 0 | y0 = 0 | last = 0 | n = 0
ARRAY buffer[30], X[60], Y[60]
for i = 1 to 60 | Y[i] = i^2 | next
TMAX = 2 | DT = 0.01 | NN = 41 | irule 3 | SEED 7
drun
DYNAMIC
tdelay late = buffer, x, 0.105
d/dt x = v
d/dt v = -x - 0.1*late
noise = ran() - 2*ran() + gauss(0)
trkhld y, y0 = sin(20*t), x
step
n = n + swtch(x)
OUT
store X = x
get m = Y
term t - 1.7
dispt x, late, noise, y, n, m
"""
VECTORS = """n = 5 | ARRAY x[5], A[5,5], h[5], m[5], r[3], B[3,5]
for i = 1 to 5 | x[i] = 0.3*i - 1 | h[i] = 1/i | m[i] = trnc(i/4) | next
for i = 1 to 5 | for k = 1 to 5 | A[i,k] = sin(i + 2*k) | next | next
for i = 1 to 3 | for k = 1 to 5 | B[i,k] = i - 0.4*k | next | next
TMAX = 2 | DT = 0.01 | NN = 21 | irule 3
drun
DYNAMIC
Vectr d/dt x = A*x - 0.5*x + h
Vector h = 0.1*sin(x) + x{1}
Vector r = B*x
DOT e = x*x
AVG f = h*x
dispt x[1], x[5], e, f, r[2], h[3]
"""
POINTS = """x = 0.3 | r = 3.7 | NN = 50
drun
DYNAMIC
x = r*x*(1 - x)
dispt x
"""


def compiled(text: str, folder: Path) -> tuple[list[str], np.ndarray]:
    """Return the heads and the samples that the compiled file writes."""
    file = folder / "model.c"
    file.write_bytes(content(Export(Source(text, "model.src"))))
    flags = [
        "-std=c99",
        "-O2",
        "-ffp-contract=off",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Werror",
        "-Wno-unused-function",
    ]
    subprocess.run(
        ["cc", *flags, str(file), "-o", str(folder / "model"), "-lm"], check=True, capture_output=True
    )
    lines = subprocess.run(
        [str(folder / "model")], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    return lines[0].split(","), np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])


@pytest.mark.parametrize("rule", [1, 2, 3, 5])
def test_functions_and_rules(rule, tmp_path):
    text = SCALAR.format(rule=rule)
    heads, table = compiled(text, tmp_path)
    run = desire_tui.load(text).run()
    assert heads == list(run)
    for column, name in enumerate(heads):
        assert np.array_equal(table[:, column], run[name]), name


@pytest.mark.parametrize("rule", [4, 7, 8])
def test_rules_that_control_their_steps(rule, tmp_path):
    text = f"""a = 3 | x = 2 | v = 0 | n = 0 | TMAX = 8 | DT = 0.1 | NN = 81 | irule {rule} | ERMAX = 1e-5
drun
DYNAMIC
d/dt x = v
d/dt v = a*(1 - x^2)*v - x + 0.001*n
step
n = n + 1
dispt x, v, n
"""
    heads, table = compiled(text, tmp_path)
    run = desire_tui.load(text).run()
    for column, name in enumerate(heads):
        assert np.array_equal(table[:, column], run[name]), name


@pytest.mark.parametrize("text", [MEMORY, POINTS], ids=["memory", "points"])
def test_what_is_remembered_and_drawn(text, tmp_path):
    heads, table = compiled(text, tmp_path)
    run = desire_tui.load(text).run()
    for column, name in enumerate(heads):
        assert np.array_equal(table[:, column], run[name]), name


def test_vectors_to_rounding(tmp_path):
    """Sums over elements are added in another order than in the engine's vector code."""
    heads, table = compiled(VECTORS, tmp_path)
    run = desire_tui.load(VECTORS).run()
    for column, name in enumerate(heads):
        assert table[:, column] == pytest.approx(run[name], rel=1e-12, abs=1e-14), name


def test_all_that_has_no_form_is_named_at_once():
    text = """x = 1 | y = 0 | TMAX = 1 | DT = 0.01 | NN = 11 | irule 15
drun
DYNAMIC
d/dt x = -delay(x, 0.1)
event x - 0.5
y = 1
end event
dispt x
"""
    with pytest.raises(DesireError) as error:
        content(Export(Source(text, "model.src")))
    told = [problem.message for problem in error.value.diagnostics]
    assert told == [
        "irule 15 (Gear; differences) has no form in C here",
        "'event' has no form in C here",
        "delay(x, tau) has no form in C here",
    ]
    places = [text[p.span.start : p.span.end] for p in error.value.diagnostics if p.span is not None]
    assert places[0].startswith("event")


def test_steps_beyond_samples_have_no_form():
    text = """x = 1 | TMAX = 1 | DT = 0.01 | NN = 11 | irule 4 | DTMAX = {dtmax}
drun
DYNAMIC
d/dt x = -x
dispt x
"""
    with pytest.raises(DesireError) as error:
        content(Export(Source(text.format(dtmax=0.5), "model.src")))
    (problem,) = error.value.diagnostics
    assert problem.message == "irule 4 with steps beyond communication points has no form in C here"
    content(Export(Source(text.format(dtmax=0.1), "model.src")))


def test_a_run_that_fails_says_so(tmp_path):
    text = "x = 1 | TMAX = 5 | DT = 0.01 | NN = 51\ndrun\nDYNAMIC\nd/dt x = x*x\ndispt x\n"
    (tmp_path / "m.c").write_bytes(content(Export(Source(text, "m.src"))))
    subprocess.run(["cc", str(tmp_path / "m.c"), "-o", str(tmp_path / "m"), "-lm"], check=True)
    ended = subprocess.run([str(tmp_path / "m")], capture_output=True, text=True, check=False)
    assert ended.returncode == 1
    assert "the run ended at t = " in ended.stderr


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("circle.src").write_text(POINTS)
    shown = CliRunner().invoke(main, ["export", "circle.src", "--c"], catch_exceptions=False)
    assert (shown.exit_code, shown.output) == (0, "circle.c\n")
    shown = CliRunner().invoke(
        main, ["export", "circle.src", "-o", "x.c", "--set", "r=3.5"], catch_exceptions=False
    )
    assert "3.5" in Path("x.c").read_text()
    shown = CliRunner().invoke(main, ["export", "circle.src"])
    assert shown.exit_code == 2
    assert "one format is to be chosen: --c" in shown.output


def test_texts():
    assert [bare(text) for text in ("(a + b)", "(a) + (b)", "x", "(x)")] == ["a + b", "(a) + (b)", "x", "x"]
    assert [number(value) for value in (0.1, -2.0, float("inf"), -0.0)] == [
        "0.1",
        "(-2.0)",
        "INFINITY",
        "(-0.0)",
    ]
