"""A phase plane that follows sliders, and orbits that begin where one points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.phase_plane.picture import Picture

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.search import Steady
    from desire_tui.engine.graph.chart import Chart


class LivePlane:
    """Makes charts of a plane at other parameters: field, nullclines, steady states, orbits; no basins.

    To be called from one thread at a time.
    """

    def __init__(self, picture: Picture) -> None:
        """Begin with a picture, to which orbits are added until parameters change."""
        self._plane, self._picture = picture.plane, picture
        self._rests: Sequence[Steady] | None = None if picture.plane.is_whole else picture.rests
        """Steady states that are drawn as they are; None: they are found in the plane."""
        self._starts: list[tuple[float, float]] = []

    def moved(self, values: Mapping[str, float]) -> Chart:
        """Return the chart with these parameters; orbits that were begun go on from where they began."""
        known = {name: value for name, value in values.items() if name in self._plane.system.flow.parameters}
        self._picture = picture = Picture(self._plane.at(known))
        if self._rests is not None:
            picture.take_rests(self._rests)
        if self._starts:
            picture.add_orbits(self._places(self._starts))
        return picture.chart()

    def started(self, x: float, y: float) -> Chart:
        """Return the chart with one more orbit, which begins at values of the two states."""
        self._starts.append((x, y))
        self._picture.add_orbits(self._places([(x, y)]))
        return self._picture.chart()

    def _places(self, starts: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
        return np.asarray((np.array(starts).T - self._plane.corner) / self._plane.extent)
