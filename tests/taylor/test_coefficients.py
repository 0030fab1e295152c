"""Coefficients of each function and operation against Cauchy's integral, by both back ends."""

import cmath
import re

import numpy as np
import pytest

from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from tests.taylor.series_of import WAYS, by_cauchy, coefficients

A, B = 0.3, 0.7


def inner(t):
    """What functions are taken of: no even or odd function, 0.3 at t = 0."""
    return A + B * t - 0.2 * t * t


FUNCTIONS = {
    # expression of a = inner(t), the same over complex numbers, a radius inside which it is smooth
    "a + t": (lambda a, t: a + t, 0.5),
    "1 - a": (lambda a, t: 1 - a, 0.5),
    "a - t": (lambda a, t: a - t, 0.5),
    "-a": (lambda a, t: -a, 0.5),
    "2.5*a": (lambda a, t: 2.5 * a, 0.5),
    "a/3": (lambda a, t: a / 3, 0.5),
    "a*t": (lambda a, t: a * t, 0.5),
    "a*a": (lambda a, t: a * a, 0.5),
    "a^7": (lambda a, t: a**7, 0.5),
    "(1 + a)^(-3)": (lambda a, t: (1 + a) ** -3, 0.5),
    "1/(1 + a)": (lambda a, t: 1 / (1 + a), 0.5),
    "t/(1 + a)": (lambda a, t: t / (1 + a), 0.5),
    "recip(2 + a)": (lambda a, t: 1 / (2 + a), 0.5),
    "(1 + a)^1.7": (lambda a, t: (1 + a) ** 1.7, 0.5),
    "(1 + a)^(-1.5)": (lambda a, t: (1 + a) ** -1.5, 0.5),
    "(1 + a)^2.5": (lambda a, t: (1 + a) ** 2.5, 0.5),
    "(1 + a)^(-0.5)": (lambda a, t: (1 + a) ** -0.5, 0.5),
    "(1 + a)^3.5": (lambda a, t: (1 + a) ** 3.5, 0.5),
    "(1 + a)^0.5": (lambda a, t: (1 + a) ** 0.5, 0.5),
    "(1 + a)^t": (lambda a, t: (1 + a) ** t, 0.5),
    "p^a": (lambda a, t: 1.5**a, 0.5),
    "sqrt(1 + a)": (lambda a, t: cmath.sqrt(1 + a), 0.5),
    "exp(a)": (lambda a, t: cmath.exp(a), 0.5),
    "ln(1 + a)": (lambda a, t: cmath.log(1 + a), 0.5),
    "log(1 + a)": (lambda a, t: cmath.log10(1 + a), 0.5),
    "sin(a)": (lambda a, t: cmath.sin(a), 0.5),
    "cos(a)": (lambda a, t: cmath.cos(a), 0.5),
    "sin(a)*cos(a)": (lambda a, t: cmath.sin(a) * cmath.cos(a), 0.5),
    "sinc(a)": (lambda a, t: cmath.sin(a) / a, 0.4),
    "sinc(3 + a)": (lambda a, t: cmath.sin(3 + a) / (3 + a), 0.5),
    "sinc(0.95 + a - 0.2)": (lambda a, t: cmath.sin(0.75 + a) / (0.75 + a), 0.5),
    "tan(a)": (lambda a, t: cmath.tan(a), 0.5),
    "asin(a)": (lambda a, t: cmath.asin(a), 0.5),
    "acos(a)": (lambda a, t: cmath.acos(a), 0.5),
    "atan(a)": (lambda a, t: cmath.atan(a), 0.5),
    "atan2(a, 1 + t)": (lambda a, t: cmath.atan(a / (1 + t)), 0.5),
    "atan2(a, p)": (lambda a, t: cmath.atan(a / 1.5), 0.5),
    "sinh(a)": (lambda a, t: cmath.sinh(a), 0.5),
    "cosh(a)": (lambda a, t: cmath.cosh(a), 0.5),
    "tanh(a)": (lambda a, t: cmath.tanh(a), 0.5),
    "sigmoid(a)": (lambda a, t: 1 / (1 + cmath.exp(-a)), 0.5),
    "SIGMOID(a)": (lambda a, t: a * a / (1 + a * a), 0.3),
    "abs(a)": (lambda a, t: a, 0.5),
    "abs(-a)": (lambda a, t: a, 0.5),
    "lim(a)": (lambda a, t: a, 0.5),
    "lim(-a)": (lambda a, t: 0.0, 0.5),
    "sat(a)": (lambda a, t: a, 0.5),
    "sat(a + 2)": (lambda a, t: 1.0, 0.5),
    "sat(a - 2)": (lambda a, t: -1.0, 0.5),
    "SAT(a)": (lambda a, t: a, 0.5),
    "deadz(a + 2)": (lambda a, t: a + 1, 0.5),
    "tri(a)": (lambda a, t: 1 - a, 0.5),
    "max(a, t)": (lambda a, t: a, 0.5),
    "min(a, t)": (lambda a, t: t, 0.5),
    "swtch(a)*a": (lambda a, t: a, 0.5),
    "sgn(-a)": (lambda a, t: -1.0, 0.5),
    "comp(a, t, a*t)": (lambda a, t: a * t, 0.5),
    "sin(p)*a + exp(p)": (lambda a, t: np.sin(1.5) * a + np.exp(1.5), 0.5),
    "1.25": (lambda a, t: 1.25, 0.5),
}


def integral(rates):
    """Coefficients of ∫ f from those of f, both times a radius to the k: index k - 1 → k, times radius/k."""
    return rates[:-1] / np.arange(1, len(rates))


@pytest.mark.parametrize("way", WAYS)
def test_functions_of_t(way):
    """y' = f(a(t)) with y(t) unknown to f: y's coefficients are those of the integral of f."""
    lines = "\n".join(f"d/dt y{i} = {text}" for i, text in enumerate(FUNCTIONS))
    found = coefficients(f"DYNAMIC\na = 0.3 + 0.7*t - 0.2*t*t\n{lines}\n", way, {"p": 1.5})
    wrong = {}
    for i, (text, (f, radius)) in enumerate(FUNCTIONS.items()):
        exact = by_cauchy(lambda t, f=f: f(inner(t), t), 0.0, radius)
        scaled = found[f"y{i}"][1:] * radius ** np.arange(20)
        error = np.abs(scaled - integral(exact)).max() / max(np.abs(exact).max(), 1.0)
        if not error < 4e-15:
            wrong[text] = error
    assert not wrong


@pytest.mark.parametrize("way", WAYS)
def test_functions_of_states(way):
    """The same with a' = 0.7 - 0.4*t as a state."""
    smooth = {text: f for text, f in FUNCTIONS.items() if "comp" not in text}
    text = (
        "DYNAMIC\nd/dt a = 0.7 - 0.4*t\n" + "\n".join(f"d/dt y{i} = {t}" for i, t in enumerate(smooth)) + "\n"
    )
    found = coefficients(text, way, {"a": A, "p": 1.5})
    wrong = {}
    for i, (name, (f, radius)) in enumerate(smooth.items()):
        exact = by_cauchy(lambda t, f=f: f(inner(t), t), 0.0, radius)
        scaled = found[f"y{i}"][1:] * radius ** np.arange(20)
        error = np.abs(scaled - integral(exact)).max() / max(np.abs(exact).max(), 1.0)
        if not error < 4e-15:
            wrong[name] = error
    assert not wrong


SIDE_BY_SIDE = (
    "1 - a", "-a", "2.5*a - 3*b", "p*a + b", "b - p*a", "b - 0.7*a", "0.9*a + b", "b - r*a", "-(s*a)", "-(2*a) + b", "3*a + p*b", "a/3", "a*t", "a*b", "a*a",
    "b/(1 + a)", "1/(1 + a)", "(1 + a)^(-1.5)", "(1 + a)^1.7", "(1 + a)^q", "sqrt(1 + a)", "exp(a)",
    "ln(1 + a*b)", "sin(a)*cos(b)", "abs(a)*b", "comp(b, a, t*a)",
)  # fmt: skip
"""Expressions of a state, a neighbour of it and parameters; some products stand in one sum, some in several."""


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(
    "expressions",
    [SIDE_BY_SIDE, *((power,) for power in ("(1 + a)^(-1.5)", "(1 + a)^2.5", "(1 + a)^1.7"))],
    ids=["many", "-1.5", "2.5", "1.7"],  # exponents that differ become an array, one alone stays a number
)
def test_numbers_equations_that_are_alike(way, expressions):
    """They become short arrays, whose operands are other equations' elements; values by Cauchy's integral."""
    n = 9
    order = [3, 0, 7, 1, 8, 2, 6, 5, 4]
    start = [0.2 + 0.07 * i for i in range(n)]
    lines = [f"d/dt a{i} = {0.5 + 0.1 * i!r} - 0.4*t" for i in range(n)]
    for e, text in enumerate(expressions):
        for i in range(n):
            spelled = re.sub(r"\ba\b", f"a{i}", re.sub(r"\bb\b", f"a{order[i]}", text))
            lines.append(f"d/dt y{e}_{i} = {spelled}")
    given = {f"a{i}": start[i] for i in range(n)} | {"p": 1.5, "q": -0.8, "r": 0.6, "s": 0.3}
    found = coefficients("DYNAMIC\n" + "\n".join(lines) + "\n", way, given)
    wrong = {}
    radius = 0.3
    space = {name: getattr(cmath, name) for name in ("sqrt", "exp", "sin", "cos")}
    space |= {
        "ln": cmath.log,
        "abs": lambda a: a,
        "comp": lambda b, a, c: c,
        "p": 1.5,
        "q": -0.8,
        "r": 0.6,
        "s": 0.3,
    }
    for e, text in enumerate(expressions):
        code = compile(text.replace("^", "**"), text, "eval")
        for i in range(n):

            def f(t, i=i, code=code):
                a, b = (start[k] + (0.5 + 0.1 * k) * t - 0.2 * t * t for k in (i, order[i]))
                return eval(code, space, {"a": a, "b": b, "t": t})

            exact = by_cauchy(f, 0.0, radius, points=64)
            scaled = found[f"y{e}_{i}"][1:] * radius ** np.arange(20)
            error = np.abs(scaled - integral(exact)).max() / max(np.abs(exact).max(), 1.0)
            if not error < 4e-15:
                wrong[f"{text} {i}"] = error
    assert not wrong


ARRAYS = {
    "V + W": lambda v, w, s: v + w,
    "V - W": lambda v, w, s: v - w,
    "2 - V": lambda v, w, s: 2 - v,
    "-V": lambda v, w, s: -v,
    "p*V + C": lambda v, w, s: 1.5 * v + s["C"],
    "C*V": lambda v, w, s: s["C"] * v,
    "V/C": lambda v, w, s: v / s["C"],
    "V*W": lambda v, w, s: v * w,
    "V*t": lambda v, w, s: v * s["t"],
    "t/(2 + W)": lambda v, w, s: s["t"] / (2 + w),
    "V/(2 + W)": lambda v, w, s: v / (2 + w),
    "W/(2 + t)": lambda v, w, s: w / (2 + s["t"]),
    "V^3": lambda v, w, s: v**3,
    "(2 + V)^1.3": lambda v, w, s: (2 + v) ** 1.3,
    "sqrt(2 + V)": lambda v, w, s: np.sqrt(2 + v),
    "exp(V)": lambda v, w, s: np.exp(v),
    "ln(2 + V)": lambda v, w, s: np.log(2 + v),
    "sin(V)*cos(W)": lambda v, w, s: np.sin(v) * np.cos(w),
    "tan(V)": lambda v, w, s: np.tan(v),
    "asin(V/2)": lambda v, w, s: np.arcsin(v / 2),
    "acos(V/2)": lambda v, w, s: np.arccos(v / 2),
    "atan(V)": lambda v, w, s: np.arctan(v),
    "sinh(V)*cosh(W)": lambda v, w, s: np.sinh(v) * np.cosh(w),
    "tanh(V)": lambda v, w, s: np.tanh(v),
    "sigmoid(V)": lambda v, w, s: 1 / (1 + np.exp(-v)),
    "abs(V - 0.5)": lambda v, w, s: np.where(s["V0"] > 0.5, v - 0.5, 0.5 - v),
    "V{1}*V{-2}": lambda v, w, s: shifted(v, 1) * shifted(v, -2),
    "V{20}": lambda v, w, s: 0 * v,
    "A*V": lambda v, w, s: s["A"] @ v,
    "A%*W": lambda v, w, s: s["A"].T @ w,
    "q*V": lambda v, w, s: (v @ w - v.sum()) * v,
    "V*V[3]": lambda v, w, s: v * v[2],
}  # fmt: skip
N = 11


def shifted(v, by):
    """Element i is element i + by, 0 outside."""
    moved = np.zeros_like(v)
    for i in range(len(v)):
        if 0 <= i + by < len(v):
            moved[i] = v[i + by]
    return moved


@pytest.mark.parametrize("way", WAYS)
def test_arrays(way):
    """V' = 1 - 0.4·t and W' = 0.5 over eleven elements that begin differently."""
    rng = np.random.default_rng(5)
    v0, w0, c = rng.uniform(0.1, 0.9, N), rng.uniform(0.1, 0.9, N), rng.uniform(0.5, 2, N)
    matrix = rng.uniform(-0.3, 0.3, (N, N))
    names = [f"Y{i}" for i in range(len(ARRAYS))]
    body = "\n".join(f"Vectr d/dt {name} = {text}" for name, text in zip(names, ARRAYS, strict=True))
    text = f"DYNAMIC\nDOT d = V*W | DOT e = V*1\nq = d - e\nVectr d/dt V = 1 - 0.4*t\nVectr d/dt W = 0.5\n{body}\n"
    given = {"V": v0, "W": w0, "C": c, "A": matrix, "p": 1.5, **dict.fromkeys(names, np.zeros(N))}
    found = coefficients(text, way, given, ("V", "W", *names))
    wrong = {}
    for name, (expression, f) in zip(names, ARRAYS.items(), strict=True):
        radius, points = 0.4, 256
        angles = np.exp(2j * np.pi * np.arange(points) / points) * radius
        values = np.array(
            [f(v0 + t - 0.2 * t * t, w0 + 0.5 * t, {"C": c, "A": matrix, "V0": v0, "t": t}) for t in angles]
        )
        exact = (np.fft.fft(values, axis=0) / points).real[:21]
        scaled = found[name][1:] * (radius ** np.arange(20))[:, None]
        error = np.abs(scaled - exact[:-1] / np.arange(1, 21)[:, None]).max() / max(np.abs(exact).max(), 1)
        if not error < 4e-15:
            wrong[expression] = error
    assert not wrong


@pytest.mark.parametrize("error_max", [0.0, 1e-5])
def test_quick_and_fast_code_have_the_same_bits(error_max):
    """A run changes over when the clock says so; small models' fast code has no loop over the order."""
    few = {"a*t", "a*a", "t/(1 + a)", "(1 + a)^1.7", "sqrt(1 + a)", "sin(a)*cos(a)", "atan(a)", "abs(-a)"}
    for text in few:
        body = f"DYNAMIC\nd/dt a = 0.7 - 0.4*t*a\nd/dt y = {text}\nd/dt z = a*y - z/3\n"
        quick, fast = (
            coefficients(body, way, {"a": A, "y": 0.1, "z": 1.3}, error_max=error_max)
            for way in ("quick", "fast")
        )
        order = 20 if error_max == 0.0 else 11
        for name in "ayz":
            assert (quick[name][: order + 1] == fast[name][: order + 1]).all(), text


@pytest.mark.parametrize("way", WAYS)
def test_states_coefficients_are_divided_by_the_order(way):
    """Times a rounded 1/k they would be off to one side in every step, and energies drift."""
    body = "DYNAMIC\nd/dt v = -1.7*v\nd/dt x = v\nVectr d/dt W = -1.7*W\nVectr d/dt X = W\n"
    start = np.array([0.3, 1.1, 2.3])
    found = coefficients(body, way, {"v": 0.7, "x": 0.0, "W": start, "X": 0 * start}, ("W", "X"))
    for k in range(1, ORDER_MOST + 1):
        assert found["x"][k] == found["v"][k - 1] / k
        assert (found["X"][k] == found["W"][k - 1] / k).all()
