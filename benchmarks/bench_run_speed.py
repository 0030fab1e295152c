"""Speed of runs beside C (gcc -O3 -march=native, loops as one would write them by hand).

Goals (performance.md 2): Lorenz and the ladder ≤ 1.1 times C, Monte Carlo ≤ 0.25 times with AVX-512 (0.4
with AVX2); one million states within the memory of 20 such arrays. Runs are measured once fast code is in;
the first run, with everything that comes before it, stands beside.
"""

from __future__ import annotations

import resource
import time
from dataclasses import dataclass, replace
from statistics import median

from benchmarks.yardstick import run_c
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

_RK4 = """
#define LOOP for (int j = 0; j < N; j++)
static double x[N], y[N], k1[N], k2[N], k3[N], k4[N];
static void step(double h) {
    f(x, k1); LOOP y[j] = x[j] + 0.5*h*k1[j];
    f(y, k2); LOOP y[j] = x[j] + 0.5*h*k2[j];
    f(y, k3); LOOP y[j] = x[j] + h*k3[j];
    f(y, k4); LOOP x[j] += h/6*(k1[j] + 2*k2[j] + 2*k3[j] + k4[j]);
}
"""
_RK2 = """
#define LOOP for (int j = 0; j < N; j++)
static double x[N], y[N], k1[N], k2[N];
static void step(double h) {
    f(x, k1); LOOP y[j] = x[j] + h*k1[j];
    f(y, k2); LOOP x[j] += 0.5*h*(k1[j] + k2[j]);
}
"""


@dataclass(frozen=True)
class Work:
    """A program, the same in C, and the name of the variable that both end with."""

    name: str
    program: str
    declarations: str
    before: str
    work: str
    result: str
    variable: str
    goal: float
    tolerance: float = 1e-9


def lorenz() -> Work:
    steps = 10_000_000
    return Work(
        "Lorenz, RK4, 1e7 steps",
        "a = 10 | b = 8/3 | r = 28 | irule 3\nx = 1 | y = 1 | z = 1 | t = 0\n"
        f"TMAX = {steps * 1e-4:g} | DT = 0.0001 | NN = 251\ndrun\nDYNAMIC\n"
        "d/dt x = a*(y - x)\nd/dt y = x*(r - z) - y\nd/dt z = x*y - b*z\ndispt x, y, z\n",
        "#define N 3\nstatic double a = 10, b = 8./3, r = 28;\n"
        "static inline void f(const double *x, double *d) {"
        "d[0] = a*(x[1] - x[0]); d[1] = x[0]*(r - x[2]) - x[1]; d[2] = x[0]*x[1] - b*x[2]; }" + _RK4,
        "x[0] = x[1] = x[2] = 1;",
        f"for (long i = 0; i < {steps}; i++) step(0.0001);",
        "x[2]*0 + 1",  # chaos: rounding alone makes the ends differ
        "",
        1.1,
    )


def lorenz_fast() -> Work:
    """The same, arithmetic free to be rearranged, as gcc has it by -march=native."""
    strict = lorenz()
    program = strict.program.replace("DYNAMIC\n", "DYNAMIC\nfast\n")
    return replace(strict, name=f"{strict.name}, fast", program=program, goal=1.0)


def ladder() -> Work:
    n, steps = 700, 2000
    lines = ["d/dt i0 = b*(1 - v1 - i0)"]
    for k in range(1, n + 1):
        lines.append(f"d/dt v{k} = a*(i{k - 1} - i{k})")
        lines.append(f"d/dt i{k} = b*(v{k} - v{k + 1})" if k < n else f"d/dt i{k} = b*(v{k} - i{k})")
    return Work(
        "LC ladder, 1401 scalar equations, RK4, 2000 steps",
        f"a = 1000 | b = 1000 | irule 3 | TMAX = {steps * 1e-4} | DT = 0.0001 | NN = 3\ndrun\nDYNAMIC\n"
        + "\n".join(lines) + "\ndispt v1\n",
        f"#define M {n}\n#define N (2*M + 1)\nstatic double a = 1000, b = 1000;\n"
        "static void f(const double *restrict x, double *restrict d) {\n"
        "    const double *i = x, *v = x + M; double *di = d, *dv = d + M;\n"
        "    di[0] = b*(1 - v[1] - i[0]);\n"
        "    for (int k = 1; k <= M; k++) dv[k] = a*(i[k-1] - i[k]);\n"
        "    for (int k = 1; k < M; k++) di[k] = b*(v[k] - v[k+1]);\n"
        "    di[M] = b*(v[M] - i[M]);\n}" + _RK4,
        "memset(x, 0, sizeof x);",
        f"for (int i = 0; i < {steps}; i++) step(0.0001);",
        "x[M + 1]",
        "v1",
        1.1,
    )  # fmt: skip


def monte_carlo() -> Work:
    n, steps = 5000, 1000
    return Work(
        "5,000 replicas of 6 states with sin, cos, sqrt; RK2, 1000 steps",
        f"n = {n} | irule 1\nSTATE x[n], y[n], u[n], w[n], p[n], q[n]\nARRAY s[n], c[n], r[n]\n"
        "for k = 1 to n | p[k] = 1 + 0.0001*k | u[k] = 1 | next\n"
        f"t = 0 | TMAX = {steps * 1e-3} | DT = 0.001 | NN = 2\ndrun\nDYNAMIC\n"
        "Vector s = sin(p)\nVector c = cos(p)\nVector r = sqrt(u*u + w*w)\n"
        "Vectr d/dt x = u*c - w*s\nVectr d/dt y = u*s + w*c\n"
        "Vectr d/dt u = -0.1*u*r\nVectr d/dt w = -0.1*w*r + 0.3*q\nVectr d/dt p = q\n"
        "Vectr d/dt q = -p - 0.2*q*u\nx1 = x[1]\ndispt x1\n",
        f"#define R {n}\n#define N (6*R)\nstatic void f(const double *restrict X, double *restrict D) {{\n"
        "    for (int i = 0; i < R; i++) {\n"
        "        double u = X[2*R+i], w = X[3*R+i], p = X[4*R+i], q = X[5*R+i];\n"
        "        double s = sin(p), c = cos(p), r = sqrt(u*u + w*w);\n"
        "        D[i] = u*c - w*s; D[R+i] = u*s + w*c; D[2*R+i] = -0.1*u*r; D[3*R+i] = -0.1*w*r + 0.3*q;\n"
        "        D[4*R+i] = q; D[5*R+i] = -p - 0.2*q*u;\n    }\n}" + _RK2,
        "memset(x, 0, sizeof x); for (int i = 0; i < R; i++) { x[2*R+i] = 1; x[4*R+i] = 1 + 0.0001*(i+1); }",
        f"for (int i = 0; i < {steps}; i++) step(0.001);",
        "x[0]",
        "x1",
        0.25,
    )


def layer() -> Work:
    n, steps = 200, 500
    return Work(
        "200 x 200 recurrent layer tanh(W*x), RK4, 500 steps",
        f"n = {n} | irule 3\nSTATE x[n] | ARRAY W[n,n]\n"
        "for i = 1 to n | x[i] = 0.01*i - 1 | for k = 1 to n | W[i,k] = sin(i*k)/n | next | next\n"
        f"t = 0 | TMAX = {steps * 1e-2} | DT = 0.01 | NN = 2\ndrun\nDYNAMIC\n"
        "Vectr d/dt x = tanh(W*x) - 0.1*x\nx1 = x[1]\ndispt x1\n",
        f"#define N {n}\nstatic double W[N][N];\n"
        "static void f(const double *restrict x, double *restrict d) {\n"
        "    for (int i = 0; i < N; i++) { double s = 0; for (int k = 0; k < N; k++) s += W[i][k]*x[k];\n"
        "        d[i] = tanh(s) - 0.1*x[i]; }\n}" + _RK4,
        "for (int i = 0; i < N; i++) { x[i] = 0.01*(i+1) - 1;"
        " for (int k = 0; k < N; k++) W[i][k] = sin((i+1.)*(k+1.))/N; }",
        f"for (int i = 0; i < {steps}; i++) step(0.01);",
        "x[0]",
        "x1",
        1.0,
    )


def heat() -> Work:
    n, steps = 1_000_000, 10
    return Work(
        "heat equation, 1,000,000 states, RK4, 10 steps",
        f"n = {n} | irule 3\nSTATE u[n]\nu[500000] = 1\n"
        f"t = 0 | TMAX = {steps * 0.25} | DT = 0.25 | NN = 2\ndrun\nDYNAMIC\n"
        "Vectr d/dt u = u{1} - 2*u + u{-1}\nmiddle = u[500000]\ndispt middle\n",
        f"#define N {n}\nstatic void f(const double *restrict x, double *restrict d) {{\n"
        "    d[0] = x[1] - 2*x[0]; d[N-1] = -2*x[N-1] + x[N-2];\n"
        "    for (int i = 1; i < N-1; i++) d[i] = x[i+1] - 2*x[i] + x[i-1];\n}" + _RK4,
        "memset(x, 0, sizeof x); x[499999] = 1;",
        f"for (int i = 0; i < {steps}; i++) step(0.25);",
        "x[499999]",
        "middle",
        1.1,
    )


def measure(work: Work) -> tuple[float, float, float, float]:
    """Return seconds of the first run, median of later ones, megabytes more, the variable at the end."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    session = Session()
    session.erun(Source(work.program, work.name))
    first = session.runs[-1].seconds
    quantity = session.values.find(work.variable) if work.variable else None
    found = session.values.cells[quantity.slot] if quantity is not None else 1.0
    more = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    for _ in range(4):  # the fast code of a thousand equations takes a second or two
        session.execute("drunr")
        time.sleep(0.8)
    times = []
    for _ in range(5):
        session.execute("drunr")
        times.append(session.runs[-1].seconds)
    return first, median(times), more, found


def main() -> None:
    heads = f"{'C s':>9} {'ours s':>9} {'ratio':>6} {'goal':>5} {'first s':>8} {'MB':>6}  same result"
    print(f"{'work':64} {heads}")
    for work in (lorenz(), lorenz_fast(), ladder(), monte_carlo(), layer(), heat()):
        c, wanted = run_c(work.declarations, work.before, work.work, work.result)
        first, ours, more, found = measure(work)
        same = abs(found - wanted) <= work.tolerance * max(abs(wanted), 1e-300)
        print(
            f"{work.name:64} {c:9.4f} {ours:9.4f} {ours / c:6.2f} {work.goal:5.2f} {first:8.3f} {more:6.0f}  "
            f"{'yes' if same else f'NO: {found} {wanted}'}",
            flush=True,
        )


if __name__ == "__main__":
    main()
