"""Every library function in compiled code, scalar and elementwise, against the interpreter's table."""

import math

import numpy as np
import pytest

from desire_tui.engine.codegen.ir.functions import C_FUNCTIONS
from desire_tui.engine.library import LIBRARY
from tests.codegen.conftest import run

POINTS = [-3.5, -1.5, -1.0, -0.5, -0.25, 0.0, 0.3, 0.5, 1.0, 1.25, 2.5, 4.0, 19.0]
POSITIVE = {"ln", "log", "sqrt"}
UNIT = {"asin", "acos"}
ONE = sorted(
    name
    for name, entry in LIBRARY.items()
    if entry.kind in {"real", "complex"} and (entry.fewest, entry.most) == (1, 1) and "D" in entry.where
    and not name.startswith(("Re", "Im", "C", "Arg"))
)  # fmt: skip


def points_for(name):
    if name in POSITIVE:
        return [x for x in POINTS if x > 0]
    if name in UNIT:
        return [x for x in POINTS if abs(x) <= 1]
    if name == "recip":
        return [x for x in POINTS if x]
    return POINTS


@pytest.mark.parametrize("name", ONE)
def test_one_argument(name):
    points = points_for(name)
    exact = [LIBRARY[name].value(x) for x in points]
    n = len(points)
    lines = "\n".join(f"x[{k}] = {x}" for k, x in enumerate(points, 1))
    scalars = "\n".join(f"s{k} = {name}(x{k})\ny[{k}] = s{k}" for k in range(1, n + 1))
    parameters = "\n".join(f"x{k} = {x}" for k, x in enumerate(points, 1))
    made = run(
        f"ARRAY x[{n}], y[{n}], z[{n}]\n{lines}\n{parameters}\nNN = 2\ndrun\nDYNAMIC\n"
        f"{scalars}\nVector z = {name}(x)\ndispt s1\n"
    )
    assert made.array("y").tolist() == exact  # the same library, the same formulas: the same bits
    for value, wanted in zip(made.array("z"), exact, strict=True):
        ulps = 4 if name in C_FUNCTIONS or name in {"sinc", "sigmoid"} else 0
        assert abs(value - wanted) <= ulps * math.ulp(wanted) + (1e-16 if ulps else 0), (name, value, wanted)


@pytest.mark.parametrize(
    ("call", "wanted"),
    [
        ("atan2(3, -4)", math.atan2(3, -4)),
        ("comp(-1, 5, 6) + comp(0, 50, 60) + comp(1, 500, 600)", 5 + 50 + 600),
        ("max(2, -3) - min(2, -3)", 5.0),
        ("2.5^1.5", 2.5**1.5),
        ("2^10 + 3^-2", 1024 + 1 / 9),
        ("round(2.5) + round(-2.5) + round(-0.4)", 0.0),
    ],
)
def test_several_arguments(call, wanted):
    assert run(f"NN = 2\ndrun\nDYNAMIC\ny = {call}\ndispt y\n").scalar("y") == pytest.approx(
        wanted, rel=1e-15
    )


def test_identities_of_limiters():
    made = run(
        "TMAX = 6 | NN = 61 | t = -3\ndrun\nDYNAMIC\nx = t\n"
        "a = abs(x) - lim(x) - lim(-x)\nb = sat(x) - lim(x + 1) + lim(x - 1) + 1\nc = deadz(x) - x + sat(x)\n"
        "d = SAT(x) - lim(x) + lim(x - 1)\ndispt a, b, c, d\n"
    )
    assert np.abs(made.rows[:, 1:]).max() < 1e-15


def test_table_functions_interpolate_and_are_constant_outside():
    made = run(
        "ARRAY X[3] + Y[3] = F, G[2,2], P[2], Q[2]\ndata 0, 1, 3, 5, 7, 1\nread F\n"
        "data 0, 10, 100, 110 | read G | data 0, 1 | read P | data 0, 2 | read Q\n"
        "TMAX = 5 | NN = 11 | t = -1\ndrun\nDYNAMIC\ny = func1(t; F)\nz = func2(t, t; G, P, Q)\ndispt y, z\n"
    )
    t = made.rows[:, 0]
    np.testing.assert_allclose(made.rows[:, 1], np.interp(t, [0, 1, 3], [5, 7, 1]), atol=1e-14)
    np.testing.assert_allclose(made.rows[:, 2], 100 * np.clip(t, 0, 1) + 5 * np.clip(t, 0, 2), atol=1e-12)
