"""What is drawn of a phase plane: at once for a parameter that moves, all of it in the end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.search import search
from desire_tui.analysis.marks import marks
from desire_tui.analysis.phase_plane.basins import GOES_ROUND, RUNS_OFF, basins
from desire_tui.analysis.phase_plane.nullclines import Grid, arrows
from desire_tui.analysis.phase_plane.orbits import joined, manifolds, orbits
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.search import Steady
    from desire_tui.analysis.marks import Shape
    from desire_tui.analysis.phase_plane.plane import Plane
    from desire_tui.engine.graph.chart import Look

    Floats = NDArray[np.float64]

_FIELD, _FIRST, _SECOND, _STABLE, _UNSTABLE, _ORBIT = 8, 14, 11, 10, 12, 15
_BASINS = (1, 2, 5, 3, 6, 4)
_OFF, _ROUND = 4, 7
_STABLE_MARK, _UNSTABLE_MARK, _OTHER_MARK = 10, 12, 13
_LIVE_LENGTH, _LIVE_STEP = 6.0, 1.0 / 80.0
_LENGTH = 12.0
_EDGE = 1e-9


class Picture:
    """Of a plane at its parameters: field, nullclines and steady states are found when it is made."""

    def __init__(self, plane: Plane) -> None:
        self.plane = plane
        with np.errstate(all="ignore"):
            grid = Grid(plane)
            self.field = arrows(plane)
            self.nullclines = [grid.nullcline(0), grid.nullcline(1)]
            self.rests = self._rests(grid) if plane.is_whole else []
        self._curves: list[Series] = []
        self._ground: list[Series] = []
        self.beyond: Sequence[Steady] = ()
        """Steady states outside the limits, to which orbits may go too."""
        self.basin_parts: dict[str, float] = {}
        """What part of the plane each attractor's basin has."""

    def _rests(self, grid: Grid) -> list[Steady]:
        """Return the steady states within the limits."""
        plane = self.plane
        starts = plane.states(grid.cells_at_rest()).T
        found = search(plane.system, starts, plane.p, within=lambda x: self._is_inside(x[:, None]))
        return found.states

    def take_rests(self, states: Sequence[Steady]) -> None:
        """Mark steady states that were found elsewhere, those within the limits."""
        self.rests = [s for s in states if self._is_inside(s.x[:, None])]

    def _is_inside(self, x: Floats) -> bool:
        place = self.plane.place(x)
        return bool(np.all((place > -1e-9) & (place < 1.0 + 1e-9)))

    def places_of(self, kinds: Sequence[str] | None = None) -> Floats:
        """Return where steady states are, of some kinds or of all, 2 by count."""
        chosen = [s.x for s in self.rests if kinds is None or s.kind in kinds]
        return self.plane.place(np.array(chosen).T) if chosen else np.empty((2, 0))

    def add_manifolds(self) -> None:
        """Find the manifolds of the saddles."""
        with np.errstate(all="ignore"):
            ways = manifolds(self.plane, self.places_of(["saddle"]), self.places_of(), length=_LENGTH)
        for name, way, color in (("unstable", ways[0], _UNSTABLE), ("stable", ways[1], _STABLE)):
            if way.shape[1]:
                self._curves.append(self._series(f"{name} manifold", way, "line", color))

    def add_basins(self, go_on: Callable[[float], bool]) -> bool:
        """Find the basins, if there are several attractors. False: stopped."""
        outside = [s for s in self.beyond if not self._is_inside(s.x[:, None])]
        stable = [s for s in [*self.rests, *outside] if s.kind.startswith("stable")]
        places = self.plane.place(np.array([s.x for s in stable]).reshape(-1, len(self.plane.held)).T)
        with np.errstate(all="ignore"):
            found = basins(self.plane, places, go_on)
        if found is None:
            return False
        grid, ends = found
        x_name, y_name = self.plane.names
        a, b = self.plane.axes
        names = {k: f"to {x_name} = {s.x[a]:.4g}, {y_name} = {s.x[b]:.4g}" for k, s in enumerate(stable)}
        names |= {RUNS_OFF: "runs off", GOES_ROUND: "to no steady state"}
        present = [k for k in names if np.any(ends == k)]
        self.basin_parts = {names[k]: float(np.mean(ends == k)) for k in present}
        if len(present) > 1:
            for k in present:
                color = _OFF if k == RUNS_OFF else _ROUND if k == GOES_ROUND else _BASINS[k % len(_BASINS)]
                self._ground.append(self._series("", grid[:, ends == k], "points", color))
        return True

    def add_orbits(self, places: Floats) -> None:
        """Draw orbits from places, 2 by count, forwards."""
        with np.errstate(all="ignore"):
            signs = np.ones(places.shape[1])
            followed = orbits(
                self.plane, places, signs, self.places_of(), length=_LIVE_LENGTH, step=_LIVE_STEP
            )
        self._curves.append(self._series("", joined(followed), "line", _ORBIT))

    def add_run(self, x: Floats, y: Floats) -> None:
        """Draw the program's own run."""
        places = (np.vstack([x, y]) - self.plane.corner) / self.plane.extent
        self._curves.append(self._series("run", places, "line", _ORBIT))

    def chart(self) -> Chart:
        """Return all that is known as a graph."""
        x_name, y_name = self.plane.names
        series = [*self._ground, self._series("", self.field, "line", _FIELD)]
        for name, line, color in zip((x_name, y_name), self.nullclines, (_FIRST, _SECOND), strict=True):
            if line.shape[1]:
                series.append(self._series(f"{name} stands still", line, "line", color))
        series += self._curves
        for kind in dict.fromkeys(s.kind for s in self.rests):
            shape, color = _mark(kind)
            series.append(self._series(kind, marks(shape, self.places_of([kind])), "line", color))
        return Chart(
            f"Phase plane of {x_name} and {y_name}", x_name, y_name, series, limits=self.plane.limits
        )

    def _series(self, name: str, places: Floats, look: Look, color: int) -> Series:
        is_inside = np.all((places >= -_EDGE) & (places <= 1.0 + _EDGE), axis=0)
        x, y = self.plane.values(np.where(is_inside, np.clip(places, 0.0, 1.0), np.nan))
        return Series(name, x, y, look, color=color)


def _mark(kind: str) -> tuple[Shape, int]:
    """Return shape and colour: nodes are square, foci round, saddles crosses; what is stable is filled."""
    if kind.startswith("saddle"):
        return "cross", _OTHER_MARK
    if kind.startswith("stable"):
        return ("block" if kind.endswith("node") else "disc"), _STABLE_MARK
    if kind.startswith("unstable"):
        return ("square" if kind.endswith("node") else "circle"), _UNSTABLE_MARK
    return ("circle" if kind.startswith("centre") else "diamond"), _OTHER_MARK
