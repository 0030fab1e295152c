"""Rule 17 beside heyoka, CVODE from C and scipy's DOP853: time against error on five smooth problems.

Goals (issue 19): ahead of all three wherever the error is below 1e-8; Lorenz' equations to t = 1000 at the
machine's precision within 1.5 times heyoka's time; energy of the outer solar system at the level of rounding
over 100,000 years. Run: `python -m benchmarks.bench_taylor [PICTURE]`. `pip install 'desire-tui[bench]'`
brings heyoka, without which its column is missing and the reference solution is rule 17's own.

All begin at the same states and report the last alone. Error: the largest of all states at the end, relative
to each state's magnitude there or, if that is more, its initial one. The reference is heyoka with 80-bit
numbers at 1e-18. Seconds are the least of several runs without compiling; rule 17's without what every run
of Desire takes, whatever its rule and model, before and after its steps (printed: 0.1 ms), which the others'
loops have not.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from itertools import pairwise
from math import log
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.cvode_from_c import c_seconds
from benchmarks.taylor_problems import (
    ARENSTORF,
    KEPLER,
    LORENZ,
    PROBLEMS,
    SmoothProblem,
    energy,
    outer_planets,
)
from desire_tui.engine.codegen.compiler_state import shared_state
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.background import Improvable

try:
    import heyoka
except ImportError:
    heyoka = None

TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15, 0.0)
Points = list[tuple[float, float]]
"""(error, seconds)."""


def desire(
    problem: SmoothProblem, ermax: float, t_end: float, repeats: int = 25
) -> tuple[float, np.ndarray, int]:
    """Seconds without those of a run's frame, last states, steps."""
    script, body = problem.desire
    drive = "drunr\n" * (repeats - 1) + "drun"
    text = (
        f"{script}\nirule 17 | ERMAX = {ermax!r} | DT = 1E-4 | TMAX = {t_end!r} | NN = 2\n"
        f"{drive}\nDYNAMIC\n{body}\n"
    )
    session = Session(Listener())
    before = frame_seconds()
    session.erun(Source(text, "bench"))
    seconds = min(run.seconds for run in session.runs) - min(before, frame_seconds())
    return seconds, _states(session, problem), session.runs[-1].steps


def frame_seconds() -> float:
    """Seconds of a run of one step, now: how fast the machine is changes."""
    session = Session(Listener())
    drive = "drunr\n" * 50
    text = (
        f"x = 0 | irule 17 | ERMAX = 1E-3 | DT = 1 | TMAX = 1 | NN = 2\n{drive}DYNAMIC\nd/dt x = 1\ndispt x\n"
    )
    session.erun(Source(text, "bench"))
    return min(run.seconds for run in session.runs)


def _states(session: Session, problem: SmoothProblem) -> np.ndarray:
    values = session.values
    if problem.arrays[0]:
        return np.concatenate([values.view(values.find(name)) for name in "uv"])
    return np.array([values.cells[values.find(name).slot] for name in problem.start])


def scipy(problem: SmoothProblem, tol: float) -> tuple[float, np.ndarray]:
    """DOP853, its right-hand side in Python."""
    from scipy.integrate import solve_ivp

    began = time.perf_counter()
    found = solve_ivp(
        problem.function, (0, problem.t_end), problem.begin, method="DOP853", rtol=max(tol, 2.3e-14), atol=tol
    )
    return time.perf_counter() - began, found.y[:, -1]


class Heyoka:
    """Its adaptive integrator, compiled for one tolerance."""

    def __init__(self, problem: SmoothProblem, tol: float) -> None:
        compact = len(problem.start) > 60
        more = {"tol": tol} if tol else {}
        self.problem = problem
        self.made = heyoka.taylor_adaptive(
            problem.heyoka(heyoka), list(problem.begin), compact_mode=compact, **more
        )

    def run(self, t_end: float, repeats: int = 25) -> tuple[float, np.ndarray]:
        """Seconds, last states."""
        times = []
        for _ in range(repeats):
            self.made.state[:], self.made.time = self.problem.begin, 0.0
            began = time.perf_counter()
            self.made.propagate_until(t_end)
            times.append(time.perf_counter() - began)
        return min(times), np.array(self.made.state)


def reference(problem: SmoothProblem) -> np.ndarray:
    """The states at the end, to 1e-17."""
    if heyoka is None:
        return desire(problem, 0.0, problem.t_end, repeats=1)[1]
    begin = problem.begin.astype(np.longdouble)
    made = heyoka.taylor_adaptive(problem.heyoka(heyoka), list(begin), fp_type=np.longdouble,
                                  tol=np.longdouble(1e-18), compact_mode=len(begin) > 60)  # fmt: skip
    made.propagate_until(np.longdouble(problem.t_end))
    return np.array(made.state, dtype=float)


def work_precision(problem: SmoothProblem) -> dict[str, Points]:
    """Measure all solvers at all tolerances."""
    exact = reference(problem)
    scale = np.maximum(np.maximum(np.abs(exact), np.abs(problem.begin)), 1e-3)
    found: dict[str, Points] = {"rule 17": []}
    if heyoka is not None:
        found["heyoka"] = []
    found |= {"CVODE from C (Adams)": [], "scipy DOP853": []}

    def note(name: str, seconds: float, end: np.ndarray | None) -> None:
        if end is not None and np.isfinite(end).all():
            found[name].append((float(np.max(np.abs(end - exact) / scale)), seconds))

    for tol in TOLERANCES:
        note("rule 17", *desire(problem, tol, problem.t_end)[:2])
        if heyoka is not None:
            note("heyoka", *Heyoka(problem, tol).run(problem.t_end))
        if tol:
            note("CVODE from C (Adams)", *c_seconds(problem, tol))
            note("scipy DOP853", *scipy(problem, tol))
    return found


def seconds_at(points: Points, error: float) -> float:
    """Least time among the runs with at most this error, and between two runs next to it; inf: none."""
    found = [seconds for wrong, seconds in points if wrong <= error]
    for (wrong, seconds), (less, more) in pairwise(points):
        if wrong > error > less:
            part = log(wrong / error) / log(wrong / less)
            found.append(seconds ** (1 - part) * more**part)
    return min(found, default=float("inf"))


def report(problem: SmoothProblem, found: dict[str, Points]) -> None:
    """Print a problem's points, and each solver's time in units of rule 17's at the same error."""
    print(f"\n{problem.name}")
    for name, points in found.items():
        print(
            f"  {name:22s}" + "  ".join(f"{error:.0e}: {1e3 * seconds:.3g} ms" for error, seconds in points)
        )
    for goal in (1e-6, 1e-8, 1e-10, 1e-12, 1e-14):
        own = seconds_at(found["rule 17"], goal)
        ratios = {name: seconds_at(points, goal) / own for name, points in found.items() if name != "rule 17"}
        if own < float("inf"):
            print(f"    error {goal:.0e}: " + ", ".join(f"{name} {r:.3g}" for name, r in ratios.items()))


def long_lorenz() -> None:
    """Print the times of Lorenz' equations to t = 1000 at the machine's precision."""
    best = []
    for _ in range(3):  # side by side, since other programs run too
        seconds, _, steps = desire(LORENZ, 0.0, 1000.0)
        beside = Heyoka(LORENZ, 0.0).run(1000.0)[0] if heyoka is not None else float("nan")
        best.append((seconds, beside))
    own, other = (min(column) for column in zip(*best, strict=True))
    print(f"\nLorenz to t = 1000: rule 17 {1e3 * own:.2f} ms in {steps} steps, heyoka {1e3 * other:.2f} ms")
    print(f"  {own / other:.2f} times; a run's frame: {1e3 * frame_seconds():.3f} ms")


def long_energy(years: float = 1e5) -> None:
    """Print the energy's error of the outer solar system along the way, beside heyoka's at the end."""
    problem = outer_planets(years)
    script, body = problem.desire
    names = ", ".join(problem.start)
    text = (
        f"{script}\nirule 17 | ERMAX = 0 | DT = 1 | TMAX = {problem.t_end!r} | NN = 101\ndrun\nDYNAMIC\n"
        f"{body.rpartition('dispt')[0]}dispt {names}\n"
    )
    session = Session(Listener())
    session.erun(Source(text, "bench"))
    run = session.runs[-1]
    levels = [energy(row[1:]) for row in run.rows[: run.count]]
    worst = max(abs(float(level / levels[0] - 1)) for level in levels)
    print(f"\n{problem.name}: energy's error {worst:.1e} in {run.steps} steps, {run.seconds:.2f} s")
    print(f"  a random walk of {run.steps} roundings: {2.0**-53 * run.steps**0.5:.1e}")
    if heyoka is not None:
        seconds, end = Heyoka(problem, 0.0).run(problem.t_end, repeats=1)
        print(f"  heyoka: {abs(float(energy(end) / levels[0] - 1)):.1e} at the end, {seconds:.2f} s")


def spread_of_errors(problem: SmoothProblem, starts: int = 100) -> None:
    """Print the errors at the machine's precision for starts next to the problem's, beside heyoka's.

    One error alone says little where an orbit magnifies the first roundings a million times.
    """
    if heyoka is None:
        return
    random = np.random.default_rng(1)
    found: list[tuple[float, float]] = []
    for _ in range(starts):
        moved = {name: x * (1 + 1e-13 * random.normal()) for name, x in problem.start.items()}
        near = replace(problem, start=moved)
        exact = reference(near)
        scale = np.maximum(np.maximum(np.abs(exact), np.abs(near.begin)), 1e-3)
        ends = desire(near, 0.0, near.t_end, repeats=1)[1], Heyoka(near, 0.0).run(near.t_end, repeats=1)[1]
        found.append(tuple(float(np.max(np.abs(end - exact) / scale)) for end in ends))
    print(f"\n{problem.name}, {starts} starts: errors of a tenth, a half, nine tenths are below")
    for name, errors in zip(("rule 17", "heyoka"), zip(*found, strict=True), strict=True):
        print(f"  {name:22s}" + "  ".join(f"{x:.1e}" for x in np.quantile(errors, (0.1, 0.5, 0.9))))


def picture(results: dict[str, dict[str, Points]], path: Path) -> None:
    """Draw time against error."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 7), layout="constrained")
    axes = figure.subplots(2, 3).flat
    for axis, (title, found) in zip(axes, results.items(), strict=False):
        for name, points in found.items():
            errors, seconds = zip(*sorted(points), strict=True)
            axis.loglog(np.maximum(errors, 1e-17), seconds, "o-", ms=3, label=name)
        axis.set_title(title, fontsize=10)
        axis.set_xlabel("error at the end")
        axis.set_ylabel("seconds")
        axis.grid(alpha=0.3)
    last = list(figure.axes)[-1]
    last.axis("off")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    last.legend(handles, labels, loc="center")
    figure.savefig(path, dpi=110)


def _at_once(work: Improvable) -> None:
    """Compile fast code now: short runs would be over before it came."""
    for _ in work.improve():
        pass


def main() -> None:
    """Measure and print; draw where an argument names a file."""
    shared_state().improver.add = _at_once  # type: ignore[method-assign]
    long_lorenz()
    long_energy()
    for problem in (ARENSTORF, KEPLER):
        spread_of_errors(problem)
    results = {}
    for problem in PROBLEMS:
        results[problem.name] = work_precision(problem)
        report(problem, results[problem.name])
    if len(sys.argv) > 1:
        picture(results, Path(sys.argv[1]))


if __name__ == "__main__":
    main()
