"""Plain Python means the same compiled as run."""

from __future__ import annotations

import ctypes
from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from llvmlite import ir

from desire_tui.engine.codegen.jit.compiler import compile_text
from desire_tui.engine.codegen.stiff.plain_python import PlainPython

TEXT = """
LIMIT = 7

def collatz(n: int) -> int:
    steps = 0
    while n != 1:
        half = n // 1
        if 2 * halves(n) == n:
            n = halves(n)
        else:
            n = 3 * n + 1
        steps += 1
        if steps > 500:
            break
    return steps

def halves(n: int) -> int:
    count = 0
    for i in range(1, n):
        if 2 * i > n:
            break
        count = i
    return count

def skipping(n: int, odd: int) -> int:
    total = 0
    for i in range(n):
        if i == 3 or (odd and not i != 5):
            continue
        total += i
    return total

def mixed(x: float, y: float, n: int) -> float:
    a, b = y, x
    a -= b / 2
    c = min(a, b, n) + max(abs(x), sqrt(y * y))
    d = c if x < y and n >= LIMIT else -c
    return d ** 2 + n / 3 - (x != y)

def rotate(s: Store, v: Reals, places: Ints, n: int) -> None:
    known, table = s.total, s.table
    for i in range(n):
        table[i] = v[places[i]]
        known += v[i]
    s.total = known
    s.count += n
    if n == 0:
        return
    s.table[n - 1] *= 2.0
"""


class Store(ctypes.Structure):
    """Total, count, table."""

    _fields_ = (("total", ctypes.c_double), ("count", ctypes.c_int64), ("table", ctypes.c_double * 8))


REAL, INT, ADDRESS = ctypes.c_double, ctypes.c_int64, ctypes.c_void_p


@pytest.fixture(scope="module", params=[0, 2])
def both(request):
    """The functions, run and compiled."""
    text = TEXT.replace("        half = n // 1\n", "")
    names = {"LIMIT": 7, "sqrt": sqrt, "Store": Store, "Reals": None, "Ints": None}
    exec(compile(text, "plain", "exec"), names)
    module = ir.Module("plain")
    PlainPython(module, {text.encode(): names}, Store, "plain_", {}, {})
    code = compile_text(str(module), level=request.param, vectorize=bool(request.param))

    def native(name, result, *arguments):
        return ctypes.CFUNCTYPE(result, *arguments)(code.address(f"plain_{name}"))

    compiled = {
        "collatz": native("collatz", INT, INT),
        "skipping": native("skipping", INT, INT, INT),
        "mixed": native("mixed", REAL, REAL, REAL, INT),
        "rotate": native("rotate", None, ADDRESS, ADDRESS, ADDRESS, INT),
        "code": code,
    }
    return names, compiled


def test_loops(both):
    run, compiled = both
    assert run["collatz"](27) == 111, "as everybody knows"
    for n in (1, 2, 7, 27):
        assert compiled["collatz"](n) == run["collatz"](n)
    for n, odd in ((0, 0), (4, 0), (9, 0), (9, 1)):
        assert compiled["skipping"](n, odd) == run["skipping"](n, odd)


SMALL = st.floats(-1e6, 1e6)


@given(SMALL, SMALL, st.integers(-20, 20))
def test_expressions(both, x, y, n):
    run, compiled = both
    assert compiled["mixed"](x, y, n) == run["mixed"](x, y, n)


@given(st.lists(SMALL, max_size=8))
def test_structures_and_arrays(both, values):
    run, compiled = both
    n = len(values)
    places = np.arange(n, dtype=np.int64)[::-1].copy()
    numbers = np.array([*values, 0.0])
    mine, its = Store(1.0, 2), Store(1.0, 2)
    run["rotate"](mine, numbers, places, n)
    compiled["rotate"](ctypes.addressof(its), numbers.ctypes.data, places.ctypes.data, n)
    assert (mine.total, mine.count, list(mine.table)) == (its.total, its.count, list(its.table))


@pytest.mark.parametrize(
    "body",
    ["x = [1]", "x = 1 if s else 2.5", "import os", "x = 'a'", "x: int = 1.5", "x = s.nothing", "x = y"],
)
def test_what_it_does_not_know_is_refused(body):
    text = f"def f(s: Store) -> None:\n    {body}\n"
    with pytest.raises((AssertionError, AttributeError, KeyError)):
        PlainPython(ir.Module("bad"), {text.encode(): {}}, Store, "", {}, {})
