"""Bars over names, as curves: a series for each, so that the key says which is which."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_HALF, _STROKES = 0.35, 60


def bars(title: str, y_name: str, names: Sequence[str], heights: Sequence[float] | Floats) -> Chart:
    """Return a chart of bars that stand beside one another in the given order, filled by strokes."""
    series = []
    for k, (name, height) in enumerate(zip(names, heights, strict=True), 1):
        x = np.repeat(np.linspace(k - _HALF, k + _HALF, _STROKES), 2)
        y = np.tile([0.0, height, height, 0.0], _STROKES // 2)
        series.append(Series(name, x, y))
    low, high = min(0.0, *heights), max(0.0, *heights)
    room = 0.05 * (high - low) or 1.0
    limits = (0.5, len(names) + 0.5, low - (room if low < 0.0 else 0.0), high + room)
    return Chart(title, "rank", y_name, series, limits=limits)
