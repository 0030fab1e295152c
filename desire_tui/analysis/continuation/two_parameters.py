"""Curves of folds and of Hopf points over two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.branches import Branch
from desire_tui.analysis.continuation.curve import Point, point_at
from desire_tui.analysis.continuation.fold_curve import FoldCurve
from desire_tui.analysis.continuation.hopf_curve import HopfCurve
from desire_tui.analysis.continuation.walk import walk

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Diagram, Special
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.continuation.walk import End
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

POINTS_MOST = 500
_FAR = 1e3
_STEP = 0.05
_BESIDE = 5e-3
_FLAT = 1e-6


def trace(
    system: System, over: tuple[Range, Range], second: float, special: Special, diagram: Diagram,
    go_on: Callable[[str], bool],
) -> None:  # fmt: skip
    """Follow the curve through a fold or a Hopf point of a one-parameter diagram, both ways.

    `second` is the value that the second parameter has there. The curve is added to the diagram as a branch.
    """
    z, parts = special.point.u[:-1], (float(special.point.u[-1]), over[1].part(second))
    curve: FoldCurve | HopfCurve
    if special.kind == "fold":
        curve = FoldCurve(system, over, z, parts)
    else:
        curve = HopfCurve(system, over, z, parts, special.values["omega"])
    name = f"{special.kind} {special.number}"
    branch = Branch(len(diagram.branches) + 1, "fold" if special.kind == "fold" else "Hopf", name)
    diagram.branches.append(branch)
    tangent = np.linalg.svd(curve.matrix(curve.first))[2][-1]
    first = point_at(curve, curve.first, tangent)
    if first is None:
        diagram.notes.append(f"from {name} no curve over {over[1].name} is found")
        return
    branch.points = [first]
    forward = _walk(curve, first, branch, diagram, go_on, 1)
    if forward == "closed" or diagram.is_partial:
        branch.ends = (forward, forward)
        return
    curve.adapted(first)
    back = Point(first.u, -first.tangent, dict(first.tests), first.facts)
    branch.ends = (_walk(curve, back, branch, diagram, go_on, -1), forward)


def is_passed(diagram: Diagram, special: Special, second: float) -> bool:
    """Whether a curve of its kind passes a point already, with this part of the second parameter."""
    z, part = special.point.u[:-1], float(special.point.u[-1])
    place = np.concatenate([z, [part, second]])
    for branch in diagram.branches:
        if branch.kind == special.kind and len(branch.points) > 1:
            u = np.array([np.concatenate([p.u[: len(z)], p.u[-2:]]) for p in branch.points])
            chords = np.diff(u, axis=0)
            along = np.sum((place - u[:-1]) * chords, axis=1) / np.maximum(np.sum(chords**2, axis=1), 1e-300)
            nearest = u[:-1] + np.clip(along, 0.0, 1.0)[:, None] * chords
            if np.linalg.norm(nearest - place, axis=1).min() < _BESIDE:
                return True
    return False


def _walk(
    curve: FoldCurve | HopfCurve,
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
            diagram.special(name, branch.number, place)
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
