"""`phase`: the plane of two states: field, nullclines, steady states, manifolds, basins, orbits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import Flow
from desire_tui.analysis.equilibria.kinds import shown
from desire_tui.analysis.equilibria.listed import tables
from desire_tui.analysis.equilibria.search import search
from desire_tui.analysis.equilibria.starts import Travelled, spread
from desire_tui.analysis.equilibria.system import System
from desire_tui.analysis.phase_plane.live import LivePlane
from desire_tui.analysis.phase_plane.picture import Picture
from desire_tui.analysis.phase_plane.plane import Plane
from desire_tui.analysis.phase_plane.request import read
from desire_tui.analysis.result import Result, Table
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.phase_plane.request import Asked
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_MARGIN = 0.2
_STARTS = 32


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the phase plane, also as something that follows parameters at once (`Result.live`).

    DesireError 520: the request is wrong; 521: there are no two states; 491: see `Flow`.
    """
    asked = read(request, tuple(subject.model.states))
    progress(None, "run")
    flow = Flow(subject)
    if len(flow) < 2:
        facts = {"what": "a phase plane needs two states, and there is one", "remedy": "steady, or continue"}
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    travelled = Travelled(subject)
    axes = _axes(asked, travelled, flow)
    system = System(flow, travelled.start, travelled.size)
    plane = Plane(system, axes, _limits(asked, travelled, flow, axes), travelled.end, {})
    picture = Picture(plane)
    notes = [*flow.notes, *(f"conserved: {text}" for text in system.law_texts)]
    if not plane.is_whole:
        _only_a_section(plane, travelled, picture, notes)
    if len(travelled.passed):
        picture.add_run(travelled.passed[axes[0]], travelled.passed[axes[1]])
    begun = [[one.get(flow.names[k], travelled.start[k]) for k in axes] for one in asked.starts]
    if begun:
        picture.add_orbits((np.array(begun).T - plane.corner) / plane.extent)
    is_partial = False
    if plane.is_whole:
        progress(None, "manifolds", _result(subject, picture, notes))
        picture.add_manifolds()
        if asked.has_basins:
            starts = spread(*travelled.box(), _STARTS)
            picture.beyond = search(system, [travelled.end, *starts], {}).states
            so_far = _result(subject, picture, notes)
            is_partial = not picture.add_basins(lambda part: progress(part, "basins", so_far))
    if travelled.problem:
        notes.append(f"the run ended early: {travelled.problem}")
    result = _result(subject, picture, notes)
    result.is_partial = is_partial
    result.live = LivePlane(picture)
    return result


def _axes(asked: Asked, travelled: Travelled, flow: Flow) -> tuple[int, int]:
    """Return the two states: those asked for, of dispxy, displayed, or the first two."""
    if asked.names is not None:
        first, second = asked.names
        return flow.names.index(first), flow.names.index(second)
    wanted = [*travelled.across, *asked.limits, *travelled.shown, *flow.names]
    first, second, *_ = dict.fromkeys(name for name in wanted if name in flow.names)
    return flow.names.index(first), flow.names.index(second)


def _limits(
    asked: Asked, travelled: Travelled, flow: Flow, axes: tuple[int, int]
) -> tuple[float, float, float, float]:
    """Return what is asked for, else somewhat more than the run passes."""
    found: list[float] = []
    for k in axes:
        low, high = float(travelled.low[k]), float(travelled.high[k])
        room = _MARGIN * (high - low) or max(abs(high), 1.0)
        found += asked.limits.get(flow.names[k], (low - room, high + room))
    return found[0], found[1], found[2], found[3]


def _only_a_section(plane: Plane, travelled: Travelled, picture: Picture, notes: list[str]) -> None:
    """More than two states: find the steady states of all, and say what the picture cannot show."""
    system = plane.system
    found = search(system, [travelled.end, travelled.start, *spread(*travelled.box(), _STARTS)], {})
    picture.take_rests(found.states)
    names = system.flow.names
    held = [f"{name} = {travelled.end[k]:.5g}" for k, name in enumerate(names) if k not in plane.axes]
    shown_held = ", ".join(held[:6]) + (", …" if len(held) > 6 else "")
    notes.append(
        f"field and nullclines are those with {shown_held}, where the run ended; orbits leave this plane. "
        "Steady states are those of all states"
    )


def _result(subject: Subject, picture: Picture, notes: list[str]) -> Result:
    plane, states = picture.plane, picture.rests
    names = plane.system.flow.names
    columns: dict[str, list[object]] = {"kind": [s.kind for s in states]}
    columns |= {name: [float(s.x[k]) for s in states] for k, name in enumerate(names)}
    columns["eigenvalues"] = [shown(s.eigenvalues) for s in states]
    x_name, y_name = plane.names
    lines = [plane.values(line) for line in picture.nullclines]
    values = {
        "states": {name: np.array([s.x[k] for s in states]) for k, name in enumerate(names)},
        "kinds": [s.kind for s in states],
        "nullclines": {x_name: lines[0], y_name: lines[1]},
        "basins": picture.basin_parts,
    }
    found = tables("steady states", columns, names, plane.names)
    told = list(notes)
    if not states:
        found = []
        told.append("no steady state is within the limits")
    if len(picture.basin_parts) > 1:
        parts = picture.basin_parts
        found.append(Table("basins", {"orbits go": list(parts), "part of the plane": list(parts.values())}))
    elif parts_one := picture.basin_parts:
        told.append(f"all orbits of the plane go {next(iter(parts_one))}".replace("go runs off", "run off"))
    return Result(
        f"Phase plane of {x_name} and {y_name}, {subject.name}", values, found, [picture.chart()], told
    )
