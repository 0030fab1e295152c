"""Orbits in a plane by their length: many at once, forwards or backwards."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.phase_plane.plane import Plane

    Floats = NDArray[np.float64]

STEP = 1.0 / 150.0
OUTSIDE = 0.25
"""Orbits are followed so far beyond the plane's limits, in parts of it, since they may come back."""


def directions(plane: Plane, places: Floats, signs: Floats) -> Floats:
    """Return unit vectors along the motion (against it where a sign is -1), 2 by count; 0 at rest."""
    rates = plane.rates(places)
    speed = np.linalg.norm(rates, axis=0)
    is_moving = np.isfinite(speed) & (speed > 0.0)
    return np.asarray(np.where(is_moving, rates / np.where(is_moving, speed, 1.0), 0.0) * signs)


def advanced(plane: Plane, places: Floats, signs: Floats, step: float = STEP) -> Floats:
    """Return places a step of a length further, by the Runge-Kutta rule of fourth order."""
    first = directions(plane, places, signs)
    second = directions(plane, places + 0.5 * step * first, signs)
    third = directions(plane, places + 0.5 * step * second, signs)
    last = directions(plane, places + step * third, signs)
    return np.asarray(places + step / 6.0 * (first + 2.0 * second + 2.0 * third + last))


def is_near(places: Floats) -> NDArray[np.bool_]:
    """Tell which places are within the plane or a little outside."""
    return np.asarray(np.all((places > -OUTSIDE) & (places < 1.0 + OUTSIDE), axis=0))


def orbits(
    plane: Plane, starts: Floats, signs: Floats, rests: Floats, *, length: float, step: float = STEP
) -> Floats:
    """Return orbits from starts, points by 2 by count; nan after an orbit has left or come to rest.

    `rests` are places of steady states, 2 by any number; `length` is the most, in widths of the plane.
    """
    places = starts.copy()
    found = [places.copy()]
    going = np.ones(starts.shape[1], dtype=bool)
    has_left = np.zeros(starts.shape[1], dtype=bool)
    for _ in range(int(length / step)):
        places[:, going] = advanced(plane, places[:, going], signs[going], step)
        found.append(np.where(going, places, np.nan))
        is_over = ~is_near(places)
        if rests.shape[1]:
            away = np.linalg.norm(places[:, :, None] - rests[:, None, :], axis=0).min(axis=1)
            is_over |= has_left & (away < step)
            has_left |= away > 3.0 * step
        going &= ~is_over
        if not np.any(going):
            break
    return np.array(found)


def manifolds(plane: Plane, saddles: Floats, rests: Floats, *, length: float) -> tuple[Floats, Floats]:
    """Return the unstable and the stable manifolds of saddles (2 by count): 2 by points, parted by nan."""
    starts, signs = [], []
    for place, matrix in zip(saddles.T, plane.matrices(saddles), strict=True):
        values, vectors = np.linalg.eig(matrix)
        for value, vector in zip(values.real, vectors.real.T, strict=True):
            for side in (1.0, -1.0):
                starts.append(place + side * 0.1 * STEP * vector / np.linalg.norm(vector))
                signs.append(1.0 if value > 0.0 else -1.0)
    if not starts:
        return np.empty((2, 0)), np.empty((2, 0))
    sign = np.array(signs)
    followed = orbits(plane, np.array(starts).T, sign, rests, length=length)
    return joined(followed[:, :, sign > 0.0]), joined(followed[:, :, sign < 0.0])


def joined(followed: Floats) -> Floats:
    """Return orbits, points by 2 by count, as one line parted by nan, 2 by points."""
    gap = np.full((1, 2, followed.shape[2]), np.nan)
    return np.concatenate([followed, gap]).transpose(1, 2, 0).reshape(2, -1)
