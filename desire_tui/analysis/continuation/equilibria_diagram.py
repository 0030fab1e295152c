"""All branches of steady states that hang together with those at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.continuation.branches import Branch
from desire_tui.analysis.continuation.curve import Point, point_at
from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve, turning_pair
from desire_tui.analysis.continuation.lyapunov import first_lyapunov
from desire_tui.analysis.continuation.switching import exact_branch_point, other_tangent
from desire_tui.analysis.continuation.walk import walk
from desire_tui.analysis.equilibria.search import is_same
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Diagram, Special
    from desire_tui.analysis.continuation.walk import End

    Floats = NDArray[np.float64]

BRANCHES_MOST = 30
POINTS_MOST = 2000
_FAR = 1e3
_AT_MARK = 1e-9
_AT_BRANCH_POINT = 1e-4
"""Two branch points nearer to one another are one; folds nearer than this to one are its own."""


@dataclass
class _Seed:
    """Where a branch begins: a point, its tangent, what it comes from."""

    u: Floats
    tangent: Floats
    origin: str


class EquilibriaTracer:
    """Follows branches from steady states at one parameter value; each is followed once.

    `go_on(told)` is asked at each step, and False ends it with what there is.
    """

    def __init__(self, curve: EquilibriumCurve, diagram: Diagram, go_on: Callable[[str], bool]) -> None:
        self._curve, self._diagram, self._go_on = curve, diagram, go_on
        self._marks: list[Floats] = []
        """Where branches pass the parameter's value at the start."""

    def trace(self, starts: Iterable[Floats], part: float) -> None:
        """Follow the branches through steady states z at a part of the parameter's range."""
        for z in starts:
            if any(is_same(z, mark) for mark in self._marks):
                continue
            seeds = [self._seed(z, part)]
            while seeds and not self._diagram.is_partial:
                seed = seeds.pop(0)
                if self._is_followed(seed):
                    continue
                if len(self._diagram.branches) == BRANCHES_MOST:
                    self._diagram.notes.append(f"more than {BRANCHES_MOST} branches: the rest is left out")
                    return
                seeds += self._follow(seed)

    def _seed(self, z: Floats, part: float) -> _Seed:
        u = np.append(z, part)
        _, _, right = np.linalg.svd(self._curve.matrix(u))
        tangent = right[-1] * (1.0 if right[-1][-1] >= 0.0 else -1.0)
        self._marks.append(z)
        return _Seed(u, tangent, "steady state")

    def _is_followed(self, seed: _Seed) -> bool:
        """Whether a branch point's other branch has been followed from another one meanwhile."""
        crossings = {
            s.branch for s in self._diagram.specials
            if s.kind == "branch point" and np.abs(s.point.u - seed.u).max() < _AT_BRANCH_POINT
        }  # fmt: skip
        return len(crossings) > 1

    def _follow(self, seed: _Seed) -> list[_Seed]:
        curve, diagram = self._curve, self._diagram
        branch = Branch(len(diagram.branches) + 1, "steady", seed.origin)
        diagram.branches.append(branch)
        first = Point(seed.u, seed.tangent)
        curve.examine(first, curve.matrix(seed.u))
        if seed.origin == "steady state":
            first = point_at(curve, seed.u, seed.tangent) or first
        else:  # at the crossing the tests say nothing but for the ends
            first.tests = {name: first.tests[name] for name in curve.ends}
        branch.points = [first]
        seeds: list[_Seed] = []
        ends: list[End] = []
        for sign in (1.0, -1.0):
            start = Point(first.u, sign * first.tangent, dict(first.tests), first.facts)
            if "fold" in start.tests:
                start.tests |= {"fold": sign * start.tests["fold"], "branch": sign * start.tests["branch"]}
            if branch.ends == ("closed", "closed"):
                break
            ends.append(self._half(branch, start, sign, seeds))
            if ends == ["closed"]:
                branch.ends = ("closed", "closed")
                branch.points[-1] = first
        if branch.ends == ("", ""):
            branch.ends = (ends[1], ends[0])
        return seeds

    def _half(self, branch: Branch, start: Point, sign: float, seeds: list[_Seed]) -> End:
        end: End = ""
        for step in walk(self._curve, start, points_most=POINTS_MOST, is_far=_is_far):
            new = []
            for name, place in step.zeros:
                if name == "mark":
                    self._marks.append(place.u[:-1])
                elif self._note(branch, name, place, seeds):
                    new.append(place)
            new.append(step.point)
            branch.points = branch.points + new if sign > 0 else [*reversed(new), *branch.points]
            end = step.end
            mark = self._curve.mark
            if end == "bound" and mark is not None and abs(float(step.point.u[-1]) - mark) < _AT_MARK:
                self._marks.append(step.point.u[:-1])
            if not end and not self._go_on(self._told(branch, step.point)):
                self._diagram.is_partial = True
                return "stopped"
        return end

    def _told(self, branch: Branch, point: Point) -> str:
        over = self._curve.over
        return f"branch {branch.number}, {over.name} = {over.value(float(point.u[-1])):.5g}"

    def _note(self, branch: Branch, name: str, place: Point, seeds: list[_Seed]) -> bool:
        """Add a special point if a test's zero is one."""
        if name == "hopf":
            return self._hopf(branch, place)
        if name == "branch":
            exact = exact_branch_point(self._curve, place.u)
            if exact is None:
                return False
            place.u = exact
            self._curve.examine(place, self._curve.matrix(exact))
        near = [
            s for s in self._diagram.specials
            if s.branch == branch.number and np.abs(s.point.u - place.u).max() < _AT_BRANCH_POINT
        ]  # fmt: skip
        if name == "fold":
            if any(s.kind == "branch point" for s in near):
                return False
            self._diagram.special("fold", branch.number, place)
            return True
        if any(s.kind == "branch point" for s in near):
            return False
        for fold in [s for s in near if s.kind == "fold"]:  # where the branch only touches the other one
            self._diagram.specials.remove(fold)
        found = self._diagram.special("branch point", branch.number, place)
        tangent = other_tangent(self._curve, place.u, place.tangent)
        if tangent is not None:
            seeds.append(_Seed(place.u, tangent, f"branch point {found.number}"))
        return True

    def _hopf(self, branch: Branch, place: Point) -> bool:
        pair = turning_pair(place.facts.eigenvalues)
        if pair is None:
            return False
        found = self._diagram.special("Hopf", branch.number, place)
        describe_hopf(self._curve, found, pair[1])
        return True


def describe_hopf(curve: EquilibriumCurve, found: Special, omega: float) -> None:
    """Put period and first Lyapunov coefficient into a Hopf point."""
    u = found.point.u
    l1 = first_lyapunov(curve.system, u[:-1], curve.p(u), omega)
    found.values = {"period": 2.0 * np.pi / omega, "omega": omega, "lyapunov": l1}
    born = "supercritical" if l1 < 0.0 else "subcritical"
    found.details = f"{born}, period {2.0 * np.pi / omega:.6g}"


def _is_far(point: Point) -> bool:
    return bool(np.abs(point.u[:-1]).max() > _FAR)
