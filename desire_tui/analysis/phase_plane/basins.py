"""Where orbits end: basins of attraction on a grid of the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.phase_plane.orbits import advanced

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.phase_plane.plane import Plane

    Floats = NDArray[np.float64]

COLUMNS, ROWS = 48, 33
_STEP = 1.0 / 60.0
_CAUGHT = 1.5 * _STEP
_BEYOND = 4.0
"""So many widths of the plane away, an orbit is taken to run off."""
_LENGTH = 30.0
_ASKED_EVERY = 16
RUNS_OFF, GOES_ROUND = -1, -2


def basins(
    plane: Plane, attractors: Floats, go_on: Callable[[float], bool]
) -> tuple[Floats, NDArray[np.int64]] | None:
    """Return places of a grid, 2 by count, and to which attractor (2 by any number) orbits from there come.

    RUNS_OFF: it leaves for good; GOES_ROUND: it comes to none of them, to a limit cycle for instance. None:
    stopped by `go_on(part)`.
    """
    across, up = np.meshgrid((np.arange(COLUMNS) + 0.5) / COLUMNS, (np.arange(ROWS) + 0.5) / ROWS)
    grid = np.vstack([across.ravel(), up.ravel()])
    ends = np.full(grid.shape[1], GOES_ROUND, dtype=np.int64)
    going, places = np.arange(grid.shape[1]), grid.copy()
    count = int(_LENGTH / _STEP)
    for number in range(count):
        if number % _ASKED_EVERY == 0 and not go_on(number / count):
            return None
        places = advanced(plane, places, np.ones(places.shape[1]), _STEP)
        done = ~(np.abs(places - 0.5).max(axis=0) < _BEYOND)  # nan too
        ends[going[done]] = RUNS_OFF
        if attractors.shape[1]:
            away = np.linalg.norm(places[:, :, None] - attractors[:, None, :], axis=0)
            is_caught = (away.min(axis=1) < _CAUGHT) & ~done
            ends[going[is_caught]] = away.argmin(axis=1)[is_caught]
            done |= is_caught
        going, places = going[~done], places[:, ~done]
        if not len(going):
            break
    return grid, ends
