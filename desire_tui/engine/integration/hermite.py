"""The cubic through both ends of a step with the slopes there, in plain Python."""

from __future__ import annotations


def inside(part: float, x0: float, x1: float, slope0: float, slope1: float) -> float:
    """Return its value at `part` (0 … 1) of the step; slopes are derivatives times the step's size."""
    rest = 1.0 - part
    bend = (1.0 - 2.0 * part) * (x1 - x0) - rest * slope0 + part * slope1
    return rest * x0 + part * x1 - part * rest * bend
