"""Whatever the text, the analysis answers with problems, never with a Python error."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from desire_tui.engine.check.checker import check
from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from tests.strategies import programs
from tests.syntax.format.program import format_program

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(ROOT.glob("examples/**/*.src"))

PIECES = [
    "d/dt x = ", "Vector v = ", "Vectr d/dt s = ", "MATRIX W = ", "DELTA W = ", "DOT q = ", "y = ", "v[2] = ", "term ",
    "if ", "else", "end if", "OUT", "step", "SAMPLE 2", "store X = ", "get y = ", "tdelay y = X(", "dispt ", "osc(",
    "FUNCTION f(a$) = ", "ARRAY ", "STATE ", "drun", "DYNAMIC", "label two", "JACOBIAN", "SUBMODEL osc(p$, q$)", "end",
    "x", "y", "v", "s", "W", "A", "X", "f(x)", "f(v)", "osc(x, y)", "A*v", "A%*s", "v{1}", "W#", "u*v", "u & v", "v*1",
    "1", "0.5", "-3", "n", "[n]", "[2,3]", " + ", " * ", "^2", ", ", "; ", "func1(x; X)", "ran()", "sin(", ")", "'t'",
    "INTEGER k", "COMPLEX z", "CLEARN v = W(u) 0.1, 0", "SHOW W, 3", "trkhld x, y = 1, 2",
]  # fmt: skip
texts = st.lists(st.one_of(st.sampled_from(PIECES), st.just("\n"), st.just("\n")), max_size=40).map("".join)


def check_is_calm(text):
    program = parse(Source(text, "t"))
    for problem in check(program):
        assert problem.message
        assert problem.code > 0
        assert problem.span is None or 0 <= problem.span.start <= problem.span.end <= len(text) + 1
    state_order(program)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(texts)
def test_random_pieces(text):
    check_is_calm(text)


@settings(max_examples=150, deadline=None)
@given(texts)
def test_random_segments_behind_a_sound_script(text):
    check_is_calm(
        "n = 3 | x = 1\nARRAY v[n], u[n], A[n,n], W[n,n], X[4]\nSTATE s[n]\nFUNCTION f(a$) = a$^2\n"
        "SUBMODEL osc(p$, q$)\nd/dt p$ = q$\nend\ndrun\nDYNAMIC\n" + text
    )


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_have_no_problems(path):
    assert not check(parse(Source(path.read_text(encoding="utf-8"), path.name)))


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(EXAMPLES),
    st.integers(0, 10**6),
    st.integers(0, 12),
    st.sampled_from(["", "x", " ", "[", ")"]),
)
def test_damaged_examples(path, at, length, put):
    text = path.read_text(encoding="utf-8")
    at %= len(text)
    check_is_calm(text[:at] + put + text[at + length :])


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(programs())
def test_any_tree(program):
    check_is_calm(format_program(program))
