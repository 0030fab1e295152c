"""Large models on one thread and on all cores, turn and turn about, beside a loop in C with OpenMP.

Goal (performance.md 2): one million states on two threads ≥ 1.8 times as fast as on one, with the same bits.
The loop in C shows what the memory gives: it is what stops such models. Another program on the machine takes
a core away: `nice -n -20` as root keeps the others off.
"""

from __future__ import annotations

import time
from hashlib import blake2b

from benchmarks.yardstick import run_c
from desire_tui.engine.codegen.threads.pool import thread_pool
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.thread_count import cores

ROUNDS = 15
_RUN = "t = 0 | TMAX = {steps}*DT | NN = 2\ndrun\nDYNAMIC\n"
PROGRAMS = {
    "heat equation, 1,000,000 states, rule 3": (
        "n = 1000000 | irule 3 | DT = 0.25\nSTATE u[n]\nu[n/2] = 1\n" + _RUN.format(steps=10) +
        "Vectr d/dt u = u{1} - 2*u + u{-1}\nm = u[n/2]\ndispt m\n"
    ),
    "Gray-Scott, 1,000,000 states, rule 1": (
        "n = 500000 | irule 1 | DT = 0.5\nSTATE u[n], v[n]\nARRAY r[n]\n"
        "for i = 1 to n | u[i] = 1 | next | for i = n/2 to n/2 + 40 | v[i] = 0.5 | next\n" +
        _RUN.format(steps=20) +
        "Vector r = u*v*v\nVectr d/dt u = 0.16*(u{1} - 2*u + u{-1}) - r + 0.035*(1 - u)\n"
        "Vectr d/dt v = 0.08*(v{1} - 2*v + v{-1}) + r - 0.1*v\nm = v[n/2]\ndispt m\n"
    ),
    "heat equation, 1,000,000 states, rule 4": (
        "n = 1000000 | irule 4 | DT = 0.25 | ERMAX = 0.001\nSTATE u[n]\nu[n/2] = 1\n" +
        _RUN.format(steps=10) +
        "Vectr d/dt u = u{1} - 2*u + u{-1}\nm = u[n/2]\ndispt m\n"
    ),
    "heat equation, 1,000,000 states, rule 17": (
        "n = 1000000 | irule 17 | DT = 1 | ERMAX = 1E-8\nSTATE u[n]\nu[n/2] = 1\n" + _RUN.format(steps=10) +
        "Vectr d/dt u = u{1} - 2*u + u{-1}\nm = u[n/2]\ndispt m\n"
    ),
    "Gray-Scott, 1,000,000 states, rule 17": (
        "n = 500000 | irule 17 | DT = 1 | ERMAX = 1E-8\nSTATE u[n], v[n]\nARRAY r[n]\n"
        "for i = 1 to n | u[i] = 1 | next | for i = n/2 to n/2 + 40 | v[i] = 0.5 | next\n" +
        _RUN.format(steps=10) +
        "Vector r = u*v*v\nVectr d/dt u = 0.16*(u{1} - 2*u + u{-1}) - r + 0.035*(1 - u)\n"
        "Vectr d/dt v = 0.08*(v{1} - 2*v + v{-1}) + r - 0.1*v\nm = v[n/2]\ndispt m\n"
    ),
    "1,500 x 1,500 layer tanh(W*x), rule 3": (
        "n = 1500 | irule 3 | DT = 0.01\nSTATE x[n] | ARRAY W[n,n]\n"
        "for i = 1 to n | x[i] = 0.001*i - 1 | W[i,i] = 1 | next\n" + _RUN.format(steps=20) +
        "Vectr d/dt x = tanh(W*x) - 0.1*x\nm = x[1]\ndispt m\n"
    ),
    "100,000 replicas of 2 states with sin, cos; rule 3": (
        "n = 100000 | irule 3 | DT = 0.01\nSTATE p[n], q[n]\nfor i = 1 to n | p[i] = i/n | next\n" +
        _RUN.format(steps=20) +
        "Vectr d/dt p = q\nVectr d/dt q = -sin(p) - 0.1*q*cos(p)\nm = p[1]\ndispt m\n"
    ),
}  # fmt: skip
_C = """
#define N 1000000
static double x[N], y[N], k1[N], k2[N], k3[N], k4[N];
#define LOOP _Pragma("omp parallel for num_threads(THREADS)") for (int j = 0; j < N; j++)
static void f(const double *restrict a, double *restrict d) {
    d[0] = a[1] - 2*a[0]; d[N-1] = -2*a[N-1] + a[N-2];
    _Pragma("omp parallel for num_threads(THREADS)")
    for (int i = 1; i < N-1; i++) d[i] = a[i+1] - 2*a[i] + a[i-1];
}
static void step(double h) {
    f(x, k1); LOOP y[j] = x[j] + 0.5*h*k1[j];
    f(y, k2); LOOP y[j] = x[j] + 0.5*h*k2[j];
    f(y, k3); LOOP y[j] = x[j] + h*k3[j];
    f(y, k4); LOOP x[j] += h/6*(k1[j] + 2*k2[j] + 2*k3[j] + k4[j]);
}
"""


def c_with_openmp(threads: int) -> float:
    """Return the seconds of ten steps of the heat equation."""
    text = _C.replace("THREADS", str(threads))
    return run_c(
        text, "memset(x, 0, sizeof x); x[N/2] = 1;", "for (int i = 0; i < 10; i++) step(0.25);", "x[N/2]",
        flags=("-fopenmp",),
    )[0]  # fmt: skip


def measure(program: str, threads: int) -> tuple[float, float, bool]:
    """Return the least seconds of a run on one thread and on all, and whether arrays have the same bits."""
    session = Session()
    session.erun(Source(program, "threads"))
    for _ in range(2):  # fast code comes meanwhile
        time.sleep(1.0)
        session.execute("drunr")
    pool, times, bits = thread_pool(), {1: [0.0], threads: [0.0]}, set()
    for _ in range(ROUNDS):
        for members, found in times.items():
            pool.resize(members)
            session.execute("drunr")
            found.append(session.runs[-1].seconds)
            arrays = [session.values.view(q).tobytes() for q in session.values if q.shape]
            bits.add(blake2b(b"".join(arrays)).digest())
    return min(times[1][1:]), min(times[threads][1:]), len(bits) == 1


def main() -> None:
    """Print a table."""
    threads = cores()
    print(f"{'':52} {'1 thread':>9} {f'{threads} threads':>10} {'ratio':>6}  same bits")
    alone, shared = c_with_openmp(1), c_with_openmp(threads)
    print(f"{'heat equation in C with OpenMP':52} {alone:9.4f} {shared:10.4f} {alone / shared:6.2f}")
    for name, program in PROGRAMS.items():
        alone, shared, same = measure(program, threads)
        print(
            f"{name:52} {alone:9.4f} {shared:10.4f} {alone / shared:6.2f}  {'yes' if same else 'NO'}",
            flush=True,
        )


if __name__ == "__main__":
    main()
