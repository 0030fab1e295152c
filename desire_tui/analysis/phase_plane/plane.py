"""The plane of two states, in coordinates from 0 to 1, and what moves a point of it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

Limits = tuple[float, float, float, float]
"""Left, right, bottom, top."""
_INDEPENDENT = 1e-9


@dataclass(frozen=True)
class Plane:
    """Two states of a system within limits. The others are held, or follow from conserved sums.

    Places of the plane are given by parts of its width and height, 2 by count. `held` has all states, n.
    """

    system: System
    axes: tuple[int, int]
    limits: Limits
    held: NDArray[np.float64]
    p: Mapping[str, float]

    @property
    def names(self) -> tuple[str, str]:
        """Names of the two states."""
        names = self.system.flow.names
        return names[self.axes[0]], names[self.axes[1]]

    @property
    def is_whole(self) -> bool:
        """Whether a place of the plane tells all states: orbits stay in it, and do not cross."""
        return len(self.held) == 2 or bool(self._told)

    def at(self, p: Mapping[str, float]) -> Plane:
        """Return the same plane at other parameters."""
        return replace(self, p=p)

    @property
    def corner(self) -> Floats:
        """Least x and y, 2 by 1."""
        return np.array([[self.limits[0]], [self.limits[2]]])

    @property
    def extent(self) -> Floats:
        """Width and height, 2 by 1."""
        left, right, bottom, top = self.limits
        return np.array([[right - left], [top - bottom]])

    def values(self, places: Floats) -> Floats:
        """Return x and y at places, 2 by count."""
        return np.asarray(self.corner + self.extent * places)

    def place(self, x: Floats) -> Floats:
        """Return the places of states, from n by count."""
        return np.asarray((x[list(self.axes)] - self.corner) / self.extent)

    @cached_property
    def _told(self) -> list[int]:
        """States that conserved sums tell from the two, all others or none."""
        others = [k for k in range(len(self.held)) if k not in self.axes]
        laws = self.system.laws
        if len(laws) != len(others) or not others:
            return []
        return others if abs(np.linalg.det(laws[:, others])) > _INDEPENDENT else []

    def states(self, places: Floats) -> Floats:
        """Return all states at places, n by count."""
        two = list(self.axes)
        full = np.repeat(self.held[:, None], places.shape[1], axis=1)
        full[two] = self.values(places)
        if self._told:
            laws, base = self.system.laws, self.system.base
            rest = (laws @ base)[:, None] - laws[:, two] @ full[two]
            full[self._told] = np.linalg.solve(laws[:, self._told], rest)
        return full

    def rates(self, places: Floats) -> Floats:
        """Return how fast places move, 2 by count, in parts of width and height per unit of time."""
        moved = self.system.flow.rate(self.states(places), self.p)
        return np.asarray(moved[list(self.axes)] / self.extent)

    def matrices(self, places: Floats) -> Floats:
        """Return the derivatives of the rates by the places, count by 2 by 2."""
        two = list(self.axes)
        full = self.system.flow.jacobian(self.states(places), self.p)[:, two]
        found = full[:, :, two]
        if self._told:
            laws = self.system.laws
            found = found - full[:, :, self._told] @ np.linalg.solve(laws[:, self._told], laws[:, two])
        extent = self.extent[:, 0]
        return np.asarray(found * extent / extent[:, None])
