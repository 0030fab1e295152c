"""Library functions: the same values in a script, in a segment, and element by element, against other formulas."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from desire_tui.engine.library import LIBRARY
from tests.programs.execution import execute

ANY = (-2.5, -1.0, -0.5, -0.25, 0.0, 0.3, 0.75, 1.0, 1.7, 2.5)
UNIT = (-1.0, -0.6, 0.0, 0.35, 1.0)
POSITIVE = (1e-3, 0.3, 1.0, 2.5, 40.0)

FORMULAS = {
    "sin": (lambda x: cmath.exp(1j * x).imag, ANY),
    "cos": (lambda x: cmath.exp(1j * x).real, ANY),
    "tan": (lambda x: (cmath.exp(2j * x) - 1).imag / (cmath.exp(2j * x) + 1).real, (-1.2, -0.5, 0.0, 0.7)),
    "asin": (lambda x: math.atan2(x, math.sqrt(1 - x * x)), UNIT),
    "acos": (lambda x: math.atan2(math.sqrt(1 - x * x), x), UNIT),
    "atan": (lambda x: cmath.phase(1 + 1j * x), ANY),
    "sinh": (lambda x: (math.exp(x) - math.exp(-x)) / 2, ANY),
    "cosh": (lambda x: (math.exp(x) + math.exp(-x)) / 2, ANY),
    "tanh": (lambda x: 1 - 2 / (math.exp(2 * x) + 1), ANY),
    "exp": (lambda x: math.cosh(x) + math.sinh(x), ANY),
    "sqrt": (lambda x: x**0.5, (0.0, *POSITIVE)),
    "abs": (lambda x: math.hypot(x, 0), ANY),
    "ln": (lambda x: cmath.log(x).real, POSITIVE),
    "log": (lambda x: math.log2(x) / math.log2(10), POSITIVE),
    "lim": (lambda x: (x + abs(x)) / 2, ANY),
    "sat": (lambda x: (abs(x + 1) - abs(x - 1)) / 2, ANY),
    "SAT": (lambda x: (abs(x) - abs(x - 1) + 1) / 2, ANY),
    "deadz": (lambda x: x - (abs(x + 1) - abs(x - 1)) / 2, ANY),
    "deadc": (lambda x: float(x > 1) - float(x < -1), ANY),
    "swtch": (lambda x: float(np.heaviside(x, 0)), ANY),
    "sgn": (lambda x: float(np.sign(x)), ANY),
    "rect": (lambda x: float(abs(x) < 1), ANY),
    "tri": (lambda x: 1 - abs(x), ANY),
    "sinc": (lambda x: float(np.sinc(x / np.pi)), ANY),
    "sigmoid": (lambda x: (1 + math.tanh(x / 2)) / 2, ANY),
    "SIGMOID": (lambda x: 1 - 1 / (1 + x * x) if x > 0 else 0.0, ANY),
    "round": (lambda x: math.copysign(math.floor(abs(x) + 0.5), x), (*ANY, 3.5, -3.5, 1e9 + 0.5)),
    "trnc": (lambda x: math.copysign(math.floor(abs(x)), x), (*ANY, 3.99, -3.99)),
    "floor": (lambda x: x - x % 1.0, (*ANY, 3.99, -3.99)),
    "ceil": (lambda x: x + (-x) % 1.0, (*ANY, 3.01, -3.01)),
    "mod": (lambda x: x % -0.75, ANY),
    "heav": (lambda x: float(x > 0), ANY),
    "recip": (lambda x: x**-1, POSITIVE),
    "atan2": (lambda y: cmath.phase(complex(-0.5, y)), ANY),
    "comp": (lambda x: 7.0 if x > 0 else 3.0, ANY),
    "max": (lambda x: (x + 0.5 + abs(x - 0.5)) / 2, ANY),
    "min": (lambda x: (x + 0.5 - abs(x - 0.5)) / 2, ANY),
}
CALLS = {
    "mod": "mod(x, -0.75)", "atan2": "atan2(x, -0.5)", "comp": "comp(x, 3, 7)", "max": "max(x, 0.5)", "min": "min(x, 0.5)",
}  # fmt: skip
"""How a function of more than one argument is called with the others fixed."""

ELSEWHERE = {
    "ran",
    "gauss",
    "white",
    "delay",
    "tim",
    "func1",
    "func2",
    "Re",
    "Im",
    "Cabs",
    "Arg",
    "Conjug",
    "expj",
}
"""Functions with programs of their own (random_order, white_noise, table_forms, complex_arrays …)."""

PROGRAM = """
n = {n}
ARRAY x[n], s[n], d[n], v[n]
data {points} | read x
for k = 1 to n | s[k] = {script} | next
NN = n
drun
DYNAMIC
get q = x
y = {scalar}
store d = y
Vector v = {vector}
dispt y
"""


def test_every_function_is_tried():
    assert set(LIBRARY) == set(FORMULAS) | ELSEWHERE


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("name", FORMULAS)
def test_function(name, backend, tmp_path):
    formula, points = FORMULAS[name]
    call = CALLS.get(name, f"{name}(x)")
    head, arguments = call[: len(name)], call[len(name) :]
    scalar, script = head + arguments.replace("x", "q"), head + arguments.replace("x", "x[k]")
    text = PROGRAM.format(
        n=len(points), points=", ".join(map(repr, points)), script=script, scalar=scalar, vector=call
    )
    outcome = execute(text, backend, tmp_path)
    assert outcome.error is None, str(outcome.error)
    expected = [formula(x) for x in points]
    for way in ("s", "d", "v"):
        assert outcome.quantities[way] == pytest.approx(expected, rel=1e-14, abs=4e-16), way


IDENTITIES = (
    "abs(x) - lim(x) - lim(-x)",
    "sat(x) - lim(x + 1) + lim(x - 1) + 1",
    "deadz(x) - x + sat(x)",
    "SAT(x) - lim(x) + lim(x - 1)",
    "swtch(x) + swtch(-x) - sgn(x)*sgn(x)",
    "comp(x, 0, 1) - swtch(x)",
)


@pytest.mark.parametrize("identity", IDENTITIES)
def test_identity_holds_everywhere(identity, tmp_path):
    text = f"x = -3\nNN = 601\nt = -3 | TMAX = 6\ndrun\nDYNAMIC\nx = t\ne = {identity}\ndispt e"
    run = execute(text, "native", tmp_path).runs[0]
    assert np.max(np.abs(run.values("e"))) < 1e-15
