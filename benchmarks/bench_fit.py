"""Speed of a fit: three parameters of a model of six states to 1,000 points, beside scipy.

scipy: `least_squares` from the same start over `solve_ivp` with its usual method (RK45) at about the accuracy
that the fit has (printed), and with LSODA, whose loop is compiled too. Goal: at least 50 times faster than
the first. The model is compiled before; the first fit compiles the segment with its derivatives.
"""

from __future__ import annotations

import time
from math import sin
from statistics import median

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from desire_tui.analysis.fit.analysis import fit
from desire_tui.analysis.fit.request import read_request
from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.subject import Subject
from desire_tui.engine.data_files.data_file import DataFile
from desire_tui.engine.source import Source

GOAL = 50.0
TRUE = {"k": 4.0, "w": 1.0, "d": 0.05}
START = {"k": 3.9, "w": 0.9, "d": 0.07}
PROGRAM = """k = 3.9 | w = 0.9 | d = 0.07 | a = 1 | irule 3
TMAX = 50 | DT = 0.02 | NN = 1001
drun
DYNAMIC
d/dt a = u
d/dt b = v
d/dt c = q
d/dt u = -k*sin(a) - d*u + w*(b - a)
d/dt v = -k*sin(b) - d*v + w*(a - 2*b + c)
d/dt q = -k*sin(c) - d*q + w*(b - c)
dispt b
"""
"""Three pendulums joined by springs."""


def slope(_t, x, k, w, d):
    a, b, c, u, v, q = x
    return [
        u, v, q, -k * sin(a) - d * u + w * (b - a), -k * sin(b) - d * v + w * (a - 2 * b + c),
        -k * sin(c) - d * q + w * (b - c),
    ]  # fmt: skip


def solution(t, parameters, method="RK45", tolerance=1e-7):
    made = solve_ivp(
        slope,
        (0, 50),
        [1, 0, 0, 0, 0, 0],
        method,
        t,
        args=tuple(parameters),
        rtol=tolerance,
        atol=tolerance,
    )
    return made.y[1]


def timed(work, times):
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        found = work()
        taken.append(time.perf_counter() - began)
    return median(taken), found


def main():
    t = np.linspace(0.05, 50, 1000)
    data = solution(t, TRUE.values(), "LSODA", 1e-11) + 0.05 * np.random.default_rng(1).normal(size=1000)
    file = DataFile("made.csv", {"t": t, "b": data})
    subject = Subject(Source(PROGRAM, "bench.src"))
    subject.model  # noqa: B018 - compiled here
    asked = read_request("k, w, d to b")

    def ours():
        return fit(subject, asked, [file], unwatched)

    def theirs(method):
        first = list(START.values())
        return least_squares(lambda p: solution(t, p, method) - data, first, x_scale=first)

    cold, _ = timed(ours, 1)
    time.sleep(2)  # fast code is compiled behind the first fit
    own, found = timed(ours, 15)
    print(f"  ours  {own * 1e3:8.1f} ms, {found['runs']} runs; the first one {cold * 1e3:.1f} ms")
    curve = subject.model.sensitive_runs(["k"], ["b"])({name: found[name] for name in TRUE})
    exact = solution(curve.t, [found[name] for name in TRUE], tolerance=1e-11)
    errors = {"ours": np.abs(exact - curve.values[0]).max()}
    for method in ("RK45", "LSODA"):
        scipy, other = timed(lambda method=method: theirs(method), 2)
        errors[method] = np.abs(solution(t, other.x, method) - solution(t, other.x, tolerance=1e-11)).max()
        print(f"  scipy {scipy * 1e3:8.1f} ms, {method}, {other.nfev} steps of the search")
        goal = f" (goal {GOAL:.0f})" if method == "RK45" else ""
        print(f"        {scipy / own:.0f} times faster{goal}, the first fit {scipy / cold:.1f} times")
        apart = max(
            abs(found[name] - value) / found["errors"][name]
            for name, value in zip(TRUE, other.x, strict=True)
        )
        print(f"        estimates differ by {apart:.1e} standard errors")
    print(
        "  largest error of a curve of the size of 1:",
        ", ".join(f"{name} {size:.1e}" for name, size in errors.items()),
    )


if __name__ == "__main__":
    main()
