"""Smooth problems, each written once and put into four languages: Desire, C, Python, heyoka's expressions.

Lorenz' equations to t = 20; Arenstorf's orbit, one period; seven stars (Pleiades) to t = 3; Kepler's orbit of
eccentricity 0.9, three turns; the Brusselator with diffusion along a line. Hairer, Nørsett and Wanner,
"Solving Ordinary Differential Equations" I: II.10, II: IV.10. The outer solar system: Hairer, Lubich, Wanner,
"Geometric Numerical Integration", I.2.4.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property
from math import pi, sin, sqrt
from typing import Any

import numpy as np


@dataclass(frozen=True)
class SmoothProblem:
    """Derivatives by state, behind auxiliary variables in their order, in Desire's notation.

    Powers are `^2` and `^(-1.5)` of a name. `arrays`: Desire's text in place of one made of `rates`.
    """

    name: str
    t_end: float
    start: dict[str, float]
    rates: dict[str, str]
    helpers: dict[str, str] = field(default_factory=dict)
    arrays: tuple[str, str] = ("", "")
    """Script and segment over arrays."""

    @cached_property
    def desire(self) -> tuple[str, str]:
        """Script lines that set the states, and the DYNAMIC segment."""
        if self.arrays[0]:
            return self.arrays
        script = "\n".join(f"{name} = {value!r}" for name, value in self.start.items())
        lines = [f"{name} = {text}" for name, text in self.helpers.items()]
        lines += [f"d/dt {name} = {text}" for name, text in self.rates.items()]
        return script, "\n".join([*lines, f"dispt {next(iter(self.start))}"])

    @cached_property
    def c(self) -> str:
        """Statements that compute `rate[…]` from `state[…]`."""
        names = list(self.start)
        lines = [f"double {name} = state[{i}];" for i, name in enumerate(names)]
        lines += [f"double {name} = {_c(text)};" for name, text in self.helpers.items()]
        lines += [f"rate[{i}] = {_c(self.rates[name])};" for i, name in enumerate(names)]
        return " ".join(lines)

    @cached_property
    def function(self) -> Any:
        """f(t, y) → list."""
        lines = [f"def f(t, y):\n    {', '.join(self.start)} = y"]
        lines += [f"    {name} = {_python(text)}" for name, text in self.helpers.items()]
        lines.append(f"    return [{', '.join(_python(self.rates[name]) for name in self.start)}]")
        space: dict[str, Any] = {}
        exec("\n".join(lines), space)
        return space["f"]

    def heyoka(self, heyoka: Any) -> list[tuple[Any, Any]]:
        """Equations as heyoka takes them."""
        space = {name: heyoka.make_vars(name) for name in self.start}
        for name, text in self.helpers.items():
            space[name] = eval(_python(text), {}, space)
        rates = {name: eval(_python(text), {}, space) for name, text in self.rates.items()}
        return [(space[name], rates[name] + 0.0 * space[name]) for name in self.start]  # never a mere number

    @property
    def begin(self) -> np.ndarray:
        """States at t = 0."""
        return np.array(list(self.start.values()))


def _c(text: str) -> str:
    text = re.sub(r"(\w+|\([^()]*\))\^\(-1\.5\)", r"(1/(\1*sqrt(\1)))", text)
    return re.sub(r"(\w+|\([^()]*\))\^2", r"(\1*\1)", text)


def _python(text: str) -> str:
    return text.replace("^", "**")


LORENZ = SmoothProblem(
    "Lorenz to t = 20", 20.0, {"x": 1.0, "y": 1.0, "z": 1.0},
    {"x": "10*(y - x)", "y": "x*(28 - z) - y", "z": "x*y - 2.6666666666666665*z"},
)  # fmt: skip
_MU = 0.012277471
ARENSTORF = SmoothProblem(
    "Arenstorf's orbit", 17.0652165601579625588917206249,
    {"x": 0.994, "y": 0.0, "u": 0.0, "v": -2.00158510637908252240537862224},
    {"x": "u", "y": "v", "u": f"x + 2*v - {1 - _MU!r}*(x + {_MU!r})*a - {_MU!r}*(x - {1 - _MU!r})*b",
     "v": f"y - 2*u - {1 - _MU!r}*y*a - {_MU!r}*y*b"},
    {"p": f"(x + {_MU!r})^2 + y^2", "q": f"(x - {1 - _MU!r})^2 + y^2", "a": "p^(-1.5)", "b": "q^(-1.5)"},
)  # fmt: skip
KEPLER = SmoothProblem(
    "Kepler, e = 0.9, three turns", 6 * pi, {"x": 0.1, "y": 0.0, "u": 0.0, "v": sqrt(19)},
    {"x": "u", "y": "v", "u": "-x*w", "v": "-y*w"}, {"r": "x^2 + y^2", "w": "r^(-1.5)"},
)  # fmt: skip


def _pleiades() -> SmoothProblem:
    places = {"x": (3, 3, -1, -3, 2, -2, 2), "y": (3, -3, 2, 0, 0, -4, 4),
              "u": (0, 0, 0, 0, 0, 1.75, -1.5), "v": (0, 0, 0, -1.25, 1, 0, 0)}  # fmt: skip
    stars = range(1, 8)
    helpers, forces = {}, {i: ([], []) for i in stars}
    for i in stars:
        for j in range(i + 1, 8):
            dx, dy, r, w = (f"{name}{i}{j}" for name in ("dx", "dy", "r", "w"))
            helpers |= {dx: f"x{j} - x{i}", dy: f"y{j} - y{i}", r: f"{dx}^2 + {dy}^2", w: f"{r}^(-1.5)"}
            helpers |= {f"fx{i}{j}": f"{dx}*{w}", f"fy{i}{j}": f"{dy}*{w}"}
            for axis, letter in enumerate("xy"):
                forces[i][axis].append(f"+ {j}*f{letter}{i}{j}")
                forces[j][axis].append(f"- {i}*f{letter}{i}{j}")
    rates = {f"x{i}": f"u{i}" for i in stars} | {f"y{i}": f"v{i}" for i in stars}
    rates |= {f"u{i}": "0 " + " ".join(forces[i][0]) for i in stars}
    rates |= {f"v{i}": "0 " + " ".join(forces[i][1]) for i in stars}
    start = {f"{name}{i}": float(places[name][i - 1]) for name in "xyuv" for i in stars}
    return SmoothProblem("Pleiades to t = 3", 3.0, start, rates, helpers)


def _brusselator(n: int = 64, rate: float = 0.02) -> SmoothProblem:
    factor = rate * (n + 1) ** 2
    start = {f"u{i}": 1 + sin(2 * pi * i / (n + 1)) for i in range(1, n + 1)}
    start |= {f"v{i}": 3.0 for i in range(1, n + 1)}
    rates, helpers = {}, {}
    for i in range(1, n + 1):
        below, above = (f"u{i - 1}" if i > 1 else "1"), (f"u{i + 1}" if i < n else "1")
        helpers[f"p{i}"] = f"u{i}*u{i}*v{i}"
        rates[f"u{i}"] = f"1 + p{i} - 4*u{i} + {factor!r}*({below} - 2*u{i} + {above})"
    for i in range(1, n + 1):
        below, above = (f"v{i - 1}" if i > 1 else "3"), (f"v{i + 1}" if i < n else "3")
        rates[f"v{i}"] = f"3*u{i} - p{i} + {factor!r}*({below} - 2*v{i} + {above})"
    script = (
        f"n = {n} | STATE u[n], v[n] | ARRAY e[n], p[n]\n"
        "for i = 1 to n | u[i] = 1 + sin(2*PI*i/(n + 1)) | v[i] = 3 | next\n"
        f"e[1] = 1 | e[n] = 1 | c = {rate!r}*(n + 1)^2"
    )
    body = (
        "Vector p = u*u*v\nVectr d/dt u = 1 + p - 4*u + c*(u{1} - 2*u + u{-1} + e)\n"
        "Vectr d/dt v = 3*u - p + c*(v{1} - 2*v + v{-1} + 3*e)\ndispt u[1]"
    )
    return SmoothProblem("Brusselator, 128 states, to t = 10", 10.0, start, rates, helpers, (script, body))


GRAVITY = 2.95912208286e-4
"""In astronomical units, days and masses of the Sun; hers holds the inner planets' too."""
MASSES = (
    1.00000597682,
    0.000954786104043,
    0.000285583733151,
    0.0000437273164546,
    0.0000517759138449,
    1 / 1.3e8,
)
_PLACES = (
    (0.0, 0.0, 0.0), (-3.5023653, -3.8169847, -1.5507963), (9.0755314, -3.0458353, -1.6483708),
    (8.3101420, -16.2901086, -7.2521278), (11.4707666, -25.7294829, -10.8169456),
    (-15.5387357, -25.2225594, -3.1902382),
)  # fmt: skip
_SPEEDS = (
    (0.0, 0.0, 0.0), (0.00565429, -0.00412490, -0.00190589), (0.00168318, 0.00483525, 0.00192462),
    (0.00354178, 0.00137102, 0.00055029), (0.00288930, 0.00114527, 0.00039677),
    (0.00276725, -0.00170702, -0.00136504),
)  # fmt: skip
YEAR = 365.25


def outer_planets(years: float) -> SmoothProblem:
    """Sun, Jupiter, Saturn, Uranus, Neptune, Pluto; places and speeds from their centre of mass.

    Relative to the Sun at the start, as the tables have them, all six would have drifted 200 units away
    behind 100,000 years, and distances be differences of large numbers: errors would grow with t^1.5.
    """
    bodies = range(6)
    places, speeds = _from_centre(_PLACES), _from_centre(_SPEEDS)
    forces: dict[tuple[str, int], list[str]] = {(axis, i): [] for axis in "xyz" for i in bodies}
    helpers: dict[str, str] = {}
    for i in bodies:
        for j in range(i + 1, 6):
            helpers |= {f"d{axis}{i}{j}": f"{axis}{j} - {axis}{i}" for axis in "xyz"}
            helpers[f"r{i}{j}"] = " + ".join(f"d{axis}{i}{j}^2" for axis in "xyz")
            helpers[f"w{i}{j}"] = f"r{i}{j}^(-1.5)"
            for axis in "xyz":
                helpers[f"f{axis}{i}{j}"] = f"d{axis}{i}{j}*w{i}{j}"
                forces[axis, i].append(f"+ {GRAVITY * MASSES[j]!r}*f{axis}{i}{j}")
                forces[axis, j].append(f"- {GRAVITY * MASSES[i]!r}*f{axis}{i}{j}")
    start = {f"{axis}{i}": places[i][k] for k, axis in enumerate("xyz") for i in bodies}
    start |= {f"v{axis}{i}": speeds[i][k] for k, axis in enumerate("xyz") for i in bodies}
    rates = {f"{axis}{i}": f"v{axis}{i}" for axis in "xyz" for i in bodies}
    rates |= {f"v{axis}{i}": "0 " + " ".join(forces[axis, i]) for axis in "xyz" for i in bodies}
    return SmoothProblem(f"outer solar system, {years:g} years", years * YEAR, start, rates, helpers)


def _from_centre(table: tuple[tuple[float, ...], ...]) -> list[list[float]]:
    """Return vectors of the six bodies less that of their centre of mass."""
    vectors, masses = np.array(table), np.array(MASSES)
    return (vectors - masses @ vectors / masses.sum()).tolist()


def energy(states: np.ndarray) -> np.longdouble:
    """Return the energy of `outer_planets`' states, in their order, with 64 bits of mantissa."""
    places, speeds = np.array(states, dtype=np.longdouble).reshape(2, 3, 6)
    masses = np.array(MASSES, dtype=np.longdouble)
    total = 0.5 * (masses * (speeds**2).sum(axis=0)).sum()
    for i in range(6):
        for j in range(i + 1, 6):
            distance = np.sqrt(((places[:, i] - places[:, j]) ** 2).sum())
            total -= np.longdouble(GRAVITY) * masses[i] * masses[j] / distance
    return total


PROBLEMS = (LORENZ, ARENSTORF, _pleiades(), KEPLER, _brusselator())
