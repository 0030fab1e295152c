"""CVODE's Adams method called from compiled C: right-hand side, weights and loop in one library."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from benchmarks.taylor_problems import SmoothProblem

_TEXT = """
#include <math.h>
#include <string.h>
typedef void *P;
extern int CVode(P, double, P, double *, int); extern int CVodeReInit(P, double, P);
extern int CVodeSetInitStep(P, double); extern int CVodeSetStopTime(P, double);
static double *data(P v) {{ P *vector = v; char *content = vector[0]; return *(double **)(content + 8); }}
static double largest[{n}], tolerance;
int rhs(double t, P yv, P kv, P user) {{ double *state = data(yv), *rate = data(kv); {c} return 0; }}
int weights(P yv, P wv, P user) {{ double *y = data(yv), *w = data(wv);
  for (int i = 0; i < {n}; i++) {{ double a = fabs(y[i]); if (a > largest[i]) largest[i] = a;
    w[i] = 1/(tolerance*(largest[i] == 0 ? 1 : largest[i])); }} return 0; }}
int run(P memory, P vector, double t_end, double tol) {{ double t = 0; int flag = 0;
  memset(largest, 0, sizeof largest); tolerance = tol;
  CVodeReInit(memory, 0, vector); CVodeSetInitStep(memory, 0); CVodeSetStopTime(memory, t_end);
  do flag = CVode(memory, t_end, vector, &t, 2); while (flag == 0);
  return flag; }}
"""


def c_seconds(problem: SmoothProblem, tol: float, repeats: int = 5) -> tuple[float, np.ndarray | None]:
    """Seconds and last states; None: it failed, or there is no C compiler."""
    from desire_tui.engine.integration.sundials.library import libraries
    from desire_tui.engine.integration.sundials.linear import Linear
    from desire_tui.engine.integration.sundials.solver import Callbacks, Solver

    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return float("inf"), None
    n = len(problem.start)
    with tempfile.TemporaryDirectory() as folder:
        source, built = Path(folder, "case.c"), Path(folder, "case.so")
        source.write_text(_TEXT.format(n=n, c=problem.c))
        cvode = libraries().cvode._name
        subprocess.run([compiler, "-O3", "-march=native", "-shared", "-fPIC", "-o", built, source, cvode,
                        f"-Wl,-rpath,{Path(cvode).parent}"], check=True)  # fmt: skip
        library = ctypes.CDLL(str(built))
        y = problem.begin
        rhs, weights = (ctypes.cast(getattr(library, f), ctypes.c_void_p).value for f in ("rhs", "weights"))
        solver = Solver(9, n, y.ctypes.data, Callbacks(rhs, weights), Linear("fixed-point"))
        real, address = ctypes.c_double, ctypes.c_void_p
        library.run.argtypes = (address, address, real, real)
        times, flag = [], 0
        for _ in range(repeats):
            y[:] = problem.begin
            began = time.perf_counter()
            flag = library.run(solver.memory, solver.vector, problem.t_end, tol)
            times.append(time.perf_counter() - began)
        return min(times), y.copy() if flag >= 0 else None
