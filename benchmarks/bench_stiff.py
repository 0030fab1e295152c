"""Stiff problems: rules 14 and 15 beside scipy's BDF and LSODA and scikit-sundae's CVODE.

Goals (performance.md): at least 20 times faster than each at the same accuracy; within 1.2 times of CVODE
from C; 5,000 states of a heat equation 50 times faster than with a dense matrix, and linear in n. Run:
`python -m benchmarks.bench_stiff`.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from desire_tui.engine.session import Listener, Session
from desire_tui.engine.source import Source

ROBERTSON = """
y1 = 1
irule {rule} | ERMAX = {ermax} | DT = {dt} | TMAX = {t_end} | NN = 2
for k = 1 to {repeats} | drunr | next
DYNAMIC
p = 1E+04*y2*y3 | q = 3E+07*y2*y2
d/dt y1 = p - 0.04*y1
d/dt y2 = 0.04*y1 - p - q
d/dt y3 = q
dispt y1, y2, y3
"""
VAN_DER_POL = """
mu = 1000 | x = 2
irule {rule} | ERMAX = {ermax} | DT = {dt} | TMAX = {t_end} | NN = 2
for k = 1 to {repeats} | drunr | next
DYNAMIC
d/dt x = v
d/dt v = mu*(1 - x*x)*v - x
dispt x, v
"""


def robertson(_t, y):
    p, q = 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]
    return [p - 0.04 * y[0], 0.04 * y[0] - p - q, q]


def robertson_matrix(_t, y):
    return [[-0.04, 1e4 * y[2], 1e4 * y[1]],
            [0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]],
            [0.0, 6e7 * y[1], 0.0]]  # fmt: skip


def van_der_pol(_t, y):
    return [y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]]


def van_der_pol_matrix(_t, y):
    return [[0.0, 1.0], [-2000.0 * y[0] * y[1] - 1.0, 1000.0 * (1.0 - y[0] * y[0])]]


@dataclass(frozen=True)
class Case:
    """One problem; the others' absolute tolerance for each state is ERMAX times its largest value."""

    name: str
    program: str
    f: object
    matrix: object
    start: list[float]
    t_end: float
    ermax: float
    dt: float
    largest: list[float]
    c: str


CASES = (
    Case("Robertson to 1e11", ROBERTSON, robertson, robertson_matrix, [1.0, 0.0, 0.0], 1e11, 1e-10, 1e-6,
         [1.0, 3.65e-5, 1.0], "k[0]=1e4*y[1]*y[2]-0.04*y[0];k[2]=3e7*y[1]*y[1];k[1]=-k[0]-k[2];"),
    Case("Van der Pol mu = 1000", VAN_DER_POL, van_der_pol, van_der_pol_matrix, [2.0, 0.0], 2000.0, 1e-6,
         1e-6,
         [2.0, 1333.6], "k[0]=y[1];k[1]=1000*(1-y[0]*y[0])*y[1]-y[0];"),
)  # fmt: skip


def desire(case: Case, rule: int, repeats: int = 200) -> tuple[float, list[float]]:
    """Best of the runs' own times, and the states at the end of the last."""
    text = case.program.format(rule=rule, ermax=case.ermax, dt=case.dt, t_end=case.t_end, repeats=repeats)
    session = Session(Listener())
    session.erun(Source(text, case.name))
    last = session.runs[-1]
    return min(run.seconds for run in session.runs), [float(v) for v in last.rows[last.count - 1, 1:]]


def scipy_time(case: Case, method: str) -> tuple[float, list[float]]:
    from scipy.integrate import solve_ivp

    absolute = case.ermax * np.array(case.largest)
    times, found = [], None
    for _ in range(3):
        began = time.perf_counter()
        found = solve_ivp(
            case.f, (0, case.t_end), case.start, method=method, jac=case.matrix, first_step=case.dt,
            rtol=max(case.ermax, 3e-14), atol=absolute,
        )  # fmt: skip
        times.append(time.perf_counter() - began)
    assert found is not None
    return min(times), list(found.y[:, -1])


def sundae_time(case: Case) -> tuple[float, list[float]]:
    from sksundae.cvode import CVODE

    def rhs(t, y, yp):
        yp[:] = case.f(t, y)

    def jac(t, y, _yp, out):
        out[:, :] = case.matrix(t, y)

    times, found = [], None
    for _ in range(5):
        absolute = case.ermax * np.array(case.largest)
        solver = CVODE(rhs, jacfn=jac, rtol=case.ermax, atol=absolute, method="BDF",
                       first_step=case.dt, max_num_steps=10**6)  # fmt: skip
        began = time.perf_counter()
        found = solver.solve([0.0, case.t_end], np.array(case.start))
        times.append(time.perf_counter() - began)
    assert found is not None
    return min(times), list(found.y[-1])


C_TEXT = """
#include <stdint.h>
#include <math.h>
#include <string.h>
/* CVODE from C: right-hand side, weights and loop compiled together, the library called directly. */
typedef void *P;
extern int CVode(P, double, P, double *, int); extern int CVodeReInit(P, double, P);
extern int CVodeSetInitStep(P, double); extern int CVodeSetStopTime(P, double);
static double *data(P v) {{ P *vector = v; char *content = vector[0]; return *(double **)(content + 8); }}
static double largest[{n}], tolerance = {ermax};
int rhs(double t, P yv, P kv, P user) {{ double *y = data(yv), *k = data(kv); {c} return 0; }}
int weights(P yv, P wv, P user) {{ double *y = data(yv), *w = data(wv);
  for (int i = 0; i < {n}; i++) {{ double a = fabs(y[i]); if (a > largest[i]) largest[i] = a;
    w[i] = 1/(tolerance*(largest[i] == 0 ? 1 : largest[i])); }} return 0; }}
int run(P memory, P vector, double t_end, double dt) {{ double t = 0; int flag;
  memset(largest, 0, sizeof largest);
  CVodeReInit(memory, 0, vector); CVodeSetInitStep(memory, dt); CVodeSetStopTime(memory, t_end);
  do flag = CVode(memory, t_end, vector, &t, 2); while (flag == 0); return flag; }}
"""


def c_time(case: Case, repeats: int = 200) -> tuple[float, list[float]] | None:
    """CVODE called from compiled C, with its own differenced Jacobian; None without a C compiler."""
    from desire_tui.engine.integration.sundials.library import libraries
    from desire_tui.engine.integration.sundials.linear import Linear
    from desire_tui.engine.integration.sundials.solver import Callbacks, Solver

    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    n = len(case.start)
    with tempfile.TemporaryDirectory() as folder:
        source, built = Path(folder, "case.c"), Path(folder, "case.so")
        source.write_text(C_TEXT.format(n=n, ermax=case.ermax, c=case.c))
        cvode = libraries().cvode._name
        subprocess.run([compiler, "-O3", "-march=native", "-shared", "-fPIC", "-o", built, source, cvode,
                        f"-Wl,-rpath,{Path(cvode).parent}"], check=True)  # fmt: skip
        library = ctypes.CDLL(str(built))
        y = np.array(case.start)
        addresses = [
            ctypes.cast(getattr(library, name), ctypes.c_void_p).value for name in ("rhs", "weights")
        ]
        solver = Solver(15, n, y.ctypes.data, Callbacks(*addresses), Linear("dense"))
        library.run.argtypes = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)
        times = []
        for _ in range(repeats):
            y[:] = case.start
            began = time.perf_counter()
            library.run(solver.memory, solver.vector, case.t_end, case.dt)
            times.append(time.perf_counter() - began)
        return min(times), y.tolist()


HEAT = """
n = {n} | STATE u[{n}]
for i = 1 to n | u[i] = sin(PI*i/(n+1)) | next
c = (n+1)^2
irule 14 | ERMAX = 1E-6 | DT = 1E-6 | TMAX = 0.1 | NN = 11
for k = 1 to {repeats} | drunr | next
DYNAMIC
Vectr d/dt u = c*(u{{1}} - 2*u + u{{-1}})
dispt u[1]
"""


def heat(n: int, *, dense: bool = False, repeats: int = 15) -> float:
    """Seconds for a heat equation of n states under rule 14."""
    from desire_tui.engine.integration import plan
    from desire_tui.engine.integration.sundials.linear import Linear

    original = plan._linear
    if dense:
        plan._linear = lambda _pattern: Linear("dense")
    try:
        session = Session(Listener())
        session.erun(Source(HEAT.format(n=n, repeats=repeats), "heat"))
    finally:
        plan._linear = original
    return min(run.seconds for run in session.runs)


def main() -> None:
    """Measure and print."""
    for case in CASES:
        print(f"\n{case.name}, ERMAX {case.ermax:g}; milliseconds, and the first state at the end")
        rows = {f"desire, rule {rule}": desire(case, rule) for rule in (14, 15)}
        c = c_time(case)
        if c is not None:
            rows["CVODE called from C"] = c
        rows["scikit-sundae, Python function"] = sundae_time(case)
        for method in ("BDF", "LSODA"):
            rows[f"scipy {method}"] = scipy_time(case, method)
        own = rows["desire, rule 14"][0]
        for name, (seconds, end) in rows.items():
            print(f"  {name:32s} {1e3 * seconds:10.3f}   {seconds / own:8.2f} ×   {end[0]:.10g}")
    print("\nheat equation, rule 14; milliseconds")
    times = {n: heat(n) for n in (1250, 2500, 5000, 10000)}
    for n, seconds in times.items():
        print(f"  n = {n:6d} {1e3 * seconds:10.2f}   {1e6 * seconds / n:8.2f} µs a state")
    few = heat(1250, dense=True, repeats=1)
    print(f"  n =   1250 with a dense matrix {1e3 * few:10.1f}   {few / times[1250]:8.1f} ×")


if __name__ == "__main__":
    main()
