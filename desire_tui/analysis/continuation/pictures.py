"""Bifurcation diagrams: lines where it is stable, dashes where not, points where something changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.cycle_curve import Cycle
from desire_tui.analysis.equilibria.kinds import is_stable
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Branch, Diagram
    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.equilibria.system import System
    from desire_tui.engine.graph.chart import Look

    Floats = NDArray[np.float64]

STEADY, CYCLES = 14, 11
_COLORS = {
    "fold": 12, "Hopf": 13, "branch point": 10, "fold of cycles": 9, "period doubling": 13, "torus": 10,
    "branch point of cycles": 12, "cusp": 14, "Bogdanov-Takens": 10, "generalised Hopf": 11, "zero-Hopf": 9,
    "cusp of cycles": 14, "fold-flip": 11, "1:1 resonance": 10, "1:2 resonance": 9,
}  # fmt: skip
_STATES_MOST = 4
_WHAT = {
    "fold": "folds", "Hopf": "Hopf points", "fold of cycles": "folds of cycles",
    "period doubling": "period doublings",
}  # fmt: skip
_LOOKS: tuple[tuple[str, bool, Look], ...] = (("stable", True, "line"), ("unstable", False, "dashes"))
_GAP = np.array([np.nan])


def charts(diagram: Diagram, system: System, over: Sequence[Range], states: Sequence[str]) -> list[Chart]:
    """Return the diagrams of states and periods over a parameter, or the curves over two."""
    if len(over) == 2:
        return [_plane(diagram, over)]
    names = list(system.flow.names)
    drawn = [name for name in states if name in names][:_STATES_MOST] or names[:_STATES_MOST]
    found = [_of_state(diagram, system, over[0], names.index(name)) for name in drawn]
    cycles = [b for b in diagram.branches if b.kind == "cycle" and b.points]
    if cycles:
        series: list[Series] = []
        for name, is_wanted, look in _LOOKS:
            x, y = _joined(cycles, over[0], lambda p: (p.facts.period,), is_stable_wanted=is_wanted)
            if len(x):
                series.append(Series(f"{name} cycles", x, y, look, color=CYCLES))
        found.append(Chart("Periods of cycles", over[0].name, "period", series))
    return found


def _of_state(diagram: Diagram, system: System, over: Range, state: int) -> Chart:
    def steady(point: Point) -> tuple[float, ...]:
        return (float(system.states(point.u[:-1])[state]),)

    def cycle(point: Point) -> tuple[float, ...]:
        x = system.states(point.facts.nodes)[state]
        return float(x.max()), float(x.min())

    series: list[Series] = []
    for kind, what, color, of in (("steady", "", STEADY, steady), ("cycle", " cycles", CYCLES, cycle)):
        branches = [b for b in diagram.branches if b.kind == kind]
        for name, is_wanted, look in _LOOKS:
            x, y = _joined(branches, over, of, is_stable_wanted=is_wanted)
            if len(x):
                series.append(Series(f"{name}{what}", x, y, look, color=color))
    for name in dict.fromkeys(s.kind for s in diagram.specials):
        places = [
            (over.value(float(s.point.u[-1])), y)
            for s in diagram.specials if s.kind == name
            for y in (cycle if isinstance(s.point.facts, Cycle) else steady)(s.point)
        ]  # fmt: skip
        x, y = np.array(places).T
        series.append(Series(name, x, y, "points", color=_COLORS[name]))
    return Chart(f"{system.flow.names[state]} over {over.name}", over.name, system.flow.names[state], series)


def _joined(
    branches: Sequence[Branch],
    over: Range,
    of: Callable[[Point], tuple[float, ...]],
    *,
    is_stable_wanted: bool,
) -> tuple[Floats, Floats]:
    """Return the stretches of branches that are stable, or those that are not, parted by nan."""
    xs: list[Floats] = []
    ys: list[Floats] = []
    for branch in branches:
        x = np.array([over.value(float(p.u[-1])) for p in branch.points])
        rows = np.array([of(p) for p in branch.points]).reshape(len(x), -1)
        for first, last in _stretches(branch, is_stable_wanted=is_stable_wanted):
            for column in rows.T:
                xs += [x[first : last + 1], _GAP]
                ys += [column[first : last + 1], _GAP]
    if not xs:
        return np.empty(0), np.empty(0)
    return np.concatenate(xs), np.concatenate(ys)


def _stretches(branch: Branch, *, is_stable_wanted: bool) -> Iterator[tuple[int, int]]:
    """Yield first and last points of stretches of one stability.

    What lies between two points is as that of them which is further from the imaginary axis or unit circle.
    """
    flags, margins = zip(*(_stability(branch, p) for p in branch.points), strict=True)
    pieces = [
        flags[k] if margins[k] >= margins[k + 1] else flags[k + 1] for k in range(len(branch.points) - 1)
    ]
    begin = None
    for k, flag in enumerate([*pieces, None]):
        if flag == is_stable_wanted and begin is None:
            begin = k
        elif flag != is_stable_wanted and begin is not None:
            yield begin, k
            begin = None


def _stability(branch: Branch, point: Point) -> tuple[bool, float]:
    facts = point.facts
    if branch.kind == "cycle":
        sizes = np.log(np.maximum(np.abs(facts.multipliers.others), 1e-300))
        return facts.unstable == 0, float(np.abs(sizes).min(initial=np.inf))
    return is_stable(facts.eigenvalues), float(np.abs(facts.eigenvalues.real).min(initial=np.inf))


def _plane(diagram: Diagram, over: Sequence[Range]) -> Chart:
    first, second = over
    series = []
    for branch in diagram.branches:
        if branch.points:
            x = np.array([first.value(float(p.u[-2])) for p in branch.points])
            y = np.array([second.value(float(p.u[-1])) for p in branch.points])
            series.append(Series(f"{_WHAT[branch.kind]} ({branch.origin})", x, y, color=_COLORS[branch.kind]))
    for name in dict.fromkeys(s.kind for s in diagram.specials):
        of_kind = [s.point for s in diagram.specials if s.kind == name]
        x = np.array([first.value(float(p.u[-2])) for p in of_kind])
        y = np.array([second.value(float(p.u[-1])) for p in of_kind])
        series.append(Series(name, x, y, "points", color=_COLORS[name]))
    kinds = " and ".join(dict.fromkeys(_WHAT[branch.kind] for branch in diagram.branches))
    title = f"{kinds.capitalize() if kinds.islower() else kinds} over {first.name} and {second.name}"
    limits = (first.low, first.high, second.low, second.high)
    return Chart(title, first.name, second.name, series, limits=limits)
