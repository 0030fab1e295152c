"""Curves of folds and Hopf points, of folds of cycles and period doublings, over two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.branches import Branch
from desire_tui.analysis.continuation.curve import Point, point_at, tangent_at
from desire_tui.analysis.continuation.cycle_curve import Cycle
from desire_tui.analysis.continuation.cycle_event_curve import CycleEventCurve
from desire_tui.analysis.continuation.fold_curve import FoldCurve
from desire_tui.analysis.continuation.hopf_curve import HopfCurve
from desire_tui.analysis.continuation.walk import walk

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Diagram, Kind, Special
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.continuation.walk import End
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_EventCurve = FoldCurve | HopfCurve | CycleEventCurve
KINDS: tuple[Kind, ...] = ("fold", "Hopf", "fold of cycles", "period doubling")
"""Special points that are curves over two parameters."""
POINTS_MOST = 500
_FAR = 1e3
_STEP = 0.05
_BESIDE = 5e-3
_FLAT = 1e-6


def trace(
    system: System, over: tuple[Range, Range], second: float, special: Special, diagram: Diagram,
    go_on: Callable[[str], bool],
) -> None:  # fmt: skip
    """Follow the curve through a fold, a Hopf point … of a one-parameter diagram, both ways.

    `second` is the value that the second parameter has there. The curve is added to the diagram as a branch.
    """
    name = f"{special.kind} {special.number}"
    branch = Branch(len(diagram.branches) + 1, kind_of(special), name)
    diagram.branches.append(branch)
    begun = _begun(system, over, special, over[1].part(second))
    if begun is None:
        diagram.notes.append(f"from {name} no curve over {over[1].name} is found")
        return
    curve, first = begun
    branch.points = [first]
    forward = _walk(curve, first, branch, diagram, go_on, 1)
    if forward == "closed" or diagram.is_partial:
        branch.ends = (forward, forward)
        return
    curve, first = _begun(system, over, special, over[1].part(second)) or begun
    back = Point(first.u, -first.tangent, dict(first.tests), first.facts)
    branch.ends = (_walk(curve, back, branch, diagram, go_on, -1), forward)


def kind_of(special: Special) -> Kind:
    """Return which curve goes through a special point."""
    for kind in KINDS:
        if special.kind == kind:
            return kind
    raise ValueError(special.kind)


def _begun(
    system: System, over: tuple[Range, Range], special: Special, part: float
) -> tuple[_EventCurve, Point] | None:
    """Return the curve through a special point, and its first point."""
    curve: _EventCurve
    u, kind = special.point.u, kind_of(special)
    if kind == "fold of cycles" or kind == "period doubling":  # noqa: PLR1714 - so that mypy knows which
        cycle = special.point.facts
        curve = CycleEventCurve(system, over, cycle.mesh, cycle.nodes.T, kind)
        start = np.append(u, part)
        ways = np.eye(len(start))[[-1, -2]]
    else:
        z, parts = u[:-1], (float(u[-1]), part)
        if kind == "fold":
            curve = FoldCurve(system, over, z, parts)
        else:
            curve = HopfCurve(system, over, z, parts, special.values["omega"])
        start = curve.first
        ways = np.linalg.svd(curve.matrix(start))[2][-1:]
    for way in ways:
        try:
            tangent = tangent_at(curve, curve.matrix(start), way)
        except np.linalg.LinAlgError:
            continue
        first = point_at(curve, start, tangent)
        if first is not None:
            return curve, first
    return None


def is_passed(diagram: Diagram, special: Special, second: float) -> bool:
    """Whether a curve of its kind passes a point already, with this part of the second parameter."""
    place = _place(special.point, np.append(special.point.u[-1:], second))
    for branch in diagram.branches:
        if branch.kind == special.kind and len(branch.points) > 1:
            u = np.array([_place(point, point.u[-2:], len(place)) for point in branch.points])
            chords = np.diff(u, axis=0)
            along = np.sum((place - u[:-1]) * chords, axis=1) / np.maximum(np.sum(chords**2, axis=1), 1e-300)
            nearest = u[:-1] + np.clip(along, 0.0, 1.0)[:, None] * chords
            if np.linalg.norm(nearest - place, axis=1).min() < _BESIDE:
                return True
    return False


def _place(point: Point, parts: Floats, count: int = 0) -> Floats:
    """Return a steady state, or a cycle's size and logarithm of its period, and both parts."""
    if isinstance(point.facts, Cycle):
        nodes = point.facts.nodes
        size = [nodes.max(axis=1), nodes.min(axis=1), [np.log(point.facts.period)]]
        return np.concatenate([*size, parts])
    return np.concatenate([point.u[: count - 2 if count else len(point.u) - 1], parts])


def _walk(
    curve: _EventCurve,
    first: Point,
    branch: Branch,
    diagram: Diagram,
    go_on: Callable[[str], bool],
    sign: int,
) -> End:
    end: End = ""
    for step in walk(curve, first, points_most=POINTS_MOST, is_far=_is_far, step_most=_STEP):
        new = []
        for name, place in step.zeros:
            found = diagram.special(name, branch.number, place)
            if isinstance(place.facts, Cycle):
                found.values = {"period": place.facts.period}
                found.details = f"period {place.facts.period:.6g}"
            new.append(place)
        end = step.end
        if end == "bound" and isinstance(curve, HopfCurve) and abs(float(step.point.u[-3])) < _FLAT:
            diagram.special("Bogdanov-Takens", branch.number, step.point)
        new.append(step.point)
        branch.points = branch.points + new if sign > 0 else [*reversed(new), *branch.points]
        told = ", ".join(f"{name} = {value:.5g}" for name, value in curve.p(step.point.u).items())
        if not end and not go_on(f"curve of {branch.origin}, {told}"):
            diagram.is_partial = True
            return "stopped"
    return end


def _is_far(point: Point) -> bool:
    return bool(np.abs(point.u).max() > _FAR)
