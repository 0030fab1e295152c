"""XPPAUT's files, converted and run, against exact solutions, scipy, and figures that XPPAUT 6.11 printed.

The files in `ode/` are our own, written from published equations.
"""

from __future__ import annotations

from math import cos, exp, log, sin, sqrt, tanh
from pathlib import Path

import numpy as np
import pytest

import desire_tui
from desire_tui.convert.conversion import Conversion, convert
from desire_tui.engine.files import read_source

ODE = Path(__file__).parent / "ode"


def converted(name: str) -> Conversion:
    conversion = convert(read_source(ODE / f"{name}.ode"))
    assert conversion.complete, conversion.problems
    return conversion


def final(name: str, *states: str) -> list[float]:
    """Return states where the last run of the converted program ends."""
    run = desire_tui.load(converted(name).text).run(record=states, check=True)
    return [float(run[state][-1]) for state in states]


def logistic(x: float) -> float:
    return 1 / (1 + exp(-x))


# what the files say, once more: derivatives, starts, end
SMOOTH = {
    "lotka_volterra": (lambda t, x, y: (1.1*x - 0.4*x*y, 0.1*x*y - 0.4*y), {"x": 10, "y": 5}, 20),
    "van_der_pol": (lambda t, x, y: (y, 100*(1 - x*x)*y - x), {"x": 2, "y": 0}, 60),
    "lorenz": (
        lambda t, x, y, z: (10*(y - x), 27*x - y - x*z, -2.66666*z + x*y),
        {"x": -7.5, "y": -3.6, "z": 30},
        3,
    ),
    "roessler": (lambda t, x, y, z: (-y - z, x + 0.2*y, 0.2 + z*(x - 5.7)), {"X": 1, "Y": 0, "Z": 0}, 20),
    "brusselator": (lambda t, u, v: (1 - 4*u + u*u*v, 3*u - u*u*v), {"u": 1, "v": 1}, 20),
    "fitzhugh": (
        lambda t, v, w: (v*(1 - v)*(v - 0.25) - w + 0.1*sin(2*t) + 0.25, 0.05*(v - w)),
        {"v": 0, "w": 0},
        100,
    ),
    "morris_lecar": (
        lambda t, v, w: (
            0.5*(-0.5 - v) + 2*w*(-0.7 - v) - 0.5*(1 + tanh((v - 0.01)/0.145))*(v - 1) + 0.2,
            0.333*np.cosh((v - 0.1)/0.3)*(0.5*(1 + tanh((v - 0.1)/0.15)) - w),
        ),
        {"v": 0.05, "w": 0},
        40,
    ),
    "hodgkin_huxley": (
        lambda t, v, m, h, n: (
            10 - 120*m**3*h*(v - 115) - 36*n**4*(v + 12) - 0.3*(v - 10.6),
            0.1*(25 - v)/(exp((25 - v)/10) - 1)*(1 - m) - 4*exp(-v/18)*m,
            0.07*exp(-v/20)*(1 - h) - h/(exp((30 - v)/10) + 1),
            0.01*(10 - v)/(exp((10 - v)/10) - 1)*(1 - n) - 0.125*exp(-v/80)*n,
        ),
        {"v": 12, "m": 0.05, "h": 0.6, "n": 0.3},
        20,
    ),
    "epidemic": (
        lambda t, s, i, r: (-0.5*s*i/1000, 0.5*s*i/1000 - 0.1*i, 0.1*i), {"s": 999, "i": 1, "r": 0}, 60
    ),
    "pendulum": (lambda t, x, v: (v, -0.2*v - 9.8*sin(x)), {"x": 2, "xp": 0}, 10),
    "duffing": (lambda t, x, v: (v, x - x**3 - 0.3*v + 0.37*cos(1.2*t)), {"x": 1, "v": 0}, 30),
    "oregonator": (
        lambda t, x, y, z: (77.27*(y - x*y + x - 8.375e-6*x*x), (-y - x*y + z)/77.27, 0.161*(x - z)),
        {"x": 1, "y": 1, "z": 1},
        100,
    ),
    "wilson_cowan": (
        lambda t, u, v: (
            -u + logistic(15*u - 9*v - 3 + (1.2*t if t < 1 else 0)), (-v + logistic(20*u - 3*v - 3))/5
        ),
        {"u": 0.0426, "v": 0.0834},
        20,
    ),
    "chemostat": (
        lambda t, s, b: (
            0.3*(t < 5)*(10 - s) - s/(2 + s)*b/0.5, s/(2 + s)*b - 0.3*(t < 5)*b
        ),
        {"s": 10, "b": 0.1},
        10,
    ),
    "presets": (lambda t, x, v: (v, -9.81*sin(x)), {"x": 0.5, "v": 0}, 5),
    "phase_ring": (
        lambda t, *x: tuple(1 + 0.1*j + 0.1*sum(sin(other - x[j]) for other in x) for j in range(5)),
        {f"x{j}": j for j in range(5)},
        10,
    ),
}  # fmt: skip
WITHIN = {"wilson_cowan": 1e-4, "chemostat": 1e-4, "van_der_pol": 1e-4, "oregonator": 1e-4}
"""Relative; steps in the input are met within DT, stiff rules are asked for 1e-9 a step."""


@pytest.mark.parametrize("name", SMOOTH)
def test_smooth_models_against_scipy(name):
    from scipy.integrate import solve_ivp

    rates, starts, end = SMOOTH[name]
    stiff = name in {"van_der_pol", "oregonator"}
    right = solve_ivp(
        lambda t, x: rates(t, *x), (0, end), list(map(float, starts.values())),
        method="Radau" if stiff else "DOP853", rtol=1e-10, atol=1e-11, max_step=0.1 if not stiff else np.inf,
    ).y[:, -1]  # fmt: skip
    assert final(name, *starts) == pytest.approx(right, rel=WITHIN.get(name, 1e-6), abs=1e-7)


def test_a_ball_against_its_parabolas():
    """Impacts come with the speeds c·0.8^k."""
    g, keep, y, v, t = 9.8, 0.8, 50.0, 0.0, 0.0
    flight = sqrt(2 * y / g)
    while t + flight < 10:
        t += flight
        v = keep * (abs(v - g * flight) if y else v)
        y, flight = 0.0, 2 * v / g
    rest = 10 - t
    assert final("bouncing_ball", "y", "v") == pytest.approx(
        [y + v * rest - g * rest**2 / 2, v - g * rest], rel=1e-6
    )


def test_an_integrator_that_fires_at_multiples_of_ln_2():
    count = int(10 / log(2))
    assert final("integrate_and_fire", "n", "v") == pytest.approx(
        [count, 2 * (1 - exp(-(10 - count * log(2))))], rel=1e-6
    )


def test_flags_with_hysteresis_and_one_that_stops():
    """On for 10·ln(12/8), off for 10·ln(22/18) from the first rise on; `arret` ends the run at 40."""
    t, q, on = 10 * log(12 / 8), 22.0, 0
    while True:
        span = 10 * log(22 / 18) if not on else 10 * log(12 / 8)
        if t + span > 40:
            break
        t, q, on = t + span, 18.0 if not on else 22.0, 1 - on
    goal = 30.0 * on
    run = desire_tui.load(converted("thermostat").text).run(record=["q", "on"])
    assert run.t[-1] == pytest.approx(40, abs=0.02)
    assert run["on"][-1] == on
    assert run["q"][-1] == pytest.approx(goal + (q - goal) * exp(-(run.t[-1] - t) / 10), rel=1e-6)


@pytest.mark.parametrize(
    ("name", "end"),
    [
        ("delay_history", -0.5),  # 1 - t, then 1 - t + (t - 1)^2/2
        ("delay_zero", 0.0),  # 3, then 3 - 3*(t - 1)
        ("delay_formula", -0.5),  # minus the integral of 1 - (t - 1), from 1
    ],
)
def test_delays_against_the_method_of_steps(name, end):
    assert final(name, "x") == pytest.approx([end], abs=2e-4 if name == "delay_zero" else 1e-6)


def test_maps_are_iterated_together_and_start_at_t_0():
    run = desire_tui.load(converted("logistic_map").text).run(check=True)
    x, right = 0.3, []
    for _ in range(41):
        right.append(x)
        x = 3.7 * x * (1 - x)
    assert run["x"] == pytest.approx(right, rel=1e-9)
    assert run["double"] == pytest.approx(2 * run["x"])
    assert list(run.t) == list(range(41))
    x, y = 0.1, 0.1
    for _ in range(30):
        x, y = 1 - 1.4 * x * x + y, 0.3 * x
    assert final("henon", "x", "y") == pytest.approx([x, y], rel=1e-9)


def test_arrays_are_written_out():
    from scipy.linalg import expm

    matrix = np.diag(np.full(11, -2.0)) + np.diag(np.ones(10), 1) + np.diag(np.ones(10), -1)
    assert final("heat_rod", *(f"u{k}" for k in range(11))) == pytest.approx(
        expm(2 * matrix) @ np.ones(11), rel=1e-7
    )
    assert final("repeated_block", "x1", "x2", "x3") == pytest.approx(
        [cos(5 * sqrt(k)) for k in (1, 2, 3)], rel=1e-6
    )


def test_tables_run_straight_between_and_beyond_their_points():
    """Chords of t² at 0, 0.5 … 2: their integrals are sums of trapezes."""
    upto_2 = sum((a * a + b * b) / 4 for a, b in ((0, 0.5), (0.5, 1), (1, 1.5), (1.5, 2)))
    beyond = (4 + 7.5) / 2
    assert final("table_formula", "x", "y") == pytest.approx([upto_2 + beyond, -0.5 * 9 / 2], rel=1e-5)
    assert final("table_file", "x") == pytest.approx([(1 + 3) / 2 + (3 + 2) / 2 + (2 + 1) / 2], rel=1e-5)


def test_presets_are_procedures_of_the_script():
    from scipy.integrate import solve_ivp

    text = converted("presets").text
    called = text.replace("\ndrun\n", "\ncall set_long\ndrun\n").replace("\nx = 0.5", "\nx = 0.5 | v = 0")
    run = desire_tui.load(called).run(record="x", check=True)
    right = solve_ivp(lambda _, x: (x[1], -9.81 / 4 * sin(x[0])), (0, 5), [1, 0], rtol=1e-10, atol=1e-10)
    assert run["x"][-1] == pytest.approx(right.y[0, -1], rel=1e-6)
    assert "PROCEDURE set_moon" in text
    assert "TMAX = 20" in text


def test_names_that_mean_something_in_a_program_are_others_and_listed():
    conversion = converted("names")
    renamed = {p.facts["old"]: p.facts["new"] for p in conversion.problems if p.key == "convert-renamed"}
    assert renamed == {"lim": "lim_1", "TMAX": "TMAX_1", "v_": "v"}
    assert [p.line for p in conversion.problems if p.key == "convert-renamed"] == [2, 2, 4]
    run = desire_tui.load(conversion.text).run(record="v", check=True)
    assert run["v"][-1] == pytest.approx(exp(-2), rel=1e-6)
    assert run["dt"][-1] == pytest.approx(exp(-2) / 2, rel=1e-6)


def test_operators_bind_as_in_xppaut():
    """The right-hand column is what XPPAUT 6.11 printed for the file's auxiliary quantities."""
    printed = {
        "a1": -4, "a2": 64, "a3": 1, "a4": 2, "a5": -8, "a6": 6, "a7": 3, "a8": 0, "a9": 3, "b1": -1, "b2": 1,
        "b3": 2, "b4": 1, "b5": 9, "b6": -5, "b7": -2, "b8": 20, "b9": -0.27, "c1": 2.6931472, "c2": 5,
    }  # fmt: skip
    conversion = converted("precedence")
    run = desire_tui.load(conversion.text).run(record=tuple(printed), check=True)
    assert {name: run[name][0] for name in printed} == pytest.approx(printed, rel=1e-7)
    lines = {problem.line for problem in conversion.problems if "comparisons bind" in problem.message}
    assert lines == {10, 11, 12, 13, 15, 16, 24}


def test_noise_has_its_variance():
    """s²/2 = 0.125 for small steps; 2000 time units are about 1000 independent values."""
    run = desire_tui.load(converted("noise").text).run(record="x", check=True)
    assert np.var(run["x"][5000:]) == pytest.approx(0.125, abs=0.02)


def test_a_chain_is_open_for_its_share_of_the_time():
    """Rates 2 and 1: open for 2/3 of the time; the standard error over 2000 units is 0.0086."""
    assert final("channel", "x")[0] / 2000 == pytest.approx(2 / 3, abs=0.03)


@pytest.mark.parametrize(
    ("name", "right"),
    [
        ("including", exp(-2)), ("backward", exp(1)), ("start_flag", 9*exp(-1)),
        ("lowered_order", 2*exp(-1) + 1 - exp(-1)),
    ],
)  # fmt: skip
def test_other_forms_against_exact_solutions(name, right):
    assert final(name, "x") == pytest.approx([right], rel=1e-6)


def test_a_bound_ends_the_run():
    run = desire_tui.load(converted("growing").text).run(record="x")
    assert run.t[-1] == pytest.approx(log(5), abs=0.01)


def test_a_transient_is_not_shown():
    result = desire_tui.run(converted("transient").text)
    assert len(result.runs) == 2
    assert result.runs[-1].t[0] == pytest.approx(1)
    assert result.runs[-1]["x"] == pytest.approx(np.exp(-result.runs[-1].t), rel=1e-6)


def test_an_algebraic_equation_against_its_roots():
    from scipy.integrate import solve_ivp
    from scipy.optimize import brentq

    def unknown(x: float) -> float:
        return brentq(lambda y: y + y**3 + x, -10, 10, xtol=1e-14)

    right = solve_ivp(lambda _, x: [unknown(x[0])], (0, 5), [3.0], rtol=1e-10, atol=1e-12).y[0, -1]
    assert final("algebraic", "x", "y") == pytest.approx([right, unknown(right)], rel=1e-6)


def test_sums_over_arrays_are_xppauts():
    """The figures are what XPPAUT 6.11 printed."""
    printed = {
        "e0": 1804, "e1": 16852, "e2": 10021, "e3": 5170, "r0": 3784, "r1": 17842, "r2": 8437, "r3": 4378,
        "o0": 1684, "o1": 16842, "o2": 8421, "o3": 4210, "s0": 201, "s1": 34, "s2": 560, "m0": 321, "m1": 654,
        "x": 1804,
    }  # fmt: skip
    run = desire_tui.load(converted("networks").text).run(record=tuple(printed), check=True)
    assert {name: run[name][-1] for name in printed} == pytest.approx(printed)
