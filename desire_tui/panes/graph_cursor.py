"""The graph's cursor: a time (dispt) or a sample (dispxy, DISPXY), and the values of all curves there."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.graph.model import Graph
    from desire_tui.panes.zoom_window import Window

    Floats = NDArray[np.float64]


GAP = "–"
"""Where a curve has a gap, its sample is inf or nan, or its run has not come so far."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What the cursor reads.

    Its abscissa in parts of the window, a head such as `t = 0.31`, and name, colour, value.
    """

    x: float
    head: str
    values: tuple[tuple[str, int, str], ...]


def read(graph: Graph, window: Window, part: float) -> Reading | None:
    """Read the curves at `part` (0 … 1) of the window's width.

    For curves over x, at that part of their samples.
    """
    import numpy as np

    if not graph.curves:
        return None
    frame = graph.frame
    if frame.kind == "dispt":
        at = window.left + part * (window.right - window.left)
        t = frame.left + at * (frame.right - frame.left)
        values = []
        for curve in graph.curves:
            x, y = curve.samples()
            if len(x) and x[-1] < x[0]:  # a run backward
                x, y = x[::-1], y[::-1]
            if _reaches(x, t):
                number = min(int(np.searchsorted(x, t)), len(x) - 1)
                if number and abs(x[number - 1] - t) < abs(x[number] - t):
                    number -= 1
                values.append((curve.name, curve.color, _shown(y[number])))
            else:
                values.append((curve.name, curve.color, GAP))
        return Reading(part, f"t = {t:.6g}", tuple(values))
    curve = graph.curves[-1]
    x, y = curve.samples()
    if not len(x):
        return None
    number = min(int(part * (len(x) - 1) + 0.5), len(x) - 1)
    own = curve.frame
    at = (x[number] - own.left) / ((own.right - own.left) or 1.0)
    shown = (at - window.left) / (window.right - window.left)
    run = [c for c in graph.curves if c.record is curve.record]
    values = [(c.name, c.color, _shown(c.samples()[1][number])) for c in run if number < c.count]
    head = f"{curve.x_name} = {_shown(x[number])}"
    if curve.x_column:
        head = f"t = {curve.record.rows[number, 0]:.6g}  {head}"
    return Reading(float(shown), head, tuple(values))


def _reaches(x: Floats, t: float) -> bool:
    """Whether t lies in the time of the samples, or as near to it as one of them to the next."""
    if not len(x):
        return False
    step = float(x[-1] - x[0]) / max(len(x) - 1, 1)
    return bool(x[0] - step <= t <= x[-1] + step)


def _shown(value: float) -> str:
    return f"{value:.6g}" if isfinite(value) else GAP
