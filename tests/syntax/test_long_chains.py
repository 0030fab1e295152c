"""Sums and products of any length: no pass recurses along them, and the order of operations stays."""

from __future__ import annotations

from functools import reduce
from math import exp
from random import Random
from time import thread_time

import pytest

from desire_tui.engine.left_chains import chain
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.expressions import Binary
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from tests.programs.execution import execute
from tests.programs.expectations import read_expectations
from tests.programs.runner import faults_of_program
from tests.syntax.format.statements import format_statement

BACKENDS = ["native", "reference"]


def numbers(count: int) -> list[float]:
    random = Random(count)
    return [round(random.uniform(-9, 9), 6) * 10 ** random.randrange(-6, 7) for _ in range(count)]


def summed(terms: list[float]) -> str:
    return "".join(f"{'-' if x < 0 else '+'}{abs(x)!r}*one" for x in terms)


def test_a_chain_of_any_length_is_parsed() -> None:
    began = thread_time()
    program = parse(Source("x = 1" + "+y*z" * 60_000))
    assert not program.problems
    node = program.script[0].node
    assert isinstance(node, Assign)
    first, steps = chain(node.value)
    assert first.end == 5
    assert len(steps) == 60_000
    assert all(step.op == "+" and isinstance(step.right, Binary) for step in steps)
    assert thread_time() - began < 6


def test_a_long_chain_is_written_as_it_was_read() -> None:
    text = "x = " + "(" * 40 + "a" + " + b) * (c - d)" * 40 + " / 2 - (e - f)" * 3_000
    node = parse(Source(text)).script[0].node
    written = format_statement(node)
    assert written == text
    assert parse(Source(written)).script[0].node.value.op == "-"


@pytest.mark.usefixtures("quick_code_only")
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("count", [49, 50, 51, 101, 1500])
def test_sums_are_computed_from_left_to_right(count, backend, tmp_path) -> None:
    """Exactly: 1e16 + 1 - 1e16 is no sum that may be regrouped."""
    terms = numbers(count)
    text = (
        f"one = 1 | NN = 2\ns = 0{summed(terms)}\nARRAY v[2], w[2], A[2,2], B[2,2]\nv[1] = 1 | v[2] = 2\n"
        f"A[1,2] = 1\nVector w = v{summed(terms)}\nMATRIX B = A{summed(terms)}\nb = B[1,2]\n"
        f"drun\nDYNAMIC\ny = 0{summed(terms)}\nVector v = v{summed(terms)}\nMATRIX A = A{summed(terms)}\n"
    )
    outcome = execute(text, backend, tmp_path)
    assert outcome.error is None
    found = outcome.quantities

    def exact(start: float) -> float:
        return reduce(lambda total, x: total + x, terms, start)

    assert found["s"] == found["y"] == exact(0.0)
    assert list(found["w"]) == [exact(1.0), exact(2.0)]
    assert found["b"] == found["B"][0, 1] == exact(1.0)
    twice = [exact(exact(start)) for start in (1.0, 2.0)]
    assert list(found["v"]) == twice


@pytest.mark.usefixtures("quick_code_only")
@pytest.mark.parametrize("backend", BACKENDS)
def test_long_products_of_all_kinds(backend, tmp_path) -> None:
    factor = 1.0 + 2.0**-10
    text = (
        f"q = {factor!r} | NN = 2 | n = 2\nARRAY v[2], u[2], A[2,2]\nA[1,1] = 2 | A[2,2] = 3 | v[1] = 1 | v[2] = 1\n"
        f"s = 1{'*q' * 700}\nd = 1{'/q' * 700}\ndrun\nDYNAMIC\ny = 1{'*q' * 700}\nVector u = A*v{'*q' * 700}\n"
    )
    found = execute(text, backend, tmp_path).quantities
    expected = reduce(lambda total, x: total * x, [factor] * 700, 1.0)
    assert found["s"] == found["y"] == expected
    assert found["d"] == reduce(lambda total, x: total / x, [factor] * 700, 1.0)
    assert list(found["u"]) == [reduce(lambda total, x: total * x, [factor] * 700, c) for c in (2.0, 3.0)]


@pytest.mark.usefixtures("quick_code_only")
@pytest.mark.parametrize("backend", BACKENDS)
def test_random_numbers_are_drawn_from_left_to_right(backend, tmp_path) -> None:
    """The same sums, one draw a statement, from the same SEED."""
    draws = "".join(f"{'+-'[k % 2]}{k}*ran()*(2+ran())" for k in range(1, 200))
    alone = "".join(f"a = ran() | b = 2 + ran() | z = z {'+-'[k % 2]} {k}*a*b\n" for k in range(1, 200))
    text = (
        f"NN = 2 | SEED 5 | x = 0{draws} | x = 0{draws}\nSEED 5\nfor i = 1 to 2 | z = 0\n{alone}\nnext\n"
        f"SEED 5 | drun\nDYNAMIC\ny = 0{draws}\n"
    )
    found = execute(text, backend, tmp_path).quantities
    assert found["x"] == found["z"] == found["y"]


def test_nested_long_chains_with_random_numbers_agree(tmp_path) -> None:
    inner = "(ran()" + "+ran()*0.5" * 90 + ")"
    value = f"ran() + {inner}*{inner} - sin({inner})*ran()"
    text = f"NN = 2\nSEED 9 | x = {value} | x = {value}\nSEED 9 | drun\nDYNAMIC\ny = {value}\n"
    found = execute(text, "native", tmp_path).quantities
    assert found["x"] == found["y"]


def test_elements_of_long_vector_sums_draw_one_by_one(tmp_path) -> None:
    """From the last element down, each its whole row of draws."""
    draws = "+ran()" * 150
    text = (
        f"NN = 2\nARRAY v[3], w[3]\nSEED 3\nfor k = 1 to 2 | for i = 3 to 1 step -1\n w[i] = 0{draws}\n"
        "next | next\nSEED 3 | drun\n"
        f"DYNAMIC\nVector v = 0{draws}\n"
    )
    for backend in BACKENDS:
        found = execute(text, backend, tmp_path).quantities
        assert list(found["v"]) == list(found["w"])
    outcome = execute(text.replace(draws, "+ran()" * 400), "native", tmp_path)
    assert [d.code for d in outcome.error.diagnostics] == [401]


def test_a_long_sum_in_every_place(tmp_path) -> None:
    """FUNCTIONs, submodels, delays, guards, subscripts, conditions, dot products, derivatives, learning."""
    plus = "+one" * 500
    text = f"""
one = 1 | n = 3{plus}-500 | TMAX = 1 | NN = 3 | DT = 0.5 | irule 2
FUNCTION f(a$, b$) = a$*b${plus}
ARRAY x[n], y[n], X[3]
STATE s[n], p
SUBMODEL osc(a$)
  d/dt a$ = 1{plus}-500
end
x[1] = 1 | x[2] = 2 | x[3] = 4
x[1{plus}-500] = 7
if 0{plus} = 500 then a = 1 | else a = 2 | proceed
while a < 3{plus}-500 | a = a + 1 | end while
DOT q = {"+".join(["x*x"] * 500)}
DOT r = x*x{"-x*1" * 500}
w = f(2{plus}-500, 3)
drun
--? n = 3 | a = 3
--? q = 34500
--? r = {49 + 4 + 16 - 13 * 500}
--? w = 506
--? p = 1
--? s[3] = 4
--? g = 506
--? h = 34500
--? k = 7
--? z = 1
DYNAMIC
invoke osc(p)
Vectr d/dt s = x{plus}-500
g = f(2{plus}-500, 3)
DOT h = {"+".join(["x*x"] * 500)}
k = x[1{plus}-500]
z = 0
if 0{plus}-500.5
  z = 2
else
  z = 1
end if
term 0{plus}-501
"""
    text = text.replace("--? n = 3 | a = 3", "--? n = 3\n--? a = 3")
    assert not faults_of_program(text, tmp_path)
    assert len(read_expectations(text).checks) == 11


def test_rules_that_differentiate_take_long_sums(tmp_path) -> None:
    """x' = -(x + x + …)/800 has the solution exp(-t)."""
    text = (
        "x = 1 | TMAX = 1 | NN = 11 | ERMAX = 1e-9 | irule 14\ndrun\n"
        f"DYNAMIC\nd/dt x = -(x{'+x' * 799})/800\n"
    )
    for backend in BACKENDS:
        outcome = execute(text, backend, tmp_path)
        assert outcome.error is None
        assert outcome.quantities["x"] == pytest.approx(exp(-1), abs=1e-7)


def test_true_nesting_is_told(tmp_path) -> None:
    for text, code in [
        ("x = " + "1+(" * 99 + "1" + ")" * 99, None),
        ("x = " + "1+(" * 101 + "1" + ")" * 101, 400),
        ("x = " + "2^" * 250 + "1", 401),
        ("x = " + "-+" * 150 + "1", 401),
        ("x = 1" + "+1" * 3000 + "+" + "2^" * 250 + "1", 401),
    ]:
        for program in (text, "NN = 2\ndrun\nDYNAMIC\n" + text):
            error = execute(program, "native", tmp_path).error
            assert [d.code for d in error.diagnostics] == [code] if code else error is None
