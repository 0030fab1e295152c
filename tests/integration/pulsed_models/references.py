"""The reference figures of the models in this folder, by scipy: `python -m tests.integration.pulsed_models.references`.

Equations typed from the papers once more, in Python: DOP853 with rtol 1e-12, begun anew at each edge of a pulse. Prints where
the states end and their largest magnitudes; with rtol 1e-11 and by Radau's method they are the same to ten digits. It takes half a
minute, so `test_pulsed_models` keeps the numbers.
"""

from __future__ import annotations

from itertools import pairwise
from math import log, pi, sin
from typing import TYPE_CHECKING

import numpy as np
from numpy import exp

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Derivatives = Callable[[float, Sequence[float], float], list[float]]


def hodgkin_huxley(t: float, x: Sequence[float], stimulus: float) -> list[float]:
    """Membrane potential in mV (rest -65), gates m, h, n; t in ms."""
    v, m, h, n = x
    sodium, potassium, leak = 120 * m**3 * h * (v - 50), 36 * n**4 * (v + 77), 0.3 * (v + 54.4)
    return [
        stimulus - sodium - potassium - leak,
        0.1 * (v + 40) / (1 - exp(-(v + 40) / 10)) * (1 - m) - 4 * exp(-(v + 65) / 18) * m,
        0.07 * exp(-(v + 65) / 20) * (1 - h) - h / (1 + exp(-(v + 35) / 10)),
        0.01 * (v + 55) / (1 - exp(-(v + 55) / 10)) * (1 - n) - 0.125 * exp(-(v + 65) / 80) * n,
    ]


def rate(v: float, c1: float, c2: float, c3: float, c4: float, c5: float, c6: float, c7: float) -> float:
    """Beeler and Reuter's common form of all rates (their table 1)."""
    return (c1 * exp(c2 * (v + c3)) + c4 * (v + c5)) / (exp(c6 * (v + c3)) + c7)


GATES = (
    ((0.0005, 0.083, 50, 0, 0, 0.057, 1), (0.0013, -0.06, 20, 0, 0, -0.04, 1)),
    ((0, 0, 47, -1, 47, -0.1, -1), (40, -0.056, 72, 0, 0, 0, 0)),
    ((0.126, -0.25, 77, 0, 0, 0, 0), (1.7, 0, 22.5, 0, 0, -0.082, 1)),
    ((0.055, -0.25, 78, 0, 0, -0.2, 1), (0.3, 0, 32, 0, 0, -0.1, 1)),
    ((0.095, -0.01, -5, 0, 0, -0.072, 1), (0.07, -0.017, 44, 0, 0, 0.05, 1)),
    ((0.012, -0.008, 28, 0, 0, 0.15, 1), (0.0065, -0.02, 30, 0, 0, -0.2, 1)),
)
"""x1, m, h, j, d, f: opening and closing rate."""


def beeler_reuter(t: float, x: Sequence[float], stimulus: float) -> list[float]:
    """Membrane potential in mV, calcium in mol/l, six gates; t in ms."""
    v, calcium, x1, m, h, j, d, f = x
    k1 = 4 * (exp(0.04 * (v + 85)) - 1) / (exp(0.08 * (v + 53)) + exp(0.04 * (v + 53)))
    k1 = 0.35 * (k1 + 0.2 * (v + 23) / (1 - exp(-0.04 * (v + 23))))
    outward = x1 * 0.8 * (exp(0.04 * (v + 77)) - 1) / exp(0.04 * (v + 35))
    sodium = (4 * m**3 * h * j + 0.003) * (v - 50)
    slow = 0.09 * d * f * (v + 82.3 + 13.0287 * log(calcium))
    gates = [rate(v, *up) * (1 - g) - rate(v, *down) * g for g, (up, down) in zip(x[2:], GATES, strict=True)]
    return [stimulus - k1 - outward - sodium - slow, -1e-7 * slow + 0.07 * (1e-7 - calcium), *gates]


def ring_modulator(t: float, x: Sequence[float], stimulus: float) -> list[float]:
    """Horneber's circuit: seven voltages, eight currents."""
    y = [0.0, *x]
    in1, in2 = 0.5 * sin(2000 * pi * t), 2 * sin(20000 * pi * t)
    q1, q2, q3, q4 = (
        40.67286402e-9 * (exp(17.7493332 * u) - 1)
        for u in (
            y[3] - y[5] - y[7] - in2,
            -y[4] + y[6] - y[7] - in2,
            y[4] + y[5] + y[7] + in2,
            -y[3] - y[6] + y[7] + in2,
        )
    )
    return [
        (y[8] - 0.5 * y[10] + 0.5 * y[11] + y[14] - y[1] / 25000) / 1.6e-8,
        (y[9] - 0.5 * y[12] + 0.5 * y[13] + y[15] - y[2] / 25000) / 1.6e-8,
        (y[10] - q1 + q4) / 2e-12,
        (-y[11] + q2 - q3) / 2e-12,
        (y[12] + q1 - q3) / 2e-12,
        (-y[13] - q2 + q4) / 2e-12,
        (-y[7] / 50 + q1 + q2 - q3 - q4) / 1e-8,
        -y[1] / 4.45,
        -y[2] / 4.45,
        (0.5 * y[1] - y[3] - 17.3 * y[10]) / 5e-4,
        (-0.5 * y[1] + y[4] - 17.3 * y[11]) / 5e-4,
        (0.5 * y[2] - y[5] - 17.3 * y[12]) / 5e-4,
        (-0.5 * y[2] + y[6] - 17.3 * y[13]) / 5e-4,
        (-y[1] + in1 - (50 + 36.3) * y[14]) / 0.002,
        (-y[2] - (600 + 36.3) * y[15]) / 0.002,
    ]


def pieces(edges: Sequence[float], height: float) -> list[tuple[float, float, float]]:
    """The intervals between edges, the stimulus on in every second one."""
    return [(a, b, height * (k % 2)) for k, (a, b) in enumerate(pairwise(edges))]


TRAIN = [0, 2, 2.5, 17, 17.5, 32, 32.5, 47, 47.5, 50]
MODELS: dict[str, tuple[Derivatives, list[float], list[tuple[float, float, float]]]] = {
    "hodgkin_huxley": (hodgkin_huxley, [-65, 0.0529, 0.5961, 0.3177], pieces(TRAIN, 20)),
    "beeler_reuter": (
        beeler_reuter,
        [-84.57, 1.7e-7, 0.0056, 0.011, 0.988, 0.975, 0.003, 0.994],
        pieces([0, 10, 11, 400], 50),
    ),
    "ring_modulator": (ring_modulator, [0.0] * 15, [(0, 1e-5, 0)]),
}


def solve(name: str, rtol: float, method: str = "DOP853") -> tuple[list[float], list[float]]:
    """The states at the end and their largest magnitudes."""
    from scipy.integrate import solve_ivp

    derivatives, start, intervals = MODELS[name]
    x = np.array(start, float)
    largest = abs(x)
    for begin, end, stimulus in intervals:
        found = solve_ivp(derivatives, (begin, end), x, method, rtol=rtol, atol=rtol * 1e-9, args=(stimulus,))
        assert found.success
        x, largest = found.y[:, -1], np.maximum(largest, abs(found.y).max(axis=1))
    return [float(f"{value:.12g}") for value in x], [float(f"{value:.4g}") for value in largest]


if __name__ == "__main__":
    for model in MODELS:
        ends, magnitudes = solve(model, 1e-12)
        print(model, ends, magnitudes, sep="\n    ")  # noqa: T201
