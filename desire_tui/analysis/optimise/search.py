"""`minimise` and `maximise`: what is asked, the search, what is found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.optimise import methods
from desire_tui.analysis.optimise.objective import Objective
from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.unknowns import Scale, Unknown, read_unknowns, start_values
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

EXAMPLE = "minimise max(x) over k in [0, 5], r"
RUNS = 20_000
WAYS = ("local", "global", "cma")
_PROFILE_POINTS = 61
_PROFILE_PART = 0.2
_PROFILES_MOST = 4
_AT_BOUND = 1e-6


@dataclass(frozen=True)
class _Asked:
    text: str
    unknowns: list[Unknown]
    way: str = "local"
    runs: int = RUNS
    seed: int = 0


def minimise(subject: Subject, request: str, progress: Progress) -> Result:
    """Return where a quantity is least. DesireError: see `Request`, `Objective`."""
    return _search(subject, _read(request), progress, 1.0)


def maximise(subject: Subject, request: str, progress: Progress) -> Result:
    """Return where a quantity is greatest. DesireError: see `Request`, `Objective`."""
    return _search(subject, _read(request), progress, -1.0)


def _read(request: str) -> _Asked:
    asked = Request(request, EXAMPLE)
    text = asked.expression("over")
    asked.expect("over")
    unknowns = read_unknowns(asked, "by", "runs", "seed")
    way, runs, seed = "local", RUNS, 0
    while not asked.is_done:
        word, span = asked.expect("by", "runs", "seed"), asked.span
        if word == "by":
            way = asked.known(asked.name("a way to search"), WAYS, "way to search", span)
            continue
        if word == "runs":
            runs = asked.whole(1, "runs 1000")
        else:
            seed = asked.whole(0, "seed 1")
    free = next((one for one in unknowns if not one.is_bounded), None)
    if way == "global" and free is not None:
        asked.fail(f"a global search needs bounds of {free.name}", f"{free.name} in [0, 5]", free.span)
    return _Asked(text, unknowns, way, runs, seed)


def _search(subject: Subject, asked: _Asked, progress: Progress, sign: float) -> Result:
    objective = Objective(subject, asked.text, asked.unknowns, sign)
    start = start_values(subject, asked.unknowns)
    objective.scale = Scale(asked.unknowns, start)
    objective.check(objective.scale.values(objective.scale.start))
    is_stopped = False

    def go_on() -> bool:
        nonlocal is_stopped
        told = f"{asked.text} = {sign * objective.best:.6g} after {objective.evaluations} runs"
        part = None if asked.way == "local" else min(objective.evaluations / asked.runs, 1.0)
        is_stopped = not progress(part, told, _found(subject, asked, objective, start))
        return not is_stopped

    if asked.way == "global":
        methods.population(objective, go_on, asked.runs, asked.seed)
    elif asked.way == "cma":
        methods.covariance(objective, objective.scale.start, go_on, asked.runs, asked.seed)
    else:
        _needs_influence(subject, asked, objective)
    if not is_stopped:
        begin = objective.best_z if len(objective.best_z) else objective.scale.start
        methods.local(objective, begin, go_on, objective.evaluations + asked.runs)
    found = _found(subject, asked, objective, start)
    found.is_partial = is_stopped
    if not is_stopped:
        found.charts += _profiles(asked, objective)
        if objective.evaluations >= asked.runs and asked.way == "local":
            found.notes.append(f"ended after {objective.evaluations} runs: 'runs {10 * asked.runs}' goes on")
    return found


def _needs_influence(subject: Subject, asked: _Asked, objective: Objective) -> None:
    """DesireError 521: no unknown changes J at the place where a local search begins."""
    _, slopes = methods.gradient(objective, objective.scale.start)
    if not np.any(slopes):
        names = ", ".join(objective.names)
        facts = {"what": f"{asked.text} does not change with {names} where the search begins",
                 "remedy": "begin elsewhere (k = 2), or search everywhere: by global"}  # fmt: skip
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))


def _found(subject: Subject, asked: _Asked, objective: Objective, start: Floats) -> Result:
    z = objective.best_z if len(objective.best_z) else objective.scale.start
    values, best = objective.scale.values(z), objective.sign * objective.best
    word = "least" if objective.sign > 0 else "greatest"
    notes = [
        f"{one.name} stands at its bound {end:g}"
        for one, value in zip(asked.unknowns, values, strict=True)
        for end in (one.low, one.high)
        if np.isfinite(end) and abs(value - end) <= _AT_BOUND * max(abs(end), 1e-300)
    ]
    table = Table("", {"": list(objective.names), "from": start.tolist(), "to": values.tolist()})
    runs, gains = zip(*objective.history, strict=True) if objective.history else ((), ())
    chart = Chart(f"{asked.text}: the {word} so far", "runs", asked.text,
                  [Series(asked.text, np.array(runs, dtype=float), np.array(gains))])  # fmt: skip
    named = dict(zip(objective.names, values.tolist(), strict=True))
    return Result(
        f"{asked.text} is {word}, {best:.8g}, {subject.name} ({objective.evaluations} runs)",
        {**named, "best": best, "runs": objective.evaluations},
        [table], [chart], notes,
    )  # fmt: skip


def _profiles(asked: _Asked, objective: Objective) -> list[Chart]:
    """Return J along each unknown through the best place: whether it is sharp, flat or at a bound."""
    charts = []
    for k, name in enumerate(objective.names[:_PROFILES_MOST]):
        z = objective.best_z
        low, high = (max(z[k] - _PROFILE_PART, objective.scale.low[k]),
                     min(z[k] + _PROFILE_PART, objective.scale.high[k]))  # fmt: skip
        rows = np.tile(z, (_PROFILE_POINTS, 1))
        rows[:, k] = np.linspace(low, high, _PROFILE_POINTS)
        y = objective.sign * np.where(np.isfinite(found := objective.many(rows)), found, np.nan)
        x = objective.scale.values(rows)[:, k]
        least = np.array([objective.sign * objective.best])
        best = Series("found", objective.scale.values(z)[k : k + 1], least, "points")
        title = f"{asked.text} along {name}"
        lines = [Series(asked.text, x, y), best]
        charts.append(Chart(title, name, asked.text, lines, log_x=asked.unknowns[k].is_log))
    return charts
