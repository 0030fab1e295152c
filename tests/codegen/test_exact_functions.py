"""Functions of many numbers have the bits of the C library's, which Python's `math` calls number by number."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from desire_tui.engine.codegen.exact_functions import (
    compiled,
    decimal_logarithm,
    exponential,
    hyperbolic_tangent,
    logarithm,
    lookups,
    quarter_turns,
    sine_and_cosine,
)
from desire_tui.engine.codegen.exact_functions.angles import ROWS, sines_and_cosines
from desire_tui.engine.codegen.exact_functions.constants import half_pi, ln_2, logarithm_of, powers_of_two
from desire_tui.engine.codegen.exact_functions.quarter_turns import quarter_turn
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.studies import chunk as chunks
from desire_tui.studies.chunk import run_chunk
from desire_tui.studies.task import Task

MODEL = (
    "k = 3 | DT = 0.01 | TMAX = 2 | NN = 21 | x = 1 | v = 0\ndrun\nDYNAMIC\nd/dt x = v\n"
    "d/dt v = -k*sin(3*x) - tanh(v) + exp(-x*x) + ln(k + v*v)\ny = cos(x) + sin(x) + log(k + x)\ndispt x\n"
)
SPECIAL = (
    *(
        0.0,
        -0.0,
        math.nan,
        math.inf,
        1e-310,
        -5e-324,
        1e-9,
        0.126,
        0.855469,
        2.426265,
        1e300,
        -3e5,
        699.5,
        -710.0,
    ),
    *(1.05e8, float.fromhex("0x1.e2f7ad3af4e3p+26"), math.pi / 2 + 27 / 256),
)
"""The last two: where other operations would give another sine, and where glibc's sin and sincos differ."""
UNFUSED = """
import math
from desire_tui.engine.codegen.exact_functions import compiled
from desire_tui.engine.codegen.jit.compiler import machine
if math.sin(float.fromhex("0x1.30bd9f946b4d6p-1")).hex() == "0x1.1f105ac05c70dp-1":
    raise SystemExit(0)  # the switch changes nothing here
for name in ("sin", "cos", "sincos"):
    assert compiled.exact_function(name, 2 * machine().width) is None, name
"""


@pytest.fixture
def afresh(monkeypatch):
    """No function and no program was made yet; models compiled later call the functions that stay."""
    known = compiled._known
    monkeypatch.setattr(compiled, "_known", {})
    monkeypatch.setattr(chunks, "_PROGRAMS", chunks._Programs())
    yield
    for function in known.values():
        if function is not None:
            function.register()


def arguments(seed: int) -> np.ndarray:
    """Numbers of all sizes, and such as lie near multiples of π/2, where most bits cancel, and where ways change."""
    random = np.random.default_rng(seed)
    sizes = random.uniform(-1, 1, 4000) * 10.0 ** random.uniform(-9, 6, 4000)
    turns = random.integers(-300, 300, 2000) * (math.pi / 2) * (1 + 10.0 ** random.uniform(-16, -3, 2000))
    ones = 1 + random.uniform(-1, 1, 2000) * 10.0 ** random.uniform(-16, -1, 2000)
    edges = random.choice([0.126, 0.8555, 2.4263], 4000) * (1 + random.uniform(-0.1, 0.1, 4000))
    everything = np.concatenate([sizes, turns, ones, edges, random.uniform(-4, 4, 4000)])
    return np.concatenate([everything, np.resize(np.array(SPECIAL), 32)])


def library(name: str, x: float) -> float:
    try:
        return getattr(math, name)(x)
    except OverflowError:  # of math.exp: the C library's result is inf
        return math.inf
    except ValueError:  # of logarithms: the C library's are -inf and nan
        return -math.inf if x == 0 else math.nan


@pytest.mark.parametrize("name", compiled.NAMES)
def test_the_bits_of_the_library(name):
    width = compiled.widest(name)
    function = compiled.exact_function(name, width)
    if function is None:  # another library or processor: it is called number by number
        assert not compiled._is_possible(name) or name == "tanh"
        return
    x = np.concatenate([arguments(3), np.sort(arguments(4))])  # numbers side by side differ, or are alike
    for own, found in zip(("sin", "cos") if name == "sincos" else (name,), function.of(x), strict=True):
        wanted = np.array([library(own, value) for value in x.tolist()])
        same = (found.view(np.int64) == wanted.view(np.int64)) | (np.isnan(found) & np.isnan(wanted))
        assert same.all(), x[~same][:5]


def test_constants_have_all_their_bits():
    # D. H. Bailey's and other tables; 60 digits
    digits = Fraction("1.570796326794896619231321691639751442098584699687552910487472")
    assert abs(half_pi() - digits) < Fraction(1, 10**59)
    assert abs(
        ln_2() - Fraction("0.693147180559945309417232121458176568075500134360255254120680")
    ) < Fraction(1, 10**59)
    assert float(logarithm_of(Fraction(3, 2))) == math.log(1.5)
    for n, power in enumerate(powers_of_two(7)):
        assert abs(float(power**128 / 2**n - 1)) < 2**-200


def test_in_every_cell_of_the_logarithm_what_is_left_is_a_double():
    for low, high, inverse, most in logarithm.cells():
        for z in (low, math.nextafter(low, high), (low + high) / 2, math.nextafter(high, low)):
            left = Fraction(z) * Fraction(inverse) - 1
            assert Fraction(float(left)) == left, z
            assert abs(left) <= most < 0.035
    first, last = logarithm.cells()[0].low, logarithm.cells()[-1].high
    assert last == 2 * first


def test_sines_and_cosines_have_all_their_bits():
    for k, (sine, cosine) in enumerate(sines_and_cosines()):
        assert sine[0] == math.sin(k / ROWS)
        assert cosine[0] == math.cos(k / ROWS)
        sine_squared, cosine_squared = ((Fraction(high) + Fraction(low)) ** 2 for high, low in (sine, cosine))
        assert abs(sine_squared + cosine_squared - 1) < Fraction(1, 2**104)


def test_multiples_are_taken_away_without_error():
    parts = [Fraction(part) for part in quarter_turn()]
    assert abs(sum(parts) - half_pi()) < Fraction(1, 2**135)
    for turns in (2**26, 2**26 - 1, 44_739_243):
        for part in parts[:3]:
            assert Fraction(float(turns * part)) == turns * part


@pytest.mark.usefixtures("afresh")
def test_tables_in_memory_give_what_tables_in_registers_do(monkeypatch):
    width = 2 * machine().width
    function = compiled.exact_function("log", width)
    if function is None:
        return
    monkeypatch.setattr(compiled, "_known", {})
    monkeypatch.setattr(lookups, "_REGISTER", 0)
    other = compiled.exact_function("log", width)
    assert other is not None
    x = arguments(5)
    assert np.array_equal(function.of(x), other.of(x), equal_nan=True)


@pytest.mark.usefixtures("afresh")
def test_a_function_that_differs_from_the_library_is_not_used(monkeypatch):
    monkeypatch.setattr(sine_and_cosine, "_TAYLOR_BELOW", 0.2)
    monkeypatch.setattr(hyperbolic_tangent, "_ONE_FROM", 3.0)
    monkeypatch.setattr(exponential, "_COEFFICIENTS", (1 / 2, 1 / 6, 1 / 24, 1 / 120))
    monkeypatch.setattr(logarithm, "_BAND_SMALL", 0.0)
    monkeypatch.setattr(decimal_logarithm, "_PER_LN_10", 0.4342944819032519)
    width = 2 * machine().width
    for name in ("sin", "exp", "tanh", "log", "log10"):
        assert compiled.exact_function(name, width) is None


def other_products(self, a, b, c, d):
    return self._fma(c, d, self.lanes.mul(a, b))


def other_turns(lanes, size):
    product, away = lanes.mul(size, lanes.const(float(1 / half_pi()))), lanes.const(1.5 * 2.0**52)
    return lanes.add(product, away)


@pytest.mark.usefixtures("afresh")
@pytest.mark.parametrize("name", ["sin", "cos"])
@pytest.mark.parametrize("change", ["products", "turns"])
def test_a_library_whose_compiler_fused_other_operations_is_told(name, change, monkeypatch):
    if change == "products":
        monkeypatch.setattr(sine_and_cosine.SineAndCosine, "_two_products", other_products)
    else:
        monkeypatch.setattr(quarter_turns, "nearest_turns", other_turns)
    assert compiled.exact_function(name, 2 * machine().width) is None


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="glibc's switches")
def test_a_library_without_fused_operations_is_told_from_one_with_them():
    found = subprocess.run(
        [sys.executable, "-c", UNFUSED],
        env={**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stderr


@pytest.mark.usefixtures("afresh")
@pytest.mark.parametrize("version", ["musl 1.2", "glibc 2.27", None])
def test_of_another_library_nothing_is_presumed(monkeypatch, version):
    monkeypatch.setattr(os, "confstr", lambda _: version)
    assert compiled.exact_function("sin", 2 * machine().width) is None
    task = Task(MODEL, "<text>", None, "x[end], y[end]", ("k",))
    rows = np.linspace(0.5, 4, 21)[:, None]
    found, alone = run_chunk(task, 0, rows), run_chunk(replace(task, lanes=False), 0, rows)
    assert np.array_equal(found.numbers, alone.numbers)
