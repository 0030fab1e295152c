"""What the cells of a picture stand for: the values along its sides, of its darkest and brightest."""

from __future__ import annotations

from typing import NamedTuple


class Cells(NamedTuple):
    """`columns` from the left and `rows` from the top; a cell of 0 means `low`, one of 1 `high`."""

    columns: tuple[float, ...]
    rows: tuple[float, ...]
    low: float
    high: float


def cell_ticks(values: tuple[float, ...], most: int) -> tuple[tuple[int, str], ...]:
    """Return which of the cells along a side are labelled, evenly spread ones, and how."""
    step = max(-(-len(values) // max(most, 1)), 1)
    return tuple((place, f"{values[place]:.4g}") for place in range(0, len(values), step))
