"""`section z = 27 down of x, y`: where orbits pass through a plane (Poincaré), and what follows on what.

A passage is located in the model's own equations: between two samples they are integrated anew (DOP853,
Hairer, Nørsett & Wanner 1993, II.5) to the moment at which the state has its value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.libraries import needed
from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.signals import read
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

EXAMPLE = "section z = 27 down of x, y"
_PASSAGES_MOST = 100_000
_TOLERANCE = 1e-11
_RUNS_WITHOUT = 10
"""So many runs without a passage end the search."""


@dataclass(frozen=True)
class _Asked:
    state: int | None
    """None: at times a period apart."""
    level: float
    direction: int
    shown: list[str]
    start: float | None
    points: int | None


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return passages: times and states. DesireError 520: what is asked; 521: there are none."""
    asked = _read(subject, request)
    times, states, is_partial = _passages(subject, asked, progress)
    names = list(subject.model.states)
    if not len(times):
        when = "" if asked.start is None else f" from t = {asked.start:g} on"
        what = "the run" if asked.points is None else f"{_RUNS_WITHOUT} runs"
        facts = {
            "what": f"{what}{when} never passed there",
            "remedy": _reach(subject, asked),
        }
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    columns = {"t": times, **{name: states[:, k] for k, name in enumerate(names)}}
    place = "a period apart" if asked.state is None else f"{names[asked.state]} = {asked.level:g}"
    shown = [columns[name] for name in asked.shown]
    charts = []
    if len(shown) > 1:
        charts.append(Chart(f"Section at {place}", asked.shown[0], asked.shown[1],
                            [Series(f"{len(times)} passages", shown[0], shown[1], "points")]))  # fmt: skip
    ends = np.array([shown[0].min(), shown[0].max()])
    first = asked.shown[0]
    charts.append(Chart(f"Return map at {place}", f"{first}, passage n", f"{first}, passage n + 1", [
        Series("passages", shown[0][:-1], shown[0][1:], "points"),
        Series("returns to itself", ends, ends, "dashes"),
    ]))  # fmt: skip
    gaps = np.diff(times)
    notes = [f"{len(times)} passages"]
    if len(gaps):
        notes[0] += f", {gaps.mean():.8g} apart on average ({gaps.min():.6g} … {gaps.max():.6g})"
    table = Table("", {name: column.tolist() for name, column in columns.items()})
    return Result(f"Section of {subject.name} at {place}", columns, [table], charts, notes, is_partial)


def _read(subject: Subject, request: str) -> _Asked:
    asked = Request(request, EXAMPLE)
    names = list(subject.model.states)
    state, level, direction, start, points = None, 0.0, 1, None, None
    if asked.take("every"):
        span = asked.span
        level = asked.number("a period")
        if level <= 0:
            asked.fail("a period is greater than 0", "every 6.2831853", span)
    else:
        span = asked.span
        state = names.index(asked.known(asked.name("a state's name"), names, "state", span))
        asked.expect("=")
        level = asked.number()
        direction = {"up": 1, "down": -1, "both": 0, "": 1}[asked.take("up", "down", "both")]
    shown = [name for k, name in enumerate(names) if k != state][:2] or names[:1]
    while not asked.is_done:
        match asked.expect("of", "from", "points"):
            case "of":
                span = asked.span
                shown = read.names(asked)
                for name in shown:
                    asked.known(name, [*names, "t"], "state", span)
            case "from":
                start = asked.number("a time")
            case _:
                points = min(asked.whole(1, "points 1000"), _PASSAGES_MOST)
    return _Asked(state, level, direction, shown, start, points)


def _passages(subject: Subject, asked: _Asked, progress: Progress) -> tuple[Floats, Floats, bool]:
    """Return times, states (passages, states), and whether the user ended the search."""
    model, settings = subject.model, dict(subject.settings)
    names = tuple(model.states)
    found: list[tuple[float, Floats]] = []
    wanted, without = asked.points or _PASSAGES_MOST, 0
    begin: dict[str, Any] = {}
    while True:
        run = model.run(set=settings, record=names, **begin)
        if run.error is not None:
            raise run.error
        x = np.column_stack([run[name] for name in names])
        before = len(found)
        for passage in _of_run(subject, asked, run.t, x):
            if asked.start is None or passage[0] >= asked.start:
                found.append(passage)
                part = len(found) / wanted if asked.points else None
                if not progress(part, f"{len(found)} passages"):
                    return (*_table(found, len(names)), True)
            if len(found) >= wanted:
                break
        if len(found) == before and not progress(None, f"{len(found)} passages"):
            return (*_table(found, len(names)), True)
        without = 0 if len(found) > before else without + 1
        if asked.points is None or len(found) >= wanted or without >= _RUNS_WITHOUT:
            return (*_table(found, len(names)), False)
        span = float(run.t[-1] - run.t[0])
        begin = {"initial": run.state, "t": (float(run.t[-1]), float(run.t[-1]) + span)}


def _table(found: list[tuple[float, Floats]], n: int) -> tuple[Floats, Floats]:
    times = np.array([t for t, _ in found])
    return times, np.array([x for _, x in found]).reshape(len(found), n)


def _of_run(subject: Subject, asked: _Asked, t: Floats, x: Floats) -> Iterator[tuple[float, Floats]]:
    """Yield the passages between the samples of a run."""
    solve = needed("scipy.integrate", "a section").solve_ivp
    rhs, settings = subject.model.rhs, dict(subject.settings)

    def slopes(at: float, place: Floats) -> Floats:
        return rhs(at, place, **settings)

    if asked.state is None:
        moments = (
            np.arange(np.ceil(t[0] / asked.level - _TOLERANCE), np.floor(t[-1] / asked.level) + 1)
            * asked.level
        )
        for moment in moments:
            k = min(max(int(np.searchsorted(t, moment, "right")) - 1, 0), len(t) - 1)
            if moment - t[k] <= _TOLERANCE * max(abs(moment), 1.0):
                yield float(t[k]), x[k]
            else:
                way = solve(slopes, (t[k], moment), x[k], "DOP853", rtol=_TOLERANCE, atol=_TOLERANCE)
                yield float(moment), way.y[:, -1]
        return
    state = asked.state

    def height(_: float, place: Floats) -> float:
        return float(place[state] - asked.level)

    height.terminal, height.direction = True, asked.direction  # type: ignore[attr-defined]  # as scipy reads it
    side = np.sign(x[:, state] - asked.level)
    turned = side[:-1] * side[1:] < 0
    turned |= (side[1:] == 0) & (side[:-1] != 0)
    if asked.direction:
        turned &= side[:-1] == -asked.direction
    for k in np.flatnonzero(turned).tolist():
        way = solve(slopes, (t[k], t[k + 1]), x[k], "DOP853", events=height, rtol=_TOLERANCE, atol=_TOLERANCE)
        if len(way.t_events[0]):
            yield float(way.t_events[0][0]), way.y_events[0][0]
        else:  # the sample itself, to rounding
            yield float(t[k + 1]), x[k + 1]


def _reach(subject: Subject, asked: _Asked) -> str:
    names = tuple(subject.model.states)
    if asked.state is None:
        return "a longer run, or a shorter period"
    run = subject.model.run(set=dict(subject.settings), record=names)
    values = run[names[asked.state]]
    return f"{names[asked.state]} goes from {values.min():.6g} to {values.max():.6g}"
