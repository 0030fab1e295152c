"""`steady over k in [0, 2]`: the steady states at values of a parameter, as a table and as charts."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.influence import USEFUL, has_influence
from desire_tui.analysis.equilibria.kinds import is_stable, shown
from desire_tui.analysis.equilibria.listed import tables
from desire_tui.analysis.equilibria.search import search
from desire_tui.analysis.result import Result
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.search import Found, Steady
    from desire_tui.analysis.equilibria.starts import Travelled
    from desire_tui.analysis.equilibria.system import System
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.request import Request
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_PLACES = 21
_CHARTS_MOST = 4
_LOOKS = ((True, "stable", 14), (False, "unstable", 12))


@dataclass(frozen=True)
class Over:
    """A parameter and its values."""

    name: str
    values: Floats


def read_over(asked: Request, parameters: Sequence[str]) -> Over | None:
    """Read `over k in [0, 2] [places 21]`. DesireError 520: it is not written so. None: it is not there."""
    if not asked.take("over"):
        return None
    span = asked.span
    name = asked.known(asked.name("a parameter"), parameters, "parameter", span)
    asked.expect("in")
    low, high = asked.interval()
    places = asked.whole(2, "places 21") if asked.take("places") else _PLACES
    return Over(name, np.linspace(low, high, places))


def steady_over(
    subject: Subject,
    system: System,
    over: Over,
    starts: Sequence[Floats],
    within: Callable[[Floats], bool],
    travelled: Travelled,
    progress: Progress,
) -> Result:
    """Return the steady states at each value, found from the starts and from those at the value before.

    DesireError 521: the parameter has no influence; no steady state is found at any value.
    """
    ends = (float(over.values[0]), float(over.values.mean()), float(over.values[-1]))
    if not has_influence(system.flow, system.size, over.name, ends):
        _fail(subject, f"{over.name} has no influence on the derivatives", USEFUL)
    rows: list[tuple[float, Steady]] = []
    known: list[Floats] = []
    families, is_partial = 0, False
    for number, value in enumerate(over.values.tolist()):
        told = f"{over.name} = {value:.5g}, {number} of {len(over.values)}"
        part = number / len(over.values)
        go_on = partial(_go_on, progress, part, told)
        found = search(system, [*known, *starts], {over.name: value}, go_on, within)
        rows += [(value, one) for one in _told(found)]
        families += found.is_family
        known = [one.x for one in found.states]
        if found.is_partial:
            is_partial = True
            break
    if not rows and not is_partial:
        what = f"no steady state is found for {over.name} from {over.values[0]:g} to {over.values[-1]:g}"
        _fail(subject, what, "steady all in x = [-10, 10], … over … tries many starts in a box")
    return _result(subject, system, over, rows, travelled, families=families, is_partial=is_partial)


def _go_on(progress: Progress, part: float, told: str, count: int) -> bool:
    del count
    return progress(part, told)


def _told(found: Found) -> list[Steady]:
    states = found.states[:2] if found.is_family else found.states
    return sorted(states, key=lambda one: tuple(one.x.tolist()))


def _result(
    subject: Subject,
    system: System,
    over: Over,
    rows: list[tuple[float, Steady]],
    travelled: Travelled,
    *,
    families: int,
    is_partial: bool,
) -> Result:
    names = system.flow.names
    values = np.array([value for value, _ in rows])
    x = np.array([one.x for _, one in rows]).reshape(len(rows), len(names))
    stable = np.array([is_stable(one.eigenvalues) for _, one in rows], dtype=bool)
    columns: dict[str, list[object]] = {
        over.name: values.tolist(),
        "kind": [one.kind for _, one in rows],
        **{name: x[:, k].tolist() for k, name in enumerate(names)},
        "eigenvalues": [shown(one.eigenvalues) for _, one in rows],
    }
    drawn = [name for name in travelled.shown if name in names][:_CHARTS_MOST] or names[:_CHARTS_MOST]
    charts = []
    for name in drawn:
        y = x[:, list(names).index(name)]
        series = [
            Series(look, values[stable == is_wanted], y[stable == is_wanted], "points", color=color)
            for is_wanted, look, color in _LOOKS
            if np.any(stable == is_wanted)
        ]
        charts.append(Chart(f"Steady states of {name} over {over.name}", over.name, name, series))
    notes = [*system.flow.notes, *(f"conserved: {text}" for text in system.law_texts)]
    if families:
        notes.append(
            f"at {families} values they are points of a curve of steady states, of which two are listed"
        )
    without = len(over.values) - len(np.unique(values))
    if without and not is_partial:
        notes.append(f"at {without} of {len(over.values)} values there is none")
    notes.append(f"where they turn back and cross: continue {over.name} in [FROM, TO]")
    found = {
        over.name: values, "states": {name: x[:, k] for k, name in enumerate(names)},
        "kinds": [one.kind for _, one in rows], "eigenvalues": [one.eigenvalues for _, one in rows],
        "stable": stable,
    }  # fmt: skip
    title = f"Steady states over {over.name}, {subject.name}"
    return Result(title, found, tables("", columns, names, travelled.shown), charts, notes, is_partial)


def _fail(subject: Subject, what: str, remedy: str) -> None:
    raise DesireError(Diagnostic("analysis-failed", None, {"what": what, "remedy": remedy}, subject.source))
