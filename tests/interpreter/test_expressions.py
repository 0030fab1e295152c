"""Random real expressions: the interpreter and plain Python agree to the last bit."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.library import LIBRARY, integer_power, power
from tests.interpreter.stand_in import RecordingHost

NAMES = {"x": 0.75, "y": -2.5, "z": 3.0, "big": 1e150}
FUNCTIONS = [
    "sin",
    "cos",
    "sat",
    "lim",
    "deadz",
    "swtch",
    "sgn",
    "abs",
    "tanh",
    "sqrt",
    "ln",
    "exp",
    "tri",
    "round",
]


def leaf():
    numbers = st.floats(0, 100, allow_subnormal=False).map(lambda v: (repr(v), v))
    names = st.sampled_from([*NAMES.items()])
    return numbers | names


def combine(inner):
    def binary(parts):
        op, (a, va), (b, vb) = parts
        return f"({a} {op} {b})", apply(op, va, vb)

    def whole_power(parts):
        (a, va), n = parts
        return f"({a})^{n}", guard(integer_power, va, n)

    def general_power(parts):
        (a, va), (b, vb) = parts
        return f"({a})^(1*{b})", guard(power, va, 1 * vb) if vb is not None else None

    def function(parts):
        name, (a, va) = parts
        return f"{name}({a})", guard(LIBRARY[name].value, va)

    return st.one_of(
        st.tuples(st.sampled_from("+-*/"), inner, inner).map(binary),
        st.tuples(inner, st.integers(0, 5)).map(whole_power),
        st.tuples(inner, inner).map(general_power),
        st.tuples(st.sampled_from(FUNCTIONS), inner).map(function),
        inner.map(lambda p: (f"(-{p[0]})", None if p[1] is None else -p[1])),
    )


def guard(function, *args):
    if any(a is None or not math.isfinite(a) for a in args):
        return None  # an infinite value must not vanish in an argument: error 3
    try:
        return function(*args)
    except (ValueError, OverflowError, ZeroDivisionError):
        return None


def apply(op, a, b):
    return guard(
        {"+": float.__add__, "-": float.__sub__, "*": float.__mul__, "/": float.__truediv__}[op], a, b
    )


HOST = RecordingHost()
HOST.run("\n".join(f"{name} = {value!r}" for name, value in NAMES.items()))


@settings(max_examples=300, deadline=None)
@given(st.recursive(leaf(), combine, max_leaves=25))
def test_interpreter_equals_python(pair):
    text, expected = pair
    if expected is None or not math.isfinite(expected):
        with pytest.raises(DesireError):
            HOST.execute(f"result = {text}")
        return
    HOST.execute(f"result = {text}")
    assert HOST["result"] == expected, text
