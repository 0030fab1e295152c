"""Which names a statement gives a value: `nodes.names`."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.nodes.names import assigned, declared, dummies, invocation
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse_command

TARGETS = {
    "x = y": ["x"],
    "A[k] = y": ["A"],
    "d/dt x = y": ["x"],
    "DOT s = u*v": ["s"],
    "func y = F(x)": ["y"],
    "for k = 1 to n": ["k"],
    "read a, B[i]": ["a", "B"],
    "input #2, a, B": ["a", "B"],
    "call p(a, b; x, Y[2])": ["x", "Y"],
    "get x = X": ["x"],
    "tdelay y = D(x, tau)": ["y"],
    "trkhld y, y0 = p, x": ["y", "y0"],
    "recover x, y": ["x", "y"],
    "stash x, y": [],
    "dispt x, y": [],
    "store X = x": [],
    "write x": [],
    "invoke s(a, b)": [],
}
ARRAYS = {
    "Vector y = v": ["y"],
    "MATRIX W = V": ["W"],
    "Vectr d/dt x = v": ["x"],
    "store X = x": ["X"],
    "tdelay y = D(x, tau)": ["D"],
    "CLEARN v = W(x) lrate, crit": ["v", "W"],
    "FFT F, n, x, y": ["x", "y"],
    "SHOW A": [],
    "x = y": [],
}


def statement(text):
    (placed,), problems = parse_command(Source(text))
    assert not problems, render_all(problems)
    return placed.node


@pytest.mark.parametrize(("text", "names"), TARGETS.items())
def test_targets(text, names):
    assert [target.name for target in assigned(statement(text)).targets] == names


@pytest.mark.parametrize(("text", "names"), ARRAYS.items())
def test_arrays(text, names):
    assert list(assigned(statement(text)).arrays) == names


def test_declared_names_include_those_of_wholes():
    assert declared(statement("ARRAY a[2] + b[3] = ab, c[4]")) == ("a", "b", "ab", "c")


def test_dummies():
    assert dummies(statement("PROCEDURE p(a, b; R)")) == ("a", "b", "R")
    assert dummies(statement("FUNCTION f(a$, b$) = a$*b$")) == ("a$", "b$")


@pytest.mark.parametrize("text", ["invoke s(a, b)", "s(a, b)"])
def test_both_forms_of_an_invocation(text):
    name, arguments = invocation(statement(text))
    assert (name, [argument.name for argument in arguments]) == ("s", ["a", "b"])


def test_other_statements_invoke_nothing():
    assert invocation(statement("x = s(a, b)")) is None
