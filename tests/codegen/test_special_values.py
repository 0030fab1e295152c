"""nan, infinities, both zeros, denormals and huge numbers: every back end gives what IEEE 754 says, nan stays nan."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from desire_tui.engine.codegen import native_model
from desire_tui.engine.codegen.jit import background
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.reference.numbers import integer_power, scalar_function
from tests.codegen.conftest import improve, run

SPECIAL = [
    math.nan,
    math.inf,
    -math.inf,
    0.0,
    -0.0,
    5e-324,
    -5e-324,
    0.5,
    -0.5,
    1.0,
    -1.0,
    2.5,
    -2.5,
    1e308,
    -1e308,
]
FEW = [math.nan, math.inf, -math.inf, 0.0, -0.0, 1.0, -2.5]
PAIRS = [(a, b) for a in FEW for b in FEW]
ONE = [
    entry.name
    for entry in LIBRARY.values()
    if entry.most == 1
    and "D" in entry.where
    and entry.kind in {"real", "complex"}
    and entry.value is not None
]
POWERS = [-2, -1, 0, 1, 2, 3]
TWO = {
    "p + q": "add", "p - q": "sub", "p*q": "mul", "p/q": "div", "p^q": "pow", "max(p, q)": "max", "min(p, q)": "min",
    "atan2(p, q)": "atan2",
}  # fmt: skip
INEXACT = {
    "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ln", "log", "sinc", "sigmoid",
}  # fmt: skip
OTHERS = {"comp(p, 3, 7)": lambda p: math.nan if math.isnan(p) else 7.0 if p > 0 else 3.0}


def filled(name, numbers):
    """Return script lines and the segment's line that make an array of numbers which no script can hold."""
    pairs = [
        (1 if x > 0 else -1, 0) if math.isinf(x) else (0, 0) if math.isnan(x) else (x, 1) for x in numbers
    ]
    n = len(numbers)
    lines = [f"ARRAY {name}[{n}], {name}top[{n}], {name}low[{n}]"]
    lines += [f"{name}top[{k}] = {top!r}\n{name}low[{k}] = {low}" for k, (top, low) in enumerate(pairs, 1)]
    return "\n".join(lines) + "\n", f"Vector {name} = {name}top/{name}low\n"


def results(script, segment, calls, arrays, backend):
    """Return each call's values: of a vector statement, and of one scalar statement for each element."""
    n = len(next(iter(arrays.values())))
    made_of = [filled(name, numbers) for name, numbers in arrays.items()]
    script += "".join(lines for lines, _ in made_of)
    segment = "".join(line for _, line in made_of) + segment
    for number, call in enumerate(calls):
        script += f"ARRAY v{number}[{n}], s{number}[{n}]\n"
        segment += f"Vector v{number} = {call}\n"
        for k in range(1, n + 1):
            one = re.sub(r"\b[pq]\b", rf"\g<0>[{k}]", call)
            segment += f"s{number}[{k}] = {one}\n"
    made = run(f"{script}NN = 2\ndrun\nDYNAMIC\n{segment}ok = 1\ndispt ok\n", backend)
    return {call: (made.array(f"v{k}"), made.array(f"s{k}")) for k, call in enumerate(calls)}


def assert_same(value, wanted, about, ulps=0):
    if math.isnan(wanted) or math.isinf(wanted) or wanted == 0.0:
        assert math.isnan(value) if math.isnan(wanted) else value == wanted, (about, value, wanted)
        assert math.isnan(wanted) or math.copysign(1, value) == math.copysign(1, wanted), (
            about,
            value,
            wanted,
        )
    else:
        assert abs(value - wanted) <= ulps * math.ulp(wanted), (about, value, wanted)


@pytest.fixture(params=["reference", "quick", "arrays", "registers"])
def backend(request, monkeypatch):
    """Return a back end's name: the reference, or native code as first compiled, or well compiled at once."""
    if request.param == "arrays":
        monkeypatch.setattr(native_model, "SMALL", -1)
    add = (lambda _self, _work: None) if request.param == "quick" else lambda _self, work: improve(work)
    monkeypatch.setattr(background.Improver, "add", add)
    return "reference" if request.param == "reference" else "native"


def test_functions_of_one_number(backend):
    calls = {f"{name}(p)": scalar_function(name) for name in ONE}
    calls |= {f"p^({n})": lambda p, n=n: integer_power(p, n) for n in POWERS} | OTHERS
    found = results("", "", list(calls), {"p": SPECIAL}, backend)
    for call, function in calls.items():
        ulps = 4 if call.partition("(")[0] in INEXACT else 0
        for kind, values in zip(("vector", "scalar"), found[call], strict=True):
            for value, x in zip(values, SPECIAL, strict=True):
                assert_same(value, function(x), (kind, call, x), ulps)
                if math.isnan(x) and call != "p^(0)":
                    assert math.isnan(value), (kind, call)


def test_functions_of_two_numbers(backend):
    arrays = {"p": [a for a, _ in PAIRS], "q": [b for _, b in PAIRS]}
    found = results("", "", list(TWO), arrays, backend)
    for call, name in TWO.items():
        function = scalar_function(name)
        for kind, values in zip(("vector", "scalar"), found[call], strict=True):
            for value, (a, b) in zip(values, PAIRS, strict=True):
                assert_same(value, function(a, b), (kind, call, a, b), 4)
                exempt = name == "pow" and (b == 0.0 or a == 1.0)
                if (math.isnan(a) or math.isnan(b)) and not exempt:
                    assert math.isnan(value), (kind, call, a, b)


def test_table_functions(backend):
    script = (
        "ARRAY X[3] + Y[3] = F, G[2,2], P[2], Q[2]\ndata -1, 0, 2, 5, 7, 1\nread F\n"
        "data 0, 10, 100, 110 | read G | data 0, 1 | read P | data 0, 2 | read Q\n"
    )
    calls = ["func1(p; F)", "func2(p, p; G, P, Q)"]
    found = results(script, "", calls, {"p": SPECIAL}, backend)
    for values in found["func1(p; F)"]:
        wanted = np.where(np.isnan(SPECIAL), np.nan, np.interp(SPECIAL, [-1, 0, 2], [5, 7, 1]))
        np.testing.assert_allclose(values, wanted)
    for values in found["func2(p, p; G, P, Q)"]:
        np.testing.assert_allclose(
            values, 100 * np.clip(SPECIAL, 0, 1) + 5 * np.clip(SPECIAL, 0, 2), atol=1e-300
        )


def test_largest_element_and_smaller_of_two_keep_nan(backend):
    lines, fill = filled("p", [2.0, math.nan, 5.0, 1.0])
    made = run(
        f"{lines}ARRAY W[4,4], y[4]\nNN = 2\ndrun\nDYNAMIC\n{fill}Vector y^ = p\nMATRIX W = p & p\nok = 1\ndispt ok\n",
        backend,
    )
    assert np.isnan(made.array("y")).tolist() == [False, True, False, False]
    assert np.isnan(made.array("W")).sum() == 7


@pytest.mark.parametrize("name", ONE)
def test_scripts_keep_nan(name):
    """The table that scripts call, directly: nan in a variable is what a run that failed leaves."""
    assert math.isnan(LIBRARY[name].value(math.nan))
