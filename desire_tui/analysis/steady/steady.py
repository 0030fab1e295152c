"""`steady`: where all states stand still, and whether the system comes back when it is pushed away."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import Flow
from desire_tui.analysis.equilibria.kinds import shown
from desire_tui.analysis.equilibria.listed import tables
from desire_tui.analysis.equilibria.search import search
from desire_tui.analysis.equilibria.starts import Travelled, spread
from desire_tui.analysis.equilibria.system import System
from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result
from desire_tui.analysis.steady.over import read_over, steady_over
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.search import Found, Steady
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Table
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

EXAMPLE = "steady all in x = [-2, 2], y = [-1, 3]"
_STARTS = 64
_BOX_STARTS = 512
_WALL = 1e-9


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the steady states that are found.

    DesireError 520: the request is wrong; 521: there are none, or nothing can be still; 491: see `Flow`.
    """
    asked = Request(request, EXAMPLE)
    is_here = bool(asked.take("from")) and bool(asked.expect("here"))
    box = _box(asked, tuple(subject.model.states)) if not is_here and asked.take("all") else None
    over = read_over(asked, tuple(subject.model.parameters))
    asked.end()
    flow = Flow(subject)
    progress(0.0, "run")
    travelled = Travelled(subject)
    moved = [] if over is None else [{over.name: value} for value in over.values[[0, -1]].tolist()]
    system = System(flow, travelled.start, travelled.size, moved)
    now = subject.here or {}
    here = np.array([now.get(name, x) for name, x in zip(flow.names, flow.start.tolist(), strict=True)])
    starts = [here] if is_here else _starts(travelled, box)

    if over is not None:
        with np.errstate(all="ignore"):
            return steady_over(
                subject, system, over, starts, lambda x: _is_within(x, box), travelled, progress
            )

    def go_on(count: int) -> bool:
        return progress(count / len(starts), f"{count} of {len(starts)} starts")

    with np.errstate(all="ignore"):  # what runs off is told in words
        found = search(system, starts, {}, go_on, lambda x: _is_within(x, box))
    if not found.states and not found.is_partial:
        _nothing(subject, found, is_box=box is not None)
    return _result(subject, system, found, travelled, here if is_here else travelled.end)


def _box(asked: Request, names: tuple[str, ...]) -> dict[int, tuple[float, float]]:
    """Read `in x = [a, b], y = [c, d]`."""
    box = {}
    asked.expect("in")
    while True:
        span = asked.span
        name = asked.known(asked.name("a state"), names, "state", span)
        asked.expect("=")
        box[names.index(name)] = asked.interval()
        if not asked.take(","):
            return box


def _starts(travelled: Travelled, box: dict[int, tuple[float, float]] | None) -> list[Floats]:
    low, high = travelled.box()
    for number, (first, last) in (box or {}).items():
        low[number], high[number] = first, last
    places = spread(low, high, _STARTS if box is None else _BOX_STARTS)
    return [travelled.end, travelled.start, *places]


def _is_within(x: Floats, box: dict[int, tuple[float, float]] | None) -> bool:
    """Whether a place is in the box, its walls included."""
    return all(
        low - _WALL * (high - low) <= x[k] <= high + _WALL * (high - low)
        for k, (low, high) in (box or {}).items()
    )


def _nothing(subject: Subject, found: Found, *, is_box: bool) -> None:
    ways = {
        "infinity": "run off to infinity",
        "singular": "end where the Jacobian is singular",
        "stuck": "come to no end",
    }
    ended = [f"{count} {ways[why]}" for why, count in found.outcomes.most_common() if why != "found"]
    inside = f"{found.outcomes['found']} end outside the box" if found.outcomes["found"] else ""
    tried = sum(found.outcomes.values())
    told = ", ".join([*filter(None, [inside]), *ended])
    what = f"no steady state is found: of {tried} start{'s' * (tried != 1)} {told}"
    if found.outcomes["singular"] * 2 > tried:
        remedy = "is there a state on which no derivative depends?"
    elif found.outcomes["infinity"] * 2 > tried:
        remedy = "the system may have none, or one at infinity only; look at the derivatives for large states"
    elif is_box:
        remedy = "a larger box, or `steady` alone"
    else:
        remedy = "steady all in x = [-10, 10], … tries many starts in a box"
    raise DesireError(Diagnostic("analysis-failed", None, {"what": what, "remedy": remedy}, subject.source))


def _result(subject: Subject, system: System, found: Found, travelled: Travelled, near: Floats) -> Result:
    z = system.place(near)
    states = sorted(found.states, key=lambda s: float(np.linalg.norm(s.z - z)))
    told = states[:2] if found.is_family else states
    notes = [*system.flow.notes, *(f"conserved: {text}" for text in system.law_texts)]
    if system.law_texts:
        notes.append("eigenvalues are those that the conserved sums leave free")
    if found.is_family:
        notes.append(
            f"{len(states)} starts ended at {len(states)} places, all degenerate: "
            "they are points of a curve of steady states, of which the nearest are listed"
        )
    elif any(s.kind == "degenerate" for s in told):
        notes.append("degenerate: the Jacobian is singular; the linear part does not tell what happens there")
    if travelled.problem:
        notes.append(f"the run ended early: {travelled.problem}")
    lost = found.outcomes["infinity"]
    if lost:
        notes.append(f"{lost} of {sum(found.outcomes.values())} starts ran off to infinity")
    if told:
        notes.append("over a parameter: continue NAME in [FROM, TO], on the desktop c on its slider")
    values = {
        "states": {name: np.array([s.x[k] for s in told]) for k, name in enumerate(system.flow.names)},
        "kinds": [s.kind for s in told],
        "eigenvalues": [s.eigenvalues for s in told],
        "conserved": [dict(zip(system.flow.names, row.tolist(), strict=True)) for row in system.laws],
    }
    title = f"Steady states, {subject.name}"
    return Result(title, values, _tables(system, told, travelled.shown), [], notes, found.is_partial)


def _tables(system: System, states: list[Steady], shown_states: tuple[str, ...]) -> list[Table]:
    columns: dict[str, list[object]] = {
        "number": [k for k, _ in enumerate(states, 1)], "kind": [s.kind for s in states],
    }  # fmt: skip
    columns |= {name: [float(s.x[k]) for s in states] for k, name in enumerate(system.flow.names)}
    columns["eigenvalues"] = [shown(s.eigenvalues) for s in states]
    return tables("", columns, system.flow.names, shown_states)
