"""A phase plane that follows sliders, and orbits that begin where one points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.phase_plane.picture import Picture

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.analysis.equilibria.search import Steady
    from desire_tui.analysis.phase_plane.plane import Plane
    from desire_tui.engine.graph.chart import Chart


class LivePlane:
    """Makes charts of a plane at other parameters: field, nullclines, steady states, orbits; no basins.

    To be called from one thread at a time.
    """

    def __init__(self, plane: Plane, rests: Sequence[Steady] | None) -> None:
        """`rests` are steady states that are drawn as they are; None: they are found in the plane."""
        self._plane, self._rests = plane, rests
        self._picture: Picture | None = None
        self._starts: list[tuple[float, float]] = []

    def moved(self, values: Mapping[str, float]) -> Chart:
        """Return the chart with these parameters; orbits that were begun go on from where they began."""
        known = {name: value for name, value in values.items() if name in self._plane.system.flow.parameters}
        self._picture = picture = Picture(self._plane.at(known))
        if self._rests is not None:
            picture.take_rests(self._rests)
        if self._starts:
            picture.add_orbits(self._places())
        return picture.chart()

    def started(self, x: float, y: float) -> Chart:
        """Return the chart with one more orbit, which begins at values of the two states."""
        self._starts.append((x, y))
        picture = self._picture or Picture(self._plane)
        return self.moved(picture.plane.p)

    def _places(self) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        plane = self._plane
        found = (np.array(self._starts).T - plane.corner) / plane.extent
        return np.asarray(found).reshape(2, -1)
