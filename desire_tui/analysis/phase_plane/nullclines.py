"""Direction field and nullclines: where one of the two states stands still."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.phase_plane.plane import Plane

    Floats = NDArray[np.float64]

COLUMNS, ROWS = 121, 91
"""Of the grid on which rates are computed."""
_ARROWS = (16, 11)
_ARROW = 0.55
"""Length of an arrow as a part of its cell."""
_HEAD = 0.32
_REFINED = 2
_SLIP = 0.02


class Grid:
    """Rates of a plane on a grid, with what is read off them."""

    def __init__(self, plane: Plane) -> None:
        self.plane = plane
        # half a cell beyond the limits: what stands still along an axis is inside, not on the border
        across, up = 0.5 / (COLUMNS - 2), 0.5 / (ROWS - 2)
        self.x, self.y = np.linspace(-across, 1.0 + across, COLUMNS), np.linspace(-up, 1.0 + up, ROWS)
        grid = np.meshgrid(self.x, self.y)
        places = np.vstack([grid[0].ravel(), grid[1].ravel()])
        self.rates = plane.rates(places).reshape(2, ROWS, COLUMNS)

    def nullcline(self, axis: int) -> Floats:
        """Return where a state stands still, 2 by count: lines of the grid, made exact, parted by nan."""
        from contourpy import contour_generator

        rates = np.ma.masked_invalid(self.rates[axis])
        lines = contour_generator(self.x, self.y, rates).lines(0.0)
        if not lines:
            return np.empty((2, 0))
        gap = np.full((2, 1), np.nan)
        found = np.hstack([piece for line in lines for piece in (np.asarray(line).T, gap)])
        is_place = np.isfinite(found[0])
        found[:, is_place] = self._refined(found[:, is_place], axis)
        return found

    def _refined(self, places: Floats, axis: int) -> Floats:
        """Move places along the gradient to where a rate is 0 by Newton's method, but not far."""
        moved = places
        for _ in range(_REFINED):
            rate, slope = self.plane.rates(moved)[axis], self.plane.matrices(moved)[:, axis].T
            steps = -rate * slope / np.maximum(np.sum(slope**2, axis=0), 1e-300)
            is_good = np.all(np.isfinite(steps), axis=0) & (np.linalg.norm(steps, axis=0) < _SLIP)
            moved = moved + np.where(is_good, steps, 0.0)
        return moved

    def cells_at_rest(self) -> Floats:
        """Return the middles of cells in which both rates change their sign, 2 by count."""
        has_both = np.ones((ROWS - 1, COLUMNS - 1), dtype=bool)
        for rate in self.rates:
            corners = np.stack([rate[:-1, :-1], rate[1:, :-1], rate[:-1, 1:], rate[1:, 1:]])
            has_both &= (corners.min(axis=0) <= 0.0) & (corners.max(axis=0) >= 0.0)
        rows, columns = np.nonzero(has_both)
        return np.vstack([self.x[columns] + self.x[columns + 1], self.y[rows] + self.y[rows + 1]]) / 2.0


def arrows(plane: Plane) -> Floats:
    """Return arrows along the motion, all of one length, as lines parted by nan: 2 by count."""
    columns, rows = _ARROWS
    across, up = np.meshgrid((np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows)
    places = np.vstack([across.ravel(), up.ravel()])
    cell = np.array([[1.0 / columns], [1.0 / rows]])
    along = plane.rates(places) / cell
    along = along / np.linalg.norm(along, axis=0)
    side = np.vstack([-along[1], along[0]])
    tip, tail = places + 0.5 * _ARROW * along * cell, places - 0.5 * _ARROW * along * cell
    left = tip + (0.5 * _HEAD * side - _HEAD * along) * cell
    right = tip - (0.5 * _HEAD * side + _HEAD * along) * cell
    gap = np.full_like(tip, np.nan)
    return np.stack([tail, tip, gap, left, tip, right, gap], axis=2).reshape(2, -1)
