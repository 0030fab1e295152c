"""The function library: identities of language.md 4.1, published values, the random sequence."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.library import LIBRARY, func1, func2, integer_power, rounded
from tests.interpreter.stand_in import RecordingHost, run

REALS = st.floats(-1e6, 1e6)
V = {name: entry.value for name, entry in LIBRARY.items()}


@given(REALS)
def test_absolute_value_from_limiters(x):
    assert V["abs"](x) == V["lim"](x) + V["lim"](-x)


@given(st.floats(-8, 8))
def test_saturation_from_limiters(x):
    assert V["sat"](x) == pytest.approx(V["lim"](x + 1) - V["lim"](x - 1) - 1, abs=1e-14)
    assert V["SAT"](x) == pytest.approx(V["lim"](x) - V["lim"](x - 1), abs=1e-14)
    assert V["deadz"](x) == x - V["sat"](x)


@given(REALS, REALS)
def test_maximum_and_minimum_from_limiters(a, b):
    assert V["max"](a, b) == pytest.approx(a + V["lim"](b - a), abs=1e-9)
    assert V["min"](a, b) == pytest.approx(a - V["lim"](a - b), abs=1e-9)


@given(REALS)
def test_rounding_goes_away_from_zero_and_is_odd(x):
    assert rounded(x) == math.copysign(math.floor(abs(x) + 0.5), x) or abs(x) == 0.49999999999999994
    assert rounded(-x) == -rounded(x)
    assert V["trnc"](x) == math.trunc(x)


@given(st.floats(-40, 40))
def test_sigmoid_is_a_tanh(x):
    assert V["sigmoid"](x) == pytest.approx((1 + math.tanh(x / 2)) / 2, abs=1e-15)


@given(st.floats(0.1, 10), st.integers(-30, 30))
def test_whole_powers_are_products(x, n):
    assert integer_power(x, n) == pytest.approx(x**n, rel=1e-13)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("deadz(2.5)", 1.5), ("deadz(-.5)", 0), ("deadc(1)", 0), ("deadc(1.01)", 1), ("sat(-3)", -1),
        ("SAT(-3)", 0), ("SAT(.4)", 0.4), ("swtch(0)", 0), ("sgn(0)", 0), ("sgn(-2)", -1), ("rect(1)", 0),
        ("rect(-.9)", 1), ("tri(1.5)", -0.5), ("comp(-1,3,7)", 3), ("comp(1;3;7)", 7), ("SIGMOID(2)", 0.8),
        ("SIGMOID(-2)", 0), ("sigmoid(-1000)", 0), ("sigmoid(1)", 0.7310585786300049),
        ("sinc(2)", 0.45464871341284085), ("sinc(0)", 1), ("round(-2.5)", -3), ("round(0.49999999999999994)", 0),
        ("trnc(-2.9)", -2), ("log(1000)", 3), ("ln(exp(2))", 2), ("atan2(1,-1)", 3 * math.pi / 4),
        ("max(2,5)", 5), ("min(2,5)", 2), ("recip(4)", 0.25), ("2^2^3", 256), ("-2^2", -4), ("3*-2", -6),
        ("2^-1", 0.5), ("(-2)^3", -8), ("0^0.5", 0), ("2^0.5", math.sqrt(2)), ("(-3)^0", 1), ("10 - 4 - 3", 3),
        ("12/3/2", 2), ("&17370", 7928), ("&&FC2", 4034), ("abs(-3)", 3), ("tan(PI/4)", 1),
    ],
)  # fmt: skip
def test_values(expression, value):
    assert run(f"x = {expression}")["x"] == pytest.approx(value, rel=1e-15, abs=1e-15)


def test_every_real_function_works_in_a_script():
    for entry in LIBRARY.values():
        if entry.value is None or entry.kind not in {"real", "choice"}:
            continue
        args = [0.25, 0.5, 0.75][: entry.most]
        host = run(f"x = {entry.name}({', '.join(map(str, args))})")
        assert host["x"] == entry.value(*args)


def test_a_programs_own_maximum_wins():
    host = run("FUNCTION max(a, b) = 100*a + b\nx = max(2, 3)")
    assert host["x"] == 203


@pytest.mark.parametrize(
    ("start", "values"),
    [
        ("", [-1, -0.9980292107, -0.9167379968]),
        ("SEED 1", [-0.9167393105, -0.09101511054, 0.6696344363]),
        ("SEED 123", [-0.4409759961, -0.1709418351]),
    ],
)
def test_uniform_random_sequence(start, values):
    lines = "".join(f"x{k} = ran()\n" for k in range(len(values)))
    host = run(f"{start}\n{lines}")
    for k, value in enumerate(values):
        assert host[f"x{k}"] == pytest.approx(value, abs=1e-10)


def test_a_hundred_thousand_draws_have_the_known_moments():
    host = run("s = 0 | q = 0\nfor k = 1 to 100000 | x = ran() | s = s + x | q = q + x*x | next")
    assert host["s"] / 1e5 == pytest.approx(-0.0009788666115, abs=1e-12)
    assert host["q"] / 1e5 == pytest.approx(0.3333594551, abs=1e-10)


def test_draws_go_left_to_right_and_the_state_is_shared():
    host = run("SEED 7\na = ran() - 10*ran()\nSEED 7\nb = ran() | c = ran()")
    assert host["a"] == host["b"] - 10 * host["c"]
    state = int(host.values.random[0])
    host.execute("d = ran()")
    after = (0x5DEECE66D * state + 11) % 2**48
    assert int(host.values.random[0]) == after
    assert host["d"] == 2 * (after / 2**48) - 1


def test_normal_numbers_follow_box_and_muller():
    host = run("SEED 5\nu = (ran() + 1)/2 | v = (ran() + 1)/2\nSEED 5\ng = gauss(0) | h = gauss()")
    expected = math.sqrt(-2 * math.log(host["u"])) * math.cos(2 * math.pi * host["v"])
    assert host["g"] == pytest.approx(expected, rel=1e-12)
    assert host["h"] != host["g"]


@given(st.lists(st.floats(-10, 10), min_size=2, max_size=12, unique=True), st.floats(-12, 12), st.data())
def test_table_function_is_numpys_interpolation(breakpoints, x, data):
    breakpoints.sort()
    values = data.draw(st.lists(st.floats(-5, 5), min_size=len(breakpoints), max_size=len(breakpoints)))
    assert func1(x, breakpoints + values) == pytest.approx(np.interp(x, breakpoints, values), abs=1e-8)


def test_table_function_of_the_book():
    host = run(
        "n = 25 | ARRAY X[n] + Y[n] = F\nfor i = 1 to n\nX[i] = (i-1)/12.5 | Y[i] = sin(4*X[i])\nnext\n"
        "a = func1(-0.1; F) | b = func1(0.02, F) | c = func1(1; F) | d = func1(2.2; F)"
    )
    expected = (0, 0.07864164015, -0.7471360715, 0.9849033341)
    assert [host[n] for n in "abcd"] == pytest.approx(expected, abs=1e-10)


def test_bilinear_table_function_of_models_4_2_2_2():
    host = RecordingHost()
    host.run(
        "n = 20 | m = 15 | ARRAY F[n,m], X[n], Y[m]\nfor i = 1 to n | X[i] = i - 10 | next\n"
        "for k = 1 to m | Y[k] = k - 7.5 | next\nfor i = 1 to n | for k = 1 to m\n"
        "F[i,k] = X[i] + Y[k]*(Y[k]*cos(X[i]) - sin(Y[k]))\nnext | next"
    )
    for time, value in [
        (0, -48.89353349),
        (4, 6.989827308),
        (8.3, -2.426501962),
        (10.25, 6.294135772),
        (16, 52.9745788),
    ]:
        host.execute(f"f = func2({time} - 10, {time} - 7.5; F, X, Y)")
        assert host["f"] == pytest.approx(value, rel=1e-9)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_bilinear_interpolation_reproduces_bilinear_functions(x, y):
    points = [-3.0, -1.0, 0.5, 3.0]
    surface = [2 + 3 * a - b + 0.5 * a * b for a in points for b in points]
    assert func2(x, y, surface, points, points) == pytest.approx(2 + 3 * x - y + 0.5 * x * y, abs=1e-12)
