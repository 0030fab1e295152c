"""Branches of limit cycles: from Hopf points, from period doublings, from a cycle that a run has come to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.branches import Branch
from desire_tui.analysis.continuation.curve import Point
from desire_tui.analysis.continuation.cycle_starts import from_doubling, from_hopf
from desire_tui.analysis.continuation.walk import walk

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.analysis.continuation.branches import Diagram, Special
    from desire_tui.analysis.continuation.cycle_curve import CycleCurve
    from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve
    from desire_tui.analysis.continuation.multipliers import Multipliers
    from desire_tui.analysis.continuation.walk import End

POINTS_MOST = 300
DOUBLINGS_MOST = 2
"""A cascade has infinitely many: so many are followed one after the other."""
_STEP = 0.1
_LONG, _LONGEST = 15.0, 500.0
"""Periods so many times that at the start are homoclinic: if the parameter stands still, or in any case."""
_STANDS = 1e-8
_SMALL = 0.01
_LARGE = 100.0
"""A cycle so many times larger than what the run shows of the states is of no interest."""
_ON_CIRCLE = 1e-4
_BORN_AT = 0.02

NAMES = {
    "fold": "fold of cycles", "period doubling": "period doubling", "torus": "torus",
    "cycle branch": "branch point of cycles",
}  # fmt: skip


class CyclesTracer:
    """Follows branches of cycles; `go_on(told)` is asked at each step, and False ends it there."""

    def __init__(self, curve: EquilibriumCurve, diagram: Diagram, go_on: Callable[[str], bool]) -> None:
        self._steady, self._diagram, self._go_on = curve, diagram, go_on
        self._ended: set[int] = set()
        """Numbers of Hopf points at which a branch of cycles has ended."""

    def trace(self) -> None:
        """Follow the cycles of all Hopf points found."""
        for hopf in [s for s in self._diagram.specials if s.kind == "Hopf"]:
            if self._diagram.is_partial:
                return
            if hopf.number in self._ended:
                continue
            begun = from_hopf(self._steady, hopf.point.u, hopf.values["omega"])
            if begun is None:
                self._diagram.notes.append(f"at Hopf {hopf.number} no cycle is found")
                continue
            self.follow(*begun, f"Hopf {hopf.number}", hopf)

    def follow(
        self, curve: CycleCurve, first: Point, origin: str, hopf: Special | None = None, depth: int = 0
    ) -> None:
        """Follow a branch of cycles one way, and then what is born at its period doublings."""
        diagram = self._diagram
        branch = Branch(len(diagram.branches) + 1, "cycle", origin, [first])
        diagram.branches.append(branch)
        doublings: list[tuple[Special, CycleCurve, Point]] = []
        branch.ends = ("", self._walk(curve, first, branch, hopf, doublings))
        if depth >= DOUBLINGS_MOST or diagram.is_partial:
            return
        for special, mesh, place in doublings:
            begun = from_doubling(mesh, place)
            if begun is not None and not diagram.is_partial:
                self.follow(*begun, f"period doubling {special.number}", None, depth + 1)

    def both_ways(self, curve: CycleCurve, first: Point, origin: str) -> None:
        """Follow a branch of cycles from one of them to both sides."""
        self.follow(curve, first, origin)
        if self._diagram.is_partial or self._diagram.branches[-1].ends[1] == "closed":
            return
        back = Point(first.u, -first.tangent, dict(first.tests), first.facts)
        for name in ("fold", "cycle branch"):
            back.tests[name] = -back.tests.get(name, 0.0)
        again = type(curve)(curve.system, curve.over, first.facts.mesh, curve.nodes(first.u))
        self.follow(again, back, origin)

    def _walk(
        self,
        curve: CycleCurve,
        first: Point,
        branch: Branch,
        hopf: Special | None,
        doublings: list[tuple[Special, CycleCurve, Point]],
    ) -> End:
        period = first.facts.period
        was_large = hopf is None
        end: End = ""
        for step in walk(
            curve,
            first,
            points_most=POINTS_MOST,
            step_most=_STEP,
            is_far=lambda p: amplitude(p) > _LARGE or _is_homoclinic(p, period),
        ):
            for name, place in step.zeros:
                if not _is_event(name, place.facts.multipliers):
                    continue
                branch.points.append(place)
                found = self._diagram.special(NAMES[name], branch.number, place)
                found.values = {"period": place.facts.period}
                found.details = f"period {place.facts.period:.6g}"
                if name == "period doubling":
                    mesh = type(curve)(curve.system, curve.over, place.facts.mesh, curve.nodes(place.u))
                    doublings.append((found, mesh, place))
            branch.points.append(step.point)
            end = step.end
            size = amplitude(step.point)
            if not end and was_large and size < _SMALL:
                self._end_at_hopf(curve, step.point)
                return "hopf"
            was_large = was_large or size > 5.0 * _SMALL
            value = curve.over.value(float(step.point.u[-1]))
            if not end and not self._go_on(f"cycles of {branch.origin}, {curve.over.name} = {value:.5g}"):
                self._diagram.is_partial = True
                return "stopped"
        if end == "far" and amplitude(branch.points[-1]) > _LARGE:
            value = curve.over.value(float(branch.points[-1].u[-1]))
            self._diagram.notes.append(
                f"the cycles of {branch.origin} grow without bound near {curve.over.name} = {value:.8g}; "
                "where all have the same parameter, it is a centre: every orbit there is a cycle"
            )
            return "far"
        if end == "far":
            value = curve.over.value(float(branch.points[-1].u[-1]))
            self._diagram.notes.append(
                f"the cycles of {branch.origin} end at {curve.over.name} = {value:.8g}, where their period "
                "grows without bound: an orbit that begins and ends at saddles"
            )
            return "homoclinic"
        return end

    def _end_at_hopf(self, curve: CycleCurve, point: Point) -> None:
        """Take note at which Hopf point cycles have shrunk to nothing."""
        middle = np.append(curve.nodes(point.u).mean(axis=0), point.u[-1])
        for other in self._diagram.specials:
            if other.kind == "Hopf" and np.abs(other.point.u - middle).max() < _BORN_AT:
                self._ended.add(other.number)


def amplitude(point: Point) -> float:
    """Return how large a cycle is, in scaled coordinates."""
    nodes = point.facts.nodes
    return float(np.ptp(nodes, axis=1).max()) / 2.0


def _is_homoclinic(point: Point, period: float) -> bool:
    ratio = point.facts.period / period
    return bool(ratio > _LONGEST or (ratio > _LONG and abs(float(point.tangent[-1])) < _STANDS))


def _is_event(name: str, found: Multipliers) -> bool:
    """Whether a multiplier is where the test says, and not rounding."""
    if not found.is_exact:
        return False
    if name == "period doubling":
        return bool(np.abs(found.others + 1.0).min() < _ON_CIRCLE)
    if name == "torus":
        on = np.abs(np.abs(found.others) - 1.0) < _ON_CIRCLE
        return bool(np.any(on & (np.abs(found.others.imag) > _ON_CIRCLE)))
    return True
