"""Plain Python means the same compiled as run."""

from __future__ import annotations

import ctypes
import gc
import time
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import cache
from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.codegen.jit.compiler import compile_text
from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.plain_python.program import Module, write_program
from desire_tui.engine.codegen.plain_python.refusal import PlainPythonError
from desire_tui.engine.codegen.plain_python.surroundings import Outside
from desire_tui.engine.integration.switching.mathematics import fused

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


class Linked(ctypes.Structure):
    """Another structure's address, and a number."""

    _fields_ = (("other", ctypes.c_uint64), ("count", ctypes.c_int64))


REAL, INT, ADDRESS = ctypes.c_double, ctypes.c_int64, ctypes.c_void_p


@pytest.fixture(scope="module", params=[0, 2])
def both(request):
    """The functions, run and compiled."""
    text = TEXT.replace("        half = n // 1\n", "")
    names = {"LIMIT": 7, "sqrt": sqrt, "Store": Store, "Reals": None, "Ints": None}
    exec(compile(text, "plain", "exec"), names)
    written = write_program([Module(text, names)], Outside({"Store": Store}), "plain_")
    code = compile_text(written, level=request.param, vectorize=bool(request.param))

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


REFUSED = {
    "0 < x < 1": "if 0.0 < x < 1.0:\n        n = 1",
    "range with a step": "for i in range(0, n, 2):\n        pass",
    "range(step=…)": "for i in range(n, stop=3):\n        pass",
    "range over a float": "for i in range(x):\n        pass",
    "a loop over an array": "for i in v:\n        pass",
    "a loop over a tuple": "for i in (1, 2):\n        pass",
    "a loop with two variables": "for i, j in range(n):\n        pass",
    "while … else": "while n > 0:\n        n -= 1\n    else:\n        n = 5",
    "for … else": "for i in range(n):\n        pass\n    else:\n        n = 5",
    "the loop's variable changed": "for i in range(n):\n        i += 1",
    "the loop's variable, of a loop inside": "for i in range(n):\n        for i in range(2):\n            pass",
    "the loop's variable after the loop": "for i in range(n):\n        pass\n    n = i",
    "x: int = 1.5": "k: int = 1.5",
    "x: int": "k: int",
    "x: str": "k: str = 1",
    "another type": "k: int = 1\n    k: float = 2.0",
    "an annotated field": "s.total: float = 1.0",
    "a list": "k = [1]",
    "a text": "k = 'a'",
    "None": "k = None",
    "a complex number": "k = 1j",
    "too large": "k = 99999999999999999999",
    "int or float": "k = 1 if n else 2.5",
    "truth of a structure": "k = 1 if s else 2",
    "truth of a float": "if x:\n        n = 1",
    "truth of an array": "if v:\n        n = 1",
    "import": "import os",
    "an unknown field": "k = s.nothing",
    "an unknown name": "k = unknown",
    "float to int": "k = 1\n    k = 2.5",
    "int from a quotient": "k = 4\n    k /= 2",
    "truth to number": "k = True\n    k = 2",
    "an array to a number": "k = 1\n    k = v",
    "arrays of another type": "w = v\n    w = p",
    "//": "k = n // 2",
    "//=": "n //= 2",
    "%": "k = n % 2",
    "%=": "n %= 2",
    "**=": "x **= 2.0",
    "int ** int": "k = n ** 2",
    "int ** -1": "k = 2 ** -1",
    "<<": "k = n << 1",
    "|": "k = n | 1",
    "|=": "n |= 1",
    "@": "k = v @ v",
    "~": "k = ~n",
    "+x": "k = +n",
    "is": "k = n is 1",
    "in": "k = n in (1, 2)",
    "not in": "k = n not in (1, 2)",
    "arrays compared": "k = v == p",
    "an array to a sum": "k = v + 1",
    "a number or": "k = n or 5",
    "or a number": "k = n > 1 or n",
    "a float and": "k = x and n > 1",
    "an argument by name": "k = max(n, key=1)",
    "a call with *": "k = max(*v)",
    "max of one": "k = max(v)",
    "max of an array": "k = max(v, v)",
    "abs of two": "x = abs(x, x)",
    "abs of a whole number": "k = abs(n)",
    "an unknown function": "k = round(x)",
    "sum": "x = sum(v)",
    "int()": "k = int(x)",
    "a function that is not imported": "x = cos(x)",
    "a method": "k = v.sum()",
    "a function's result of no value": "k = helper(n)",
    "too few arguments": "helper()",
    "too many arguments": "helper(n, n)",
    "a float for an int": "helper(x)",
    "a number for an array": "reader(n)",
    "another array": "reader(p)",
    "a function as a value": "k = helper",
    "a local name called": "helper = 1\n    helper(n)",
    "range as a value": "k = range(n)",
    "copy between types": "copy(v, 0, p, 0, n)",
    "lambda": "k = (lambda: 1)()",
    "a function inside": "def inner() -> None:\n        pass",
    "a class": "class Inner:\n        pass",
    "a list's loop": "k = [i for i in range(3)]",
    ":=": "k = (n := 5)",
    "f-string": "k = f'{n}'",
    "a = b = 1": "a = b = 1",
    "a tuple from a call": "a, b = helper(n)",
    "tuples of two lengths": "a, b = 1, 2, 3",
    "*a, b = …": "*a, b = 1, 2",
    "a tuple in a tuple": "(a, b), c = (1, 2), 3",
    "a tuple": "a = 1, 2",
    "a slice": "k = v[1:2]",
    "an index from the end": "k = v[-1]",
    "an index of two numbers": "k = v[1, 2]",
    "a float as index": "k = v[x]",
    "an element of a number": "k = n[0]",
    "a call in the target": "v[number(n)] += 1.0",
    "a whole array assigned": "s.table = v",
    "a field of a number": "k = n.total",
    "del": "del n",
    "with": "with n:\n        pass",
    "try": "try:\n        pass\n    finally:\n        pass",
    "raise": "raise n",
    "assert": "assert n",
    "global": "global k",
    "match": "match n:\n        case 1:\n            pass",
    "a value as a statement": "n + 1",
    "return of a value": "return n",
    "return None": "return None",
    "a statement never reached": "return\n    n = 1",
    "after an endless loop": "while True:\n        n = 1\n    n = 2",
    "read before it is set": "k = k + 1",
    "set in one branch only": "if n > 0:\n        k = 1\n    n = k",
    "set in a loop only": "while n > 0:\n        k = 1\n        n -= 1\n    n = k",
    "set after break": "while True:\n        if n > 0:\n            break\n        k = 1\n    n = k",
    "a constant hidden later": "k = LIMIT\n    LIMIT = 2",
    "await": "k = await n",
}


HELPERS = """
def helper(n: int) -> None:
    pass

def number(n: int) -> int:
    return n

def reader(v: Reals) -> None:
    pass
"""
NAMES = {"__name__": "plain", "LIMIT": 7, "sqrt": sqrt, "copy": copy}


def refusal(text):
    with pytest.raises(PlainPythonError) as caught:
        write_program([Module(text, NAMES)], Outside({"Store": Store}), "")
    return str(caught.value)


@pytest.mark.parametrize("name", REFUSED)
def test_what_it_does_not_know_is_refused(name):
    body = REFUSED[name]
    head = "async def" if "await" in body else "def"
    message = refusal(
        f"{head} f(s: Store, v: Reals, p: Ints, x: float, n: int) -> None:\n    {body}\n{HELPERS}"
    )
    line = int(message.partition("plain line ")[2].partition(",")[0].partition(":")[0])
    assert 1 <= line <= 2 + body.count("\n"), message


@pytest.mark.parametrize(
    "text",
    [
        "def f(n) -> None:\n    pass",
        "def f(n: list) -> None:\n    pass",
        "def f(n: int):\n    pass",
        "def f(n: int) -> str:\n    pass",
        "def f(n: int) -> bool:\n    return n > 1",
        "def f(n: bool) -> None:\n    pass",
        "def f(n: int = 1) -> None:\n    pass",
        "def f(*n: int) -> None:\n    pass",
        "def f(**n: int) -> None:\n    pass",
        "def f(*, n: int) -> None:\n    pass",
        "def f(n: int, /) -> None:\n    pass",
        "@cached\ndef f(n: int) -> None:\n    pass",
        "def f(n: int) -> int:\n    return n, n",
        "def f(n: int) -> int:\n    return",
        "def f(n: int) -> int:\n    return n / 2",
        "def f(n: int) -> int:\n    if n > 0:\n        return 1",
        "def f(n: int) -> int:\n    while n > 0:\n        return 1",
        "def f(n: int) -> int:\n    while True:\n        if n > 0:\n            break",
        "def f(n: int) -> None:\n    yield n",
        "def f(n: int) -> None:\n    pass\ndef f(n: int) -> None:\n    pass",
        "def max(n: int) -> None:\n    pass",
        "class F:\n    pass",
        "for i in range(3):\n    pass",
    ],
)
def test_a_head_or_an_end_that_it_does_not_know_is_refused(text):
    assert "plain line" in refusal(text)


def test_a_name_that_means_something_else_here_is_refused():
    text = "def f(x: float) -> float:\n    return sqrt(x)\n"
    with pytest.raises(PlainPythonError, match="plain line 2, f: a call of 'sqrt'"):
        write_program([Module(text, NAMES | {"sqrt": abs})], Outside({}), "")
    write_program([Module(text, NAMES)], Outside({}), "")


def test_a_field_that_is_known_cannot_be_set():
    text = "def f(s: Store) -> None:\n    s.count = 3\n"
    with pytest.raises(PlainPythonError, match=r"'s\.count'"):
        write_program([Module(text, NAMES)], Outside({"Store": Store}, known={"count": 2}), "")


@pytest.mark.parametrize("level", [0, 2])
def test_a_fused_sum_is_rounded_once_or_twice(level):
    text = "def f(a: float, b: float, c: float) -> float:\n    return fused(a, b, c)\n"
    written = write_program([Module(text, NAMES | {"fused": fused})], Outside({}), "plain_")
    code = compile_text(written, level=level)
    native = ctypes.CFUNCTYPE(REAL, REAL, REAL, REAL)(code.address("plain_f"))
    assert native(3.0, 0.5, -2.25) == -0.75
    third = 1 / 3
    once = float(Fraction(third) * 3 - 1)
    assert once != 0.0
    assert native(third, 3.0, -1.0) in {0.0, once}
    with pytest.raises(PlainPythonError, match="2 arguments"):
        write_program([Module(text.replace(", c)\n", ")\n"), NAMES | {"fused": fused})], Outside({}), "")


def test_what_is_asked_of_an_address_that_is_known_to_be_0_is_not_written():
    text = "def f(s: Store) -> int:\n    if s.other != 0:\n        o: Store = s.other\n        return o.count\n    return 7\n"
    written = write_program([Module(text, NAMES)], Outside({"Store": Linked}, known={"other": 0}), "plain_")
    code = compile_text(written, level=0)
    linked = Linked(other=1)
    f = ctypes.CFUNCTYPE(INT, ADDRESS)(code.address("plain_f"))
    assert f(ctypes.addressof(linked)) == 7


def test_a_rare_function_stays_one_of_its_own():
    text = "def f(n: int) -> int:\n    return n + 1\n\ndef g(n: int) -> int:\n    return f(n)\n"
    written = write_program([Module(text, NAMES)], Outside({}), "", rare=frozenset({"f"}))
    assert "@f(i64 %a0) cold noinline {" in written
    assert "@g(i64 %a0) {" in written


WHOLE, FLOATS, FLAGS = ("i", "j", "n"), ("a", "b", "x"), ("p", "q")


@cache  # what is drawn from is made once: making it costs more than drawing
@st.composite
def number(draw, kind, depth):
    """An expression; whole numbers stay small enough for 64 bits."""
    if depth == 0 or draw(st.integers(0, 4)) == 0:
        constants = st.integers(-9, 9).map(str) if kind == "int" else st.sampled_from(("0.5", "-2.0", "3.25"))
        return draw(st.one_of(constants, st.sampled_from(WHOLE if kind == "int" else FLOATS)))
    left, right = (draw(number(kind, depth - 1)) for _ in range(2))
    other = draw(number("int", depth - 1))
    test = draw(truth(depth - 1))
    shapes = [f"({left} + {right})", f"({left} - {right})", f"-({left})", f"({left} if {test} else {right})",
              f"min({left}, {right})", f"max({left}, {right}, {left})"]  # fmt: skip
    if kind == "int":
        shapes += [f"({test}) + {left}", f"3*({left})", f"v_int[{draw(st.integers(0, 3))}]"]
    else:
        shapes += [f"{left}*{right}", f"{left}/4", f"abs({left})", f"({left} + {other})", f"({other}) * {left}",
                   f"sqrt(abs({left}))", f"v[{draw(st.integers(0, 3))}]"]  # fmt: skip
    return draw(st.sampled_from(shapes))


@cache
@st.composite
def truth(draw, depth):
    if depth == 0:
        return draw(st.sampled_from((*FLAGS, "True", "False", "n > 2", "x <= a", "i != j")))
    kinds = [draw(st.sampled_from(("int", "float"))) for _ in range(2)]
    left, right = (draw(number(kind, depth - 1)) for kind in kinds)
    sign = draw(st.sampled_from(("<", "<=", ">", ">=", "==", "!=")))
    one, two = draw(truth(depth - 1)), draw(truth(depth - 1))
    shapes = (f"({left} {sign} {right})", f"({one} and {two})", f"({one} or {two})", f"(not {one})")
    return draw(st.sampled_from(shapes))


@cache
@st.composite
def block(draw, depth, loops):
    """Statements, indented once."""
    lines = []
    for _ in range(draw(st.integers(1, 3))):
        kind = draw(
            st.sampled_from(("int", "float", "flag", "add", "element", "if", "for", "while", "leave"))
        )
        if (depth == 0 and kind in {"if", "for", "while"}) or (kind == "leave" and not loops):
            kind = "int"
        if kind == "leave":
            way = draw(st.sampled_from(("break", "continue")))
            lines += [f"if {draw(truth(1))}:", f"    {way}"]
        elif kind == "int":
            lines.append(f"{draw(st.sampled_from(WHOLE))} = {draw(number('int', 2))}")
        elif kind == "float":
            lines.append(f"{draw(st.sampled_from(FLOATS))} = {draw(number('float', 2))}")
        elif kind == "flag":
            lines.append(f"{draw(st.sampled_from(FLAGS))} = {draw(truth(2))}")
        elif kind == "add":
            lines.append(
                f"{draw(st.sampled_from(FLOATS))} {draw(st.sampled_from('+-'))}= {draw(number('float', 1))}"
            )
        elif kind == "element":
            lines.append(f"v[{draw(st.integers(0, 3))}] = {draw(number('float', 2))}")
        elif kind == "if":
            lines += [f"if {draw(truth(2))}:", *draw(block(depth - 1, loops))]
            lines += ["else:", *draw(block(depth - 1, loops))]
        elif kind == "for":
            bounds = draw(st.sampled_from(("3", "1, 3", "min(n, 3)")))
            lines += [
                f"for k{depth} in range({bounds}):",
                *draw(block(depth - 1, loops=True)),
                f"    j += k{depth}",
            ]
        else:
            lines += [f"w{depth} = 0", f"while w{depth} < 3 and {draw(truth(1))}:", f"    w{depth} += 1",
                      *draw(block(depth - 1, loops=True))]  # fmt: skip
    return [f"    {line}" for line in lines]


@settings(max_examples=60)
@given(block(2, loops=False), st.lists(SMALL, min_size=4, max_size=4), st.integers(-4, 6), SMALL)
def test_what_is_accepted_computes_what_python_computes(lines, start, n, x):
    head = "def f(v: Reals, v_int: Ints, n: int, x: float) -> float:\n    i, j, a, b = 1, 2, 0.5, x\n    p, q = n > 0, x < a\n"
    text = head + "\n".join(lines) + "\n    v[4] = i + 2*j + (p + 4*q)\n    return a + b + n + x\n"
    names = dict(NAMES, Reals=None, Ints=None)
    exec(compile("from __future__ import annotations\n" + text, "plain", "exec"), names)
    code = compile_text(write_program([Module(text, NAMES)], Outside({}), "plain_"), level=0)
    native = ctypes.CFUNCTYPE(REAL, ADDRESS, ADDRESS, INT, REAL)(code.address("plain_f"))
    whole = np.array([3, -1, 0, 7])
    mine, its = [*start, 0.0], np.array([*start, 0.0])
    expected = names["f"](mine, whole.tolist(), n, x)
    found = native(its.ctypes.data, whole.ctypes.data, n, x)
    assert repr([float(value) for value in (*mine, expected)]) == repr([*its.tolist(), found])


@pytest.mark.parametrize("sign", ["<", "<=", ">", ">=", "==", "!="])
def test_comparisons_of_equal_numbers_and_of_nan(sign):
    text = f"def f(x: float, y: float) -> int:\n    return x {sign} y\n\ndef g(i: int, j: int) -> int:\n    return i {sign} j\n"
    code = compile_text(write_program([Module(text, NAMES)], Outside({}), "plain_"), level=0)
    floating = ctypes.CFUNCTYPE(INT, REAL, REAL)(code.address("plain_f"))
    whole = ctypes.CFUNCTYPE(INT, INT, INT)(code.address("plain_g"))
    for x, y in ((1, 1), (1, 2), (2, 1), (-1, 1)):
        expected = eval(f"{x} {sign} {y}")
        assert (floating(x, y), whole(x, y)) == (expected, expected)
    for x, y in ((float("nan"), 1.0), (1.0, float("nan"))):
        assert floating(x, y) == (sign == "!=")


@pytest.fixture
def threads_change_within_a_parse():
    """A collection of garbage runs Python code, at which another thread may go on."""
    before = gc.get_threshold()

    def give_way(*_):
        time.sleep(0)

    gc.callbacks.append(give_way)
    gc.set_threshold(50)
    yield
    gc.set_threshold(*before)
    gc.callbacks.remove(give_way)


def test_two_threads_may_write_programs(threads_change_within_a_parse):
    """A large model compiles its fast code in a thread while the next one is begun."""
    text = "def f(x: float) -> float:\n    return " + "x" + " + x" * 100 + "\n"

    def write(_):
        return write_program([Module(text, NAMES)], Outside({}), "")

    with ThreadPoolExecutor(4) as threads:
        assert len(set(threads.map(write, range(40)))) == 1
