"""Speed of studies: 10,000 runs beside the same loop in C (gcc -O3 -march=native), one run after the other.

Goals: on one thread at most 0.25 times C's time where the machine has AVX-512, 0.4 with AVX2; 1.8 times
faster on two; 500 times faster than a Python loop over `desire_tui.run`; the first result after 0.5 s; a
million runs of two states within 500 MB. `exact` takes functions with the C library's bits (those of
single runs), `fast` the vector library's. Two threads make four times as many. `--quick` makes a tenth of the runs.
"""
# ruff: noqa: E501 - programs in C

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from dataclasses import dataclass

import numpy as np

import desire_tui
from benchmarks.yardstick import run_c

_NOISE = """
static unsigned long X;
static double u48(void) { X = (0x5DEECE66DUL*X + 11) & 0xFFFFFFFFFFFFUL; return X*0x1p-48; }
static double gauss(void) { double a = u48(), b = u48(); return sqrt(-2*log(a))*cos(6.283185307179586*b); }
"""
_HEUN = """
static inline __attribute__((always_inline)) void step(double *x, double t, double h) {
    double k1[N], y[N], k2[N];
    f(x, t, k1); for (int j = 0; j < N; j++) y[j] = x[j] + h*k1[j];
    f(y, t + h, k2); for (int j = 0; j < N; j++) x[j] += h/2*(k1[j] + k2[j]);
}
"""


@dataclass(frozen=True)
class Work:
    """A program, what varies from `low` to `high`, what is kept; a function `double run(double)` in C."""

    name: str
    program: str
    varied: str
    low: float
    high: float
    kept: str
    c: str
    is_noisy: bool = False


def pendulum() -> Work:
    return Work(
        "pendulum, sin, 1,000 steps",
        "kk = 16.1 | kd = 0.2 | theta = 1 | DT = 0.005 | TMAX = 5 | NN = 101\ndrun\nDYNAMIC\n"
        "d/dt theta = thdot\nd/dt thdot = -kk*sin(theta) - kd*thdot\ndispt theta\n",
        "kk",
        10,
        20,
        "theta[end]",
        "#define N 2\nstatic double kk, kd = 0.2;\n"
        "static inline void f(const double *x, double t, double *d) { d[0] = x[1]; d[1] = -kk*sin(x[0]) - kd*x[1]; }"
        + _HEUN
        + "static double run(double p) { kk = p; double x[N] = {1, 0};\n"
        "for (int i = 0; i < 1000; i++) step(x, 0.005*i, 0.005); return x[0]; }",
    )


def torpedo() -> Work:
    times = "19 20 25 26 32 33 34 40 41 42 47 48 49 55 56 57 63 64 65 71 72 73 74 75".split()  # noqa: SIM905
    angles = "0 .25 .25 0 0 -.25 0 0 .25 0 0 -.25 0 0 -.25 0 0 -.25 0 0 .25 0 0 -.125".split()  # noqa: SIM905
    return Work(
        "torpedo, table, sin, cos, 1,200 steps",
        "ARRAY time[24] + angle[24] = rudder\ndata "
        + ", ".join(times)
        + "\ndata "
        + ", ".join(angles)
        + "\nread rudder\nUC = 0.25 | X2 = 0.8155 | UT = X2*UC^2 | Y1 = -15.701 | Y2 = -0.23229 | Y3 = 2.0002\n"
        "N1 = -303.801 | N2 = -44.866 | N3 = -243.866 | x = -2.4 | y = 2.2 | TMAX = 48 | DT = 0.04 | NN = 241\n"
        "drun\nDYNAMIC\nr = func1(t; rudder)*u\nd/dt u = UT - X2*u^2\nd/dt v = u*(Y1*v + Y2*p + Y3*r)\n"
        "d/dt p = u*(N1*v + N2*p + N3*r)\nd/dt psi = p\nd/dt x = u*cos(psi) - v*sin(psi)\n"
        "d/dt y = u*sin(psi) + v*cos(psi)\ndispxy x, y\n",
        "UC",
        0.2,
        0.3,
        "x[end]",
        "#define N 6\nstatic double T[24] = {"
        + ", ".join(times)
        + "}, A[24] = {"
        + ", ".join(angles)
        + "}, UT;\n"
        "static double rudder(double t) { if (t <= T[0]) return A[0]; if (t >= T[23]) return A[23];\n"
        "int lo = 0, hi = 23; while (hi - lo > 1) { int m = (lo + hi)/2; if (t < T[m]) hi = m; else lo = m; }\n"
        "return A[lo] + (A[lo+1] - A[lo])*((t - T[lo])/(T[lo+1] - T[lo])); }\n"
        "static inline void f(const double *x, double t, double *d) { double u = x[0], v = x[1], p = x[2];\n"
        "double r = rudder(t)*u, s = sin(x[3]), c = cos(x[3]); d[0] = UT - 0.8155*u*u;\n"
        "d[1] = u*(-15.701*v - 0.23229*p + 2.0002*r); d[2] = u*(-303.801*v - 44.866*p - 243.866*r); d[3] = p;\n"
        "d[4] = u*c - v*s; d[5] = u*s + v*c; }"
        + _HEUN
        + "static double run(double p) { UT = 0.8155*p*p; double x[N] = {0, 0, 0, 0, -2.4, 2.2};\n"
        "for (int i = 0; i < 1200; i++) step(x, 0.04*i, 0.04); return x[4]; }",
    )


def servo() -> Work:
    return Work(
        "servo with noise, tanh, cos, gauss, 750 steps",
        "A = 0.05 | om = 1.2 | a = 200 | w = 100 | k = 40 | r = 2 | g1 = 10000 | B = 100 | g2 = 2 | R = 0.6\n"
        "noise = 0 | TMAX = 0.75 | DT = 0.001 | NN = 376 | SEED 1\ndrun\nDYNAMIC\nu = A*cos(om*t)\n"
        "d/dt p = -w*p + noise\nd/dt q = -w*q + p\nd/dt V = -B*V + g1*(-k*(x - u) - r*xdot + q)\n"
        "d/dt x = xdot\nd/dt xdot = tanh(g2*V) - R*xdot\nOUT\nnoise = a*gauss(0)\ndispt x\n",
        "k",
        30,
        50,
        "x[end]",
        "#define N 5\n" + _NOISE + "static double k, noise;\n"
        "static inline void f(const double *x, double t, double *d) { double u = 0.05*cos(1.2*t);\n"
        "d[0] = -100*x[0] + noise; d[1] = -100*x[1] + x[0];\n"
        "d[2] = -100*x[2] + 10000*(-k*(x[3] - u) - 2*x[4] + x[1]); d[3] = x[4]; d[4] = tanh(2*x[2]) - 0.6*x[4]; }"
        + _HEUN
        + "static double run(double p) { k = p; X = 80910; noise = 0; double x[N] = {0};\n"
        "for (int i = 0; i < 750; i++) { if (i % 2 == 0) noise = 200*gauss(); step(x, 0.001*i, 0.001); }\n"
        "return x[3]; }",
        is_noisy=True,
    )


def six_states() -> Work:
    return Work(
        "6 states, sin, cos, sqrt, 1,000 steps",
        "u = 1 | p = 1 | c0 = 0.1 | TMAX = 1 | DT = 0.001 | NN = 101\ndrun\nDYNAMIC\ns = sin(p)\nc = cos(p)\n"
        "r = sqrt(u*u + w*w)\nd/dt x = u*c - w*s\nd/dt y = u*s + w*c\nd/dt u = -c0*u*r\n"
        "d/dt w = -c0*w*r + 0.3*q\nd/dt p = q\nd/dt q = -p - 0.2*q*u\ndispt x\n",
        "c0",
        0.05,
        0.2,
        "x[end]",
        "#define N 6\nstatic double c0;\nstatic inline void f(const double *x, double t, double *d) {\n"
        "double u = x[2], w = x[3], p = x[4], q = x[5], s = sin(p), c = cos(p), r = sqrt(u*u + w*w);\n"
        "d[0] = u*c - w*s; d[1] = u*s + w*c; d[2] = -c0*u*r; d[3] = -c0*w*r + 0.3*q; d[4] = q; d[5] = -p - 0.2*q*u; }"
        + _HEUN
        + "static double run(double p) { c0 = p; double x[N] = {0, 0, 1, 0, 1, 0};\n"
        "for (int i = 0; i < 1000; i++) step(x, 0.001*i, 0.001); return x[0]; }",
    )


def lorenz() -> Work:
    return Work(
        "Lorenz, nothing but arithmetic, 1,000 steps",
        "a = 10 | b = 8/3 | r = 28 | x = 1 | y = 1 | z = 1 | TMAX = 1 | DT = 0.001 | NN = 101\ndrun\nDYNAMIC\n"
        "d/dt x = a*(y - x)\nd/dt y = x*(r - z) - y\nd/dt z = x*y - b*z\ndispt x\n",
        "r",
        20,
        30,
        "z[end]",
        "#define N 3\nstatic double r;\nstatic inline void f(const double *x, double t, double *d) {\n"
        "d[0] = 10*(x[1] - x[0]); d[1] = x[0]*(r - x[2]) - x[1]; d[2] = x[0]*x[1] - 8./3*x[2]; }"
        + _HEUN
        + "static double run(double p) { r = p; double x[N] = {1, 1, 1};\n"
        "for (int i = 0; i < 1000; i++) step(x, 0.001*i, 0.001); return x[2]; }",
    )


def seconds(work: Work, values: np.ndarray, *, fast: bool) -> tuple[float, np.ndarray]:
    """Return the least of three times, the first left out, and what came out.

    They are the processor's times, which other programs on the machine do not lengthen.
    """
    times = []
    for _ in range(4):
        began = time.process_time()
        found = desire_tui.study(
            work.program, over={work.varied: values}, keep=work.kept, fast=fast, threads=1
        )
        times.append(time.process_time() - began)
    return min(times[1:]), found[work.kept].values


def gain_of_two_threads(work: Work, values: np.ndarray) -> float:
    """Return how many times faster two threads are than one, by the clock on the wall for both."""
    times: dict[int, list[float]] = {1: [], 2: []}
    while len(times[2]) < 4 or sum(times[1]) < 1.0:  # in turn: what else the machine does, it does to both
        for threads, taken in times.items():
            began = time.perf_counter()
            desire_tui.study(work.program, over={work.varied: values}, keep=work.kept, threads=threads)
            taken.append(time.perf_counter() - began)
    return min(times[1]) / min(times[2])


def python_loop(work: Work, values: np.ndarray, runs: int = 60) -> float:
    """Return the seconds that a loop over `desire_tui.run` would take for all values."""
    desire_tui.run(work.program)
    began = time.process_time()
    for value in values[:runs].tolist():
        desire_tui.run(work.program, set={work.varied: value})
    return (time.process_time() - began) / runs * len(values)


def first_result() -> float:
    """Return the seconds from calling a study in a fresh process to its first result, imports included."""
    code = (
        "import time; began = time.perf_counter()\nimport desire_tui\n"
        f"program = {pendulum().program!r}\n"
        "class Seen(Exception): pass\ndef seen(_):\n    raise Seen\n"
        "try:\n    desire_tui.study(program, over={'kk': '10:20:10000'}, keep='theta[end]', progress=seen)\n"
        "except Seen:\n    print(time.perf_counter() - began)\n"
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        for _ in range(3)
    ]
    return min(float(run.stdout) for run in runs)


def a_million(runs: int) -> tuple[float, float]:
    """Return seconds and the process's largest memory, MB, of so many runs of two states with one number kept."""
    code = (
        "import desire_tui, resource, time\n"
        "program = 'k = 1 | r = 0.1 | x = 1 | DT = 0.02 | TMAX = 2 | NN = 21\\ndrun\\nDYNAMIC\\n"
        "d/dt x = v\\nd/dt v = -k*x - r*v\\ndispt x\\n'\n"
        "began = time.perf_counter()\n"
        f"desire_tui.study(program, sample={{'k': 'normal(4,0.5)'}}, runs={runs}, keep='x[end]')\n"
        "print(time.perf_counter() - began, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss/1024)\n"
    )
    words = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    return float(words[0]), float(words[1])


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    runs = 1_000 if parser.parse_args().quick else 10_000
    print(f"{runs} runs; seconds; times as parts of C's")
    print(
        f"{'work':46} {'C':>8} {'exact':>8} {'/C':>5} {'fast':>8} {'/C':>5} {'two threads':>12} {'run() loop':>11}  same"
    )
    for work in (torpedo(), pendulum(), servo(), six_states(), lorenz()):
        values = np.linspace(work.low, work.high, runs)
        loop = f"double s = 0; for (int i = 0; i < {runs}; i++) s += run({work.low:f} + {work.high - work.low:f}*i/{runs - 1});"
        c, wanted = run_c(work.c, "", loop, "s", repeats=3, cpu=True)
        exact, found = seconds(work, values, fast=False)
        fast, near = seconds(work, values, fast=True)
        gain = gain_of_two_threads(work, np.linspace(work.low, work.high, 4 * runs))
        slow = python_loop(work, values)
        tolerance = 1e-2 if work.is_noisy else 1e-9  # each run has noise of its own here
        same = abs(found.sum() - wanted) <= tolerance * abs(wanted) and np.allclose(
            found, near, rtol=1e-6, atol=1e-9
        )
        print(
            f"{work.name:46} {c:8.3f} {exact:8.3f} {exact / c:5.2f} {fast:8.3f} {fast / c:5.2f} "
            f"{gain:9.2f} ×  {slow / exact:9.0f} ×  {'yes' if same else f'NO {found.sum()} {wanted}'}",
            flush=True,
        )
    print(f"first result of a fresh process after {first_result():.2f} s")
    count = 100_000 if runs < 10_000 else 1_000_000
    took, megabytes = a_million(count)
    print(f"{count} runs of 2 states, 100 steps: {took:.1f} s, {megabytes:.0f} MB")


if __name__ == "__main__":
    main()
