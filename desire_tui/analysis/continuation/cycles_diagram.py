"""Branches of limit cycles: from Hopf points and a run's cycle, with those that begin and cross on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.analysis.continuation.branches import Branch
from desire_tui.analysis.continuation.curve import Point
from desire_tui.analysis.continuation.cycle_curve import Cycle
from desire_tui.analysis.continuation.cycle_starts import from_branch_point, from_doubling, from_hopf
from desire_tui.analysis.continuation.walk import walk

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Diagram, Special
    from desire_tui.analysis.continuation.cycle_curve import CycleCurve
    from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve
    from desire_tui.analysis.continuation.multipliers import Multipliers
    from desire_tui.analysis.continuation.walk import End

    Floats = NDArray[np.float64]

POINTS_MOST = 300
BRANCHES_MOST = 24
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
_AT_BRANCH_POINT = 1e-3

NAMES = {
    "fold": "fold of cycles", "period doubling": "period doubling", "torus": "torus",
    "cycle branch": "branch point of cycles",
}  # fmt: skip


class _Birth(NamedTuple):
    """Where another branch begins: the point, and the curve of cycles as it is there."""

    special: Special
    curve: CycleCurve
    place: Point


class CyclesTracer:
    """Follows branches of cycles; `go_on(told)` is asked at each step, and False ends it there."""

    def __init__(self, curve: EquilibriumCurve, diagram: Diagram, go_on: Callable[[str], bool]) -> None:
        self._steady, self._diagram, self._go_on = curve, diagram, go_on
        self._ended: set[int] = set()
        """Numbers of Hopf points at which a branch of cycles has ended."""
        self._crossed: set[int] = set()
        """Numbers of branch points whose other branch has come by."""

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
        """Follow a branch of cycles one way, and then what begins at period doublings and branch points."""
        branch = self._begin(origin, first)
        births: list[_Birth] = []
        branch.ends = ("", self._walk(curve, first, branch, hopf, births))
        for birth in births:
            self._branch_off(birth, depth)

    def _begin(self, origin: str, first: Point) -> Branch:
        branch = Branch(len(self._diagram.branches) + 1, "cycle", origin, [first])
        self._diagram.branches.append(branch)
        return branch

    def _branch_off(self, birth: _Birth, depth: int) -> None:
        """Follow what begins at a period doubling one way, at a branch point both ways."""
        diagram, special = self._diagram, birth.special
        origin = f"{special.kind} {special.number}"
        if special.kind == "period doubling":
            begun = from_doubling(birth.curve, birth.place) if depth < DOUBLINGS_MOST else None
            if begun is not None and self._has_room:
                self.follow(*begun, origin, None, depth + 1)
            return
        for sign in (1.0, -1.0):
            if special.number in self._crossed or not self._has_room:
                return
            begun = from_branch_point(birth.curve, birth.place, sign)
            if begun is None:
                diagram.notes.append(f"at {origin} the other branch is not found")
                return
            self.follow(*begun, origin, None, depth)
            if diagram.branches[-1].ends[1] == "closed":
                return

    @property
    def _has_room(self) -> bool:
        if self._diagram.is_partial:
            return False
        full = sum(branch.kind == "cycle" for branch in self._diagram.branches) >= BRANCHES_MOST
        told = f"more than {BRANCHES_MOST} branches of cycles: the rest is left out"
        if full and told not in self._diagram.notes:
            self._diagram.notes.append(told)
        return not full

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
        births: list[_Birth],
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
            ends = [place for _, place in step.zeros if amplitude(place) < _SMALL]
            if was_large and ends:
                self._end_at_hopf(curve, ends[0])
                branch.points.append(ends[0])
                return "hopf"
            # where another branch crosses and this one turns at once, the crossing counts
            for name, place in sorted(step.zeros, key=lambda zero: zero[0] == "fold"):
                if not _is_event(name, place.facts.multipliers) or self._is_known(name, branch, place):
                    continue
                branch.points.append(place)
                found = self._diagram.special(NAMES[name], branch.number, place)
                found.values = {"period": place.facts.period}
                found.details = f"period {place.facts.period:.6g}"
                if name in ("period doubling", "cycle branch"):
                    mesh = type(curve)(curve.system, curve.over, place.facts.mesh, curve.nodes(place.u))
                    births.append(_Birth(found, mesh, place))
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

    def _is_known(self, name: str, branch: Branch, place: Point) -> bool:
        """Whether a branch turns back or is crossed at a branch point that is known.

        Of a pitchfork, the branch that turns back there touches it: it has a fold and a crossing at once.
        """
        if name not in ("fold", "cycle branch"):
            return False
        for other in [s for s in self._diagram.specials if _is_same(s.point, place)]:
            if other.kind == NAMES["cycle branch"]:
                if other.branch != branch.number:
                    self._crossed.add(other.number)
                return True
            if other.kind == NAMES["fold"] and other.branch == branch.number:
                self._diagram.specials.remove(other)
        return False

    def _end_at_hopf(self, curve: CycleCurve, point: Point) -> None:
        """Take note at which Hopf point cycles have shrunk to nothing."""
        middle = np.append(curve.nodes(point.u).mean(axis=0), point.u[-1])
        for other in self._diagram.specials:
            if other.kind == "Hopf" and np.abs(other.point.u - middle).max() < _BORN_AT:
                self._ended.add(other.number)


def _is_same(one: Point, other: Point) -> bool:
    """Whether two points are the same cycle, whatever its phase."""
    if not (isinstance(one.facts, Cycle) and isinstance(other.facts, Cycle)):
        return False
    return bool(np.abs(_measures(one) - _measures(other)).max() < _AT_BRANCH_POINT)


def _measures(point: Point) -> Floats:
    nodes = point.facts.nodes
    return np.concatenate([point.u[-2:], nodes.max(axis=1), nodes.min(axis=1)])


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
