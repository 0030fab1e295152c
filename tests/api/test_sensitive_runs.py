"""Derivatives along runs against complex steps through independent code, and against solutions in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_TINY = 1e-30


class Case(NamedTuple):
    """A program under rule 3, and the same model for complex numbers: `start(p)`, `slope(t, x, p)`."""

    program: str
    parameters: Mapping[str, float]
    outputs: tuple[str, ...]
    start: Callable
    slope: Callable
    end: float
    step: float
    samples: int = 5


def runge_kutta(case, p):
    """The classical method of order 4, sample by sample, in numbers of any kind."""
    x, t = case.start(p), 0.0
    rows = [x]
    steps = round(case.end / case.step / (case.samples - 1))
    for _ in range(case.samples - 1):
        for _ in range(steps):
            h, f = case.step, case.slope
            k1 = f(t, x, p)
            k2 = f(t + h / 2, x + h / 2 * k1, p)
            k3 = f(t + h / 2, x + h / 2 * k2, p)
            k4 = f(t + h, x + h * k3, p)
            x, t = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), t + h
        rows.append(x)
    return np.array(rows).T


def complex_steps(solution, parameters):
    """Derivatives (parameters, outputs, samples) of a solution by each parameter."""
    return np.array(
        [
            np.imag(solution({**parameters, name: parameters[name] + _TINY * 1j})) / _TINY
            for name in parameters
        ]
    )


def _heat(t, u, p):
    padded = np.concatenate([[0], u, [0]])
    return p["D"] * (padded[2:] - 2 * u + padded[:-2]) - p["q"] * u * u * u


CASES = {
    "computed by the script": Case(
        "k = 0.5 | a = 1.5 | b = 2*k + a*a | x = exp(k)*a\nTMAX = 2 | DT = 0.02",
        {"k": 0.5, "a": 1.5}, ("x",),
        lambda p: np.array([np.exp(p["k"]) * p["a"]]),
        lambda t, x, p: -p["k"] * x + (2 * p["k"] + p["a"] ** 2) * np.sin(t), 2.0, 0.02,
    ),
    "Lotka and Volterra": Case(
        "a = 1.1 | b = 0.4 | d = 0.1 | g = 0.4 | u = 10 | w = 5\nTMAX = 10 | DT = 0.02",
        {"a": 1.1, "b": 0.4, "d": 0.1, "g": 0.4, "u": 10.0}, ("u", "w"),
        lambda p: np.array([p["u"], 5.0]),
        lambda t, x, p: np.array([p["a"] * x[0] - p["b"] * x[0] * x[1], p["d"] * x[0] * x[1] - p["g"] * x[1]]),
        10.0, 0.02,
    ),
    "Van der Pol": Case(
        "mu = 1 | x = 2\nTMAX = 8 | DT = 0.02", {"mu": 1.0, "x": 2.0}, ("x", "v"),
        lambda p: np.array([p["x"], 0.0]),
        lambda t, x, p: np.array([x[1], p["mu"] * (1 - x[0] ** 2) * x[1] - x[0]]), 8.0, 0.02,
    ),
    "Lorenz": Case(
        "s = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 1\nTMAX = 4 | DT = 0.005",
        {"s": 10.0, "r": 28.0}, ("x", "y", "z"),
        lambda p: np.ones(3),
        lambda t, x, p: np.array(
            [p["s"] * (x[1] - x[0]), x[0] * (p["r"] - x[2]) - x[1], x[0] * x[1] - 8 / 3 * x[2]]
        ),
        4.0, 0.005,
    ),
    "SIR": Case(
        "N = 1000 | b = 0.4 | g = 0.1 | S = N - 1 | J = 1\nTMAX = 60 | DT = 0.25",
        {"b": 0.4, "g": 0.1, "N": 1000.0}, ("S", "J", "R"),
        lambda p: np.array([p["N"] - 1, 1.0, 0.0]),
        lambda t, x, p: np.array(
            [-p["b"] * x[0] * x[1] / p["N"], p["b"] * x[0] * x[1] / p["N"] - p["g"] * x[1], p["g"] * x[1]]
        ),
        60.0, 0.25,
    ),
    "pendulum": Case(
        "l = 2 | c = 0.2 | deg = 100 | q = deg*PI/180\nTMAX = 10 | DT = 0.02", {"l": 2.0, "c": 0.2, "deg": 100.0},
        ("q", "w", "E"),
        lambda p: np.array([p["deg"] * np.pi / 180, 0.0]),
        lambda t, x, p: np.array([x[1], -9.81 / p["l"] * np.sin(x[0]) - p["c"] * x[1]]), 10.0, 0.02,
    ),
    "Hill": Case(
        "n = 2.5 | K = 1.5 | x = 0.1\nTMAX = 6 | DT = 0.02", {"n": 2.5, "K": 1.5}, ("x",),
        lambda p: np.array([0.1]),
        lambda t, x, p: 0.1 + 2 * x ** p["n"] / (p["K"] ** p["n"] + x ** p["n"]) - x, 6.0, 0.02,
    ),
    "heat, 200 states": Case(
        "STATE u[200] | D = 1.3 | q = 0.1 | a = 2\nfor i = 1 to 200 | u[i] = a*sin(i*PI/100) | next\n"
        "TMAX = 1 | DT = 0.05", {"D": 1.3, "q": 0.1, "a": 2.0}, ("u",),
        lambda p: p["a"] * np.sin(np.arange(1, 201) * np.pi / 100), _heat, 1.0, 0.05,
    ),
}  # fmt: skip
SEGMENTS = {
    "computed by the script": "d/dt x = -k*x + b*sin(t)",
    "Lotka and Volterra": "d/dt u = a*u - b*u*w\nd/dt w = d*u*w - g*w",
    "Van der Pol": "d/dt x = v\nd/dt v = mu*(1 - x*x)*v - x",
    "Lorenz": "d/dt x = s*(y - x)\nd/dt y = x*(r - z) - y\nd/dt z = x*y - b*z",
    "SIR": "flow = b*S*J/N\nd/dt S = -flow\nd/dt J = flow - g*J\nd/dt R = g*J",
    "pendulum": "d/dt q = w\nd/dt w = -9.81/l*sin(q) - c*w\nE = 0.5*l*w^2 - 9.81*cos(q)",
    "Hill": "d/dt x = 0.1 + 2*x^n/(K^n + x^n) - x",
    "heat, 200 states": "Vectr d/dt u = D*(u{1} - 2*u + u{-1}) - q*u*u*u",
}


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("name", CASES)
def test_derivatives_of_fixed_steps_are_those_of_complex_steps(name, backend):
    case = CASES[name]
    program = f"irule 3 | NN = {case.samples}\n{case.program}\ndrun\nDYNAMIC\n{SEGMENTS[name]}\ndispt {case.outputs[0]}"
    program = program.replace("dispt u", "dispt u[1]" if "STATE u" in program else "dispt u")
    model = desire_tui.load(program, backend=backend)
    made = model.sensitive_runs(case.parameters, case.outputs)()

    def solution(p):
        x = runge_kutta(case, p)
        if name == "pendulum":
            return np.array([*x, 0.5 * p["l"] * x[1] ** 2 - 9.81 * np.cos(x[0])])
        return x

    wanted = complex_steps(solution, case.parameters)
    assert made.is_exact
    assert made.derivatives.shape == wanted.shape
    scale = np.abs(wanted).max(axis=(1, 2), keepdims=True)
    assert np.abs((made.derivatives - wanted) / scale).max() < 1e-10
    assert np.abs(made.values - np.real(solution(case.parameters))).max() < 1e-9


def closed_form(program, parameters, output, solution, bound=1e-8, backend="native"):
    """Hold values and derivatives to a solution in closed form, `solution(t, p)`."""
    model = desire_tui.load(program, backend=backend)
    made = model.sensitive_runs(parameters, [output])()
    assert made.error is None
    assert made.is_exact
    wanted = complex_steps(lambda p: np.array([[solution(t, p) for t in made.t]]), parameters)
    scale = np.abs(wanted).max(axis=(1, 2), keepdims=True)
    assert np.abs((made.derivatives - wanted) / scale).max() < bound
    values = np.real(solution(made.t[-1], parameters))
    assert made.values[0, -1] == pytest.approx(values, rel=bound, abs=bound)


def bounce(t, p):
    """Height of a ball that falls from y and keeps the part e of its speed."""
    g, e, y = p["g"], p["e"], p["y"]
    v, begin, height = 0.0, 0.0, y
    while True:
        lands = begin + (v + np.sqrt(v * v + 2 * g * height)) / g
        if np.real(lands) > t:
            since = t - begin
            return height + v * since - g / 2 * since * since
        v, begin, height = e * (g * (lands - begin) - v), lands, 0.0


BALL = "g = 9.81 | e = 0.8 | y = 10\nTMAX = 6 | DT = 0.01 | NN = 13\n{}\ndrun\nDYNAMIC\nd/dt y = v\nd/dt v = -g\ndispt y\nevent -y\nv = -e*v | y = 0"


@pytest.mark.parametrize("rule", ["irule 1", "irule 3", "irule 4 | ERMAX = 1e-9", "irule 14 | ERMAX = 1e-9"])
def test_a_ball_bounces_at_times_that_depend_on_everything(rule):
    closed_form(BALL.format(rule), {"g": 9.81, "e": 0.8, "y": 10.0}, "y", bounce, 1e-9)


def doses(t, p):
    ticks = [p["s"] + k * p["T"] for k in range(100)]
    return sum(p["m"] * np.exp(-p["k"] * (t - tick)) for tick in ticks if np.real(tick) <= t)


def test_a_clock_whose_period_is_a_parameter():
    program = (
        "irule 3 | TMAX = 30.3 | DT = 0.02 | NN = 11 | T = 5.7 | s = 1.3 | k = 0.1 | m = 3\ndrun\n"
        "DYNAMIC\nd/dt A = -k*A\ndispt A\nevery T, s\nA = A + m"
    )
    closed_form(program, {"T": 5.7, "s": 1.3, "k": 0.1, "m": 3.0}, "A", doses)


def threshold(t, p):
    """dx/dt = a until x passes b, then c - x."""
    crossing = p["b"] / p["a"]
    return p["a"] * t if np.real(crossing) > t else p["c"] + (p["b"] - p["c"]) * np.exp(crossing - t)


@pytest.mark.parametrize(
    "jump", ["comp(x - b, a, c - x)", "a + swtch(x - b)*(c - x - a)", "a + (sgn(x - b) + 1)*(c - x - a)/2"]
)
def test_a_jump_in_a_derivative_moves_with_what_sets_it_off(jump):
    program = f"irule 3 | TMAX = 4 | DT = 0.01 | NN = 8 | a = 1 | b = 1.23 | c = 5\ndrun\nDYNAMIC\nd/dt x = {jump}\ndispt x"
    closed_form(program, {"a": 1.0, "b": 1.23, "c": 5.0}, "x", threshold)


def test_an_if_and_a_switch_by_time():
    program = (
        "irule 4 | ERMAX = 1e-10 | TMAX = 4 | DT = 0.01 | NN = 8 | a = 1 | b = 1.23 | c = 5\ndrun\n"
        "DYNAMIC\nif t - b/a\nu = c - x\nelse\nu = a\nend if\nd/dt x = u\ndispt x"
    )
    closed_form(program, {"a": 1.0, "b": 1.23, "c": 5.0}, "x", threshold)


def stairs(t, p):
    """The integral of round(a*s) from 0 to t."""
    edges = [(k + 0.5) / p["a"] for k in range(100)]
    return sum(t - edge for edge in edges if np.real(edge) < t)


def test_stairs():
    program = "irule 3 | TMAX = 4 | DT = 0.01 | NN = 8 | a = 1.7\ndrun\nDYNAMIC\nd/dt u = a\nd/dt x = round(u)\ndispt x"
    closed_form(program, {"a": 1.7}, "x", stairs)


def test_an_event_that_another_sets_off_happens_at_its_time():
    program = (
        "irule 3 | TMAX = 4 | DT = 0.01 | NN = 8 | a = 1 | b = 1.23 | c = 5 | on = 0 | done = 0\ndrun\n"
        "DYNAMIC\nd/dt x = comp(done, a, c - x)\ndispt x\nevent x - b\non = 1\nevent on - 0.5\ndone = 1"
    )
    closed_form(program, {"a": 1.0, "b": 1.23, "c": 5.0}, "x", threshold)


def late(t, p):
    k, x = p["k"], p["x"]
    return x * (1 - k * t) if t <= 1 else x * (1 - k * t + k * k * (t - 1) ** 2 / 2)


def test_a_delay_remembers_derivatives():
    program = "x = 1.5 | k = 0.8 | irule 3 | TMAX = 2 | DT = 0.01 | NN = 9\ndrun\nDYNAMIC\nd/dt x = -k*delay(x, 1)\ndispt x"
    closed_form(program, {"k": 0.8, "x": 1.5}, "x", late, 1e-10)


def test_a_stiff_model_against_the_matrix_exponential():
    from scipy.linalg import expm

    program = (
        "a = 1e4 | b = 3e3 | c = 0.5 | x = 1 | irule 14 | ERMAX = 1e-10 | ERABS = 1e-14 | TMAX = 5 | DT = 1e-6 | NN = 6\ndrun\n"
        "DYNAMIC\nd/dt x = -a*x + b*y\nd/dt y = a*x - b*y - c*y\nd/dt z = c*y\ndispt x"
    )
    parameters = {"a": 1e4, "b": 3e3, "c": 0.5}
    model = desire_tui.load(program)
    made = model.sensitive_runs(parameters, ["x", "y", "z"])()
    assert made.is_exact

    def solution(p):
        a, b, c = p["a"], p["b"], p["c"]
        matrix = np.array([[-a, b, 0], [a, -b - c, 0], [0, c, 0]])
        values, vectors = np.linalg.eig(matrix)
        weights = np.linalg.solve(vectors, np.array([1, 0, 0]))
        return np.array([vectors @ (np.exp(values * t) * weights) for t in made.t]).T

    here = np.real(solution(parameters))
    assert np.allclose(
        here[:, -1], expm(np.array([[-1e4, 3e3, 0], [1e4, -3e3 - 0.5, 0], [0, 0.5, 0]]) * 5)[:, 0]
    )
    wanted = complex_steps(solution, parameters)
    scale = np.abs(wanted).max(axis=(1, 2), keepdims=True)
    assert np.abs((made.derivatives - wanted) / scale).max() < 1e-8


def test_robertson_against_another_solver_of_its_variational_equations():
    from scipy.integrate import solve_ivp

    program = (
        "k1 = 0.04 | k2 = 1e4 | k3 = 3e7 | y1 = 1 | irule 14 | ERMAX = 1e-11 | ERABS = 1e-16\n"
        "TMAX = 40 | DT = 1e-6 | NN = 5\ndrun\nDYNAMIC\nd/dt y1 = -k1*y1 + k2*y2*y3\n"
        "d/dt y2 = k1*y1 - k2*y2*y3 - k3*y2*y2\nd/dt y3 = k3*y2*y2\ndispt y1"
    )
    k1, k2, k3 = 0.04, 1e4, 3e7
    made = desire_tui.load(program).sensitive_runs(["k1", "k2", "k3"], ["y1", "y2", "y3"])()

    def slope(_t, z):
        y, s = z[:3], z[3:].reshape(3, 3)
        jacobian = np.array(
            [[-k1, k2 * y[2], k2 * y[1]], [k1, -k2 * y[2] - 2 * k3 * y[1], -k2 * y[1]], [0, 2 * k3 * y[1], 0]]
        )
        by_k = np.array([[-y[0], y[1] * y[2], 0], [y[0], -y[1] * y[2], -(y[1] ** 2)], [0, 0, y[1] ** 2]])
        f = [-k1 * y[0] + k2 * y[1] * y[2], k1 * y[0] - k2 * y[1] * y[2] - k3 * y[1] ** 2, k3 * y[1] ** 2]
        return np.concatenate([f, (jacobian @ s + by_k).ravel()])

    start = np.zeros(12)
    start[0] = 1.0
    floor = np.repeat([[1e-15] * 3, [1e-15] * 3, [1e-18] * 3, [1e-23] * 3], 1, axis=0)
    atol = np.concatenate([floor[0], np.column_stack([floor[1], floor[2], floor[3]]).ravel()])
    found = solve_ivp(slope, (0, 40), start, "Radau", made.t, rtol=1e-10, atol=atol).y
    wanted = found[3:].reshape(3, 3, -1).transpose(1, 0, 2)
    scale = np.abs(wanted).max(axis=(1, 2), keepdims=True)
    assert np.abs((made.derivatives - wanted) / scale).max() < 1e-8


NOISY = """k = 2 | x = 1 | q = 0 | SEED 7 | TMAX = 1 | DT = 0.01 | NN = 5
drun
DYNAMIC
d/dt x = -k*x + q
step
q = 0.1*ran()*k
dispt x
"""


def test_where_numbers_are_drawn_derivatives_are_differences_of_runs():
    model = desire_tui.load(NOISY)
    runs = model.sensitive_runs(["k"], ["x"])
    made = runs()
    assert not made.is_exact
    h = 1e-4
    up, down = (model.run(k=2 + s * h, record="x")["x"] for s in (1, -1))
    assert made.derivatives[0, 0] == pytest.approx((up - down) / (2 * h), abs=1e-6)


def test_a_parameter_that_nothing_reads_has_no_influence():
    made = desire_tui.load(
        "a = 1 | b = 2 | x = 1 | TMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = -a*x\ndispt x"
    ).sensitive_runs(["a", "b"], ["x"])()
    assert np.abs(made.derivatives[0]).max() > 0.3
    assert not made.derivatives[1].any()


def test_a_script_that_has_to_run_again_gives_derivatives_too():
    program = (
        "p = 2 | if p > 0 then x = p^3 else x = 0 | proceed\nfor i = 1 to 3 | x = x + p*i | next\n"
        "irule 3 | TMAX = 1 | DT = 0.01 | NN = 3\ndrun\nDYNAMIC\nd/dt x = -p*x\ndispt x"
    )
    closed_form(program, {"p": 2.0}, "x", lambda t, p: (p["p"] ** 3 + 6 * p["p"]) * np.exp(-p["p"] * t), 1e-8)


def test_other_values_and_other_times_are_those_of_a_run():
    model = desire_tui.load(SEGMENT_OF_DECAY)
    runs = model.sensitive_runs(["k"], ["x"])
    made = runs({"k": 0.3, "x": 5.0}, samples=4, t=(0.0, 6.0))
    assert made.t == pytest.approx([0, 2, 4, 6])
    assert made.values[0] == pytest.approx(5 * np.exp(-0.3 * made.t), rel=1e-8)
    assert made.derivatives[0, 0] == pytest.approx(-made.t * 5 * np.exp(-0.3 * made.t), rel=1e-7)


SEGMENT_OF_DECAY = "k = 1 | x = 1 | irule 3 | TMAX = 1 | DT = 0.01\ndrun\nDYNAMIC\nd/dt x = -k*x\ndispt x"


@pytest.mark.parametrize(("parameters", "record"), [(["kk"], ["x"]), (["k"], ["xx"])])
def test_names_that_are_not_there(parameters, record):
    with pytest.raises(DesireError, match="409"):
        desire_tui.load(SEGMENT_OF_DECAY).sensitive_runs(parameters, record)


def test_what_starts_at_an_infinite_slope_goes_on():
    program = "q = 1 | c = 0.5 | irule 3 | TMAX = 60 | DT = 0.01 | NN = 3\ndrun\nDYNAMIC\nd/dt h = q - c*sqrt(h)\ndispt h"
    made = desire_tui.load(program).sensitive_runs(["q", "c"], ["h"])()
    assert made.error is None
    assert made.derivatives[:, 0, -1] == pytest.approx([8.0, -16.0], rel=0.02)  # h = (q/c)^2 in the end
