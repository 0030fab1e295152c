"""Breakpoints of table functions must not fall: one test for scripts and for both back ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def first_falling(points: NDArray[np.float64]) -> int | None:
    """Return the index of the first breakpoint below the one before it; None if they rise.

    Equal neighbours make a jump. nan counts as falling.
    """
    rising = points[1:] >= points[:-1]
    return None if rising.all() else 1 + int(np.argmin(rising))


def falling_facts(name: str, points: NDArray[np.float64]) -> dict[str, object] | None:
    """Return what the message `table-falling` needs, None where the breakpoints rise."""
    at = first_falling(points)
    if at is None:
        return None
    return {"name": name, "place": at + 1, "value": float(points[at]), "before": float(points[at - 1])}
