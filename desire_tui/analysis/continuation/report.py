"""A diagram as tables, charts, notes and values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.continuation.cycle_curve import Cycle
from desire_tui.analysis.continuation.pictures import charts
from desire_tui.analysis.equilibria.kinds import is_stable, shown
from desire_tui.analysis.equilibria.listed import tables
from desire_tui.analysis.result import Result, Table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.branches import Diagram, Special
    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.continuation.walk import End
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_ENDS: dict[End, str] = {
    "bound": "limit", "far": "runs off", "lost": "no further step", "closed": "closed", "many": "many points",
    "stopped": "stopped", "hopf": "Hopf", "homoclinic": "homoclinic", "": "begins",
}  # fmt: skip
_ROUNDING = 1e-12
_WHAT = {
    "steady": "steady states", "cycle": "cycles", "fold": "folds", "Hopf": "Hopf points",
    "fold of cycles": "folds of cycles", "period doubling": "period doublings",
}  # fmt: skip


class Report:
    """Makes results of what is found so far, and in the end; `states` are those to be drawn."""

    def __init__(self, title: str, system: System, over: Sequence[Range], states: Sequence[str]) -> None:
        self._title, self._system, self._over, self._states = title, system, over, states

    def result(self, diagram: Diagram, *, draws: bool = True) -> Result:
        """Return all that is known of a diagram."""
        found = [*self._specials(diagram), self._branches(diagram)]
        points = Table("points", self._points(diagram), is_listed=False)
        drawn = charts(diagram, self._system, self._over, self._states) if draws else []
        flow = self._system.flow
        notes = [*flow.notes, *(f"conserved: {text}" for text in self._system.law_texts), *diagram.notes]
        return Result(
            self._title,
            self._values(diagram),
            [*found, points],
            drawn,
            notes,
            diagram.is_partial,
        )

    def _parts(self, point: Point) -> list[float]:
        """Return the parameters' values at a point."""
        parts = point.u[-len(self._over) :]
        return [one.value(float(part)) + 0.0 for one, part in zip(self._over, parts, strict=True)]

    def states(self, point: Point) -> Floats:
        """Return x at a point; of a cycle its largest and smallest values, 2 by n."""
        if isinstance(point.facts, Cycle):
            nodes = self._system.states(point.facts.nodes)
            x = np.array([nodes.max(axis=1), nodes.min(axis=1)])
        else:
            x = self._system.states(point.u[: len(self._system)])
        return np.where(np.abs(x) < _ROUNDING * self._system.size, 0.0, x)

    def _specials(self, diagram: Diagram) -> list[Table]:
        rows = [(s, self.states(s.point)) for s in diagram.specials]
        columns: dict[str, list[Any]] = {
            "point": [f"{s.kind} {s.number}" for s, _ in rows], "branch": [s.branch for s, _ in rows],
        }  # fmt: skip
        for k, one in enumerate(self._over):
            columns[one.name] = [self._parts(s.point)[k] for s, _ in rows]
        for k, name in enumerate(self._system.flow.names):
            columns[name] = [float(np.atleast_2d(x)[0][k]) for _, x in rows]
        columns["eigenvalues"] = [_eigenvalues(s) for s, _ in rows]
        columns["details"] = [s.details for s, _ in rows]
        title = "points where something changes (of cycles: largest values, multipliers)"
        return tables(title, columns, self._system.flow.names, self._states)

    def _branches(self, diagram: Diagram) -> Table:
        every = [b for b in diagram.branches if b.points]
        name = self._over[0].name
        return Table("branches", {
            "branch": [b.number for b in every], "of": [_WHAT[b.kind] for b in every],
            "from": [b.origin for b in every], "points": [len(b.points) for b in every],
            f"{name} from": [self._parts(b.points[0])[0] for b in every],
            f"{name} to": [self._parts(b.points[-1])[0] for b in every],
            "ends": [", ".join(_ENDS[end] for end in b.ends) for b in every],
        })  # fmt: skip

    def _points(self, diagram: Diagram) -> dict[str, list[Any]]:
        names = self._system.flow.names
        columns: dict[str, list[Any]] = {"branch": [], "of": [], **{one.name: [] for one in self._over}}
        columns |= {"stable": [], "period": [], **{name: [] for name in names}}
        columns |= {f"{name} min": [] for name in names}
        for branch in diagram.branches:
            for point in branch.points:
                x = np.atleast_2d(self.states(point))
                row = [branch.number, _WHAT[branch.kind], *self._parts(point), int(stable(point)),
                       period(point), *x[0].tolist(), *x[-1].tolist()]  # fmt: skip
                for column, value in zip(columns.values(), row, strict=True):
                    column.append(value)
        return columns

    def _values(self, diagram: Diagram) -> dict[str, Any]:
        names = self._system.flow.names
        branches = []
        for branch in diagram.branches:
            found: dict[str, Any] = {"number": branch.number, "of": branch.kind, "from": branch.origin}
            parts = np.array([self._parts(point) for point in branch.points]).reshape(-1, len(self._over))
            found |= {one.name: parts[:, k] for k, one in enumerate(self._over)}
            x = np.array([np.atleast_2d(self.states(point))[0] for point in branch.points])
            found |= {name: x[:, k] for k, name in enumerate(names) if len(x)}
            found["stable"] = np.array([stable(point) for point in branch.points])
            if branch.points and isinstance(branch.points[0].facts, Cycle):
                found["period"] = np.array([point.facts.period for point in branch.points])
                found["multipliers"] = np.array([point.facts.multipliers.values for point in branch.points])
            elif branch.points:
                found["eigenvalues"] = np.array([point.facts.eigenvalues for point in branch.points])
            branches.append(found)
        specials = []
        for s in diagram.specials:
            x = np.atleast_2d(self.states(s.point))[0]
            found = {"kind": s.kind, "number": s.number, "branch": s.branch, **s.values}
            found |= dict(zip((one.name for one in self._over), self._parts(s.point), strict=True))
            specials.append(found | dict(zip(names, x.tolist(), strict=True)))
        return {"points": specials, "branches": branches}


def stable(point: Point) -> bool:
    """Whether disturbances of a steady state or a cycle die out."""
    if isinstance(point.facts, Cycle):
        return bool(point.facts.unstable == 0)
    return is_stable(point.facts.eigenvalues)


def period(point: Point) -> float:
    """Return the period of a cycle, nan of anything else."""
    return point.facts.period if isinstance(point.facts, Cycle) else float("nan")


def _eigenvalues(special: Special) -> str:
    facts = special.point.facts
    return shown(facts.multipliers.values if isinstance(facts, Cycle) else facts.eigenvalues)
