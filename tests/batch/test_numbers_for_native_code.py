"""Numbers that a program hands to integers of native code: what does not fit is a message, never a crash."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import desire_tui
from tests.batch.command_line import ROOT, desire

MODEL = "TMAX = 1 | NN = 11\n{}\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
HUGE = ["2^54", "2^63", "2^64", "1e300"]
BACKENDS = ["native", "reference"]


COUNTS = {f"{name} = {value}": name for name in ("MM", "NN") for value in HUGE}
APART = """\
import json
import sys

from tests.batch.command_line import desire

for text in json.load(sys.stdin):
    print(json.dumps(desire("run", "-", "--backend", "native", text_in=text)), flush=True)
"""


def assert_refused(name, status, errors):
    assert status == 1
    assert f"error 87: {name} = " in errors


def test_settings_that_count_in_native_code():
    """In a process of their own: a fault kills only that."""
    done = subprocess.run(
        [sys.executable, "-c", APART],
        input=json.dumps([MODEL.format(setting) for setting in COUNTS]),
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert (done.returncode, len(answers)) == (0, len(COUNTS)), (done.stderr, answers[-1:])
    for name, (status, _, errors) in zip(COUNTS.values(), answers, strict=True):
        assert_refused(name, status, errors)


@pytest.mark.parametrize("setting", COUNTS)
def test_settings_that_count_in_the_reference(setting):
    status, _, errors = desire("run", "-", "--backend", "reference", text_in=MODEL.format(setting))
    assert_refused(COUNTS[setting], status, errors)


@pytest.mark.parametrize("value", HUGE)
@pytest.mark.parametrize(
    "line",
    ["CHECKN = {} | irule 4", "irule {}", "SEED {}", "plot 0, 0, {}", "display N {}", "display C {}",
     "ARRAY a[{}]", "ARRAY a[2] | SHOW a, {}", "ARRAY a[2] | SHOW a[{}], 2", "connect 'f' as input {}", "write #{}, 1",
     "write ${}", "ARRAY a[2] | a[{}] = 1"],
)  # fmt: skip
def test_numbers_of_scripts(line, value):
    result = desire_tui.run(MODEL.format(line.format(value)))
    assert result.status == "failed"
    assert "internal" not in result.problems[-1].message


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("value", HUGE)
def test_a_shift_beyond_the_vector_leaves_zeroes(value, backend):
    text = (
        "ARRAY x[5], y[5], z[5] | NN = 2 | k = {0}\nVector x = 1\nVector z = x{{k}} + x{{-k}}\ndrun\nDYNAMIC\n"
        "Vector x = 1\nVector y = x{{-k}} + x{{{0}}}\ny1 = y[1] + y[5]\ndispt y1\n"
    )
    result = desire_tui.run(text.format(value), backend=backend)
    assert result.status == "done", result.problems
    assert not np.any(result["y"]), result["y"]
    assert not np.any(result["z"])


@pytest.mark.parametrize("backend", BACKENDS)
def test_shifts_are_rounded_alike_in_scripts_and_segments(backend):
    text = (
        "ARRAY x[5], y[5], z[5] | NN = 2 | k = 2.5\ndata 1, 2, 3, 4, 5 | read x\nVector z = x{k}\ndrun\nDYNAMIC\n"
        "Vector y = x{k}\ny1 = y[1]\ndispt y1\n"
    )
    result = desire_tui.run(text, backend=backend)
    assert result["y"].tolist() == result["z"].tolist() == [4, 5, 0, 0, 0]


@pytest.mark.parametrize("value", HUGE)
def test_delays_and_samples(value):
    delay = f"TMAX = 1e-250 | NN = 11 | ARRAY D[4] | tau = {value}\ndrun\nDYNAMIC\nd/dt x = 1\ndelay y = D(x, tau)\ndispt y\n"
    result = desire_tui.run(delay)
    assert [p.code for p in result.problems] == [105]
    result = desire_tui.run(f"NN = 3\ndrun\nDYNAMIC\ny = 1\ndispt y\nSAMPLE {value}\nz = 1\n")
    assert [p.code for p in result.problems] == [44]


@pytest.mark.parametrize(
    "line", ["i = 2^53 + 2", "i = -2^60", "for i = 2^60 to 2^60 + 1 | next", "read i", "i = 1e300"]
)
def test_integers_end_where_doubles_skip_some(line):
    result = desire_tui.run(f"INTEGER i\ndata 2^70\n{line}\nwrite i\n")
    assert [p.code for p in result.problems] == [20]


def test_products_of_integers_do_not_show_digits_that_nobody_knows():
    result = desire_tui.run("INTEGER i, k\ni = 94906267 | k = 3\nwrite i*i\nwrite i*k\n")
    assert result.console == "9.0072e+15\n284718801\n"


@pytest.mark.parametrize("rule", [1, 2, 3, 4, 5, 7, 8, *range(9, 17)])
@pytest.mark.parametrize("backend", BACKENDS)
def test_t_too_large_for_its_steps(rule, backend):
    script = f"irule {rule} | ERMAX = 0.001 | t = 1E15 | DT = 0.01 | TMAX = 1 | NN = 101\n"
    result = desire_tui.run(f"{script}drun\nDYNAMIC\nd/dt x = 1\ndispt x\n", backend=backend)
    assert [p.code for p in result.problems] == [87]
    assert "t = 1e+15 is too large" in result.problems[0].message


@pytest.mark.parametrize("backend", BACKENDS)
def test_t_too_large_without_a_rule(backend):
    result = desire_tui.run("t = 1E16 | NN = 5 | TMAX = 4\ndrun\nDYNAMIC\ny = t\ndispt y\n", backend=backend)
    assert [p.code for p in result.problems] == [87]


@pytest.mark.parametrize("rule", [2, 3, 5])
@pytest.mark.parametrize("backend", BACKENDS)
def test_a_step_made_too_small_to_move_t(rule, backend):
    text = (
        "irule {} | TMAX = 1 | DT = 0.01 | NN = 11 | t = 1\ndrun\nDYNAMIC\nd/dt x = 1\nDT = 1E-20\ndispt x\n"
    )
    result = desire_tui.run(text.format(rule), backend=backend, timeout=300)
    assert [p.code for p in result.problems] == [87]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(
    "call", ["func1(u; F)", "func2(u, u; G, P, Q)"],
)  # fmt: skip
@pytest.mark.parametrize("script", [True, False])
def test_breakpoints_that_fall(backend, call, script):
    text = (
        "ARRAY X[3] + Y[3] = F, G[2,2], P[2], Q[2] | NN = 3 | u = 0.5\ndata 1, 0, 2, 5, 7, 1\nread F\n"
        f"Q[1] = 1\n{f'y = {call}' if script else ''}\ndrun\nDYNAMIC\ny = {call}\ndispt y\n"
    )
    result = desire_tui.run(text, backend=backend)
    assert [p.code for p in result.problems] == [44]
    assert "breakpoint 2 of '" in result.problems[0].message


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_table_made_by_its_segment_is_its_own_affair(backend):
    text = (
        "ARRAY X[2] + Y[2] = F, R[4] | NN = 3\ndata 0, 2, 5, 7 | read R\nX[1] = 1\ndrun\nDYNAMIC\nVector F = R\n"
        "y = func1(1; F)\ndispt y\n"
    )
    assert desire_tui.run(text, backend=backend).runs[0]["y"].tolist() == [6, 6, 6]


@pytest.mark.parametrize("digits", [16, 20, 400, 4400])
def test_subscripts_of_settings(digits):
    """No number holds them, and Python reads no more than 4300 digits."""
    result = desire_tui.run("ARRAY a[3]\na[1] = 2\n", set={f"a[{'9' * digits}]": 1})
    assert [problem.code for problem in result.problems] == [2]
