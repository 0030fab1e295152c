"""The graph's cursor: a time (dispt) or a sample (dispxy, DISPXY), and the values of all curves there."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Curve
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

    @property
    def width(self) -> int:
        """How many cells it takes in one row."""
        return len(self.head) + 2 + sum(len(name) + len(value) + 6 for name, _, value in self.values)


def valued(name: str, value: str) -> str:
    """Return `x = 0.5`, or `c = 0.3: 0.5` of a curve that is called by its run."""
    return f"{name}: {value}" if "=" in name else f"{name} = {value}"


def read(graph: Graph, window: Window, part: float, picked: Curve | None = None) -> Reading | None:
    """Read the curves at `part` (0 … 1) of the window's width.

    For curves over x, at that part of the samples of the run of the picked one, else of the last.
    """
    curves = list(graph.curves)
    if not curves:
        return None
    label = labels(graph)
    frame = graph.frame
    if frame.kind == "dispt":
        t = graph.axes.abscissa(frame, window.left + part * (window.right - window.left))
        values = tuple((label(curve), curve.color, _told_at(curve, t)) for curve in curves)
        return Reading(part, f"t = {t:.6g}", values)
    curve = picked or next((one for one in reversed(curves) if not one.measured), curves[-1])
    x, _ = curve.samples()
    if not len(x):
        return None
    number = min(int(part * (len(x) - 1) + 0.5), len(x) - 1)
    at, _ = graph.axes.to_unit(curve.frame, x[number : number + 1], x[number : number + 1])
    shown = (at[0] - window.left) / (window.right - window.left)
    run = [c for c in curves if c.record is curve.record]
    values = tuple((label(c), c.color, _shown(c.samples()[1][number])) for c in run if number < c.count)
    head = f"{curve.x_name} = {_shown(x[number])}"
    if curve.x_column:
        head = f"t = {curve.record.rows[number, 0]:.6g}  {head}"
    return Reading(float(shown), head, values)


def labels(graph: Graph) -> Callable[[Curve], str]:
    """Return what tells a graph's curves apart: names of variables, or what varies over the runs, or both."""
    study = graph.study
    alone = len({curve.name for curve in graph.curves if not curve.measured}) == 1
    if len(study.records) < 2:
        return lambda curve: curve.name

    def name(curve: Curve) -> str:
        run = "" if curve.measured else study.name(curve.record)
        return run if alone and run else ", ".join(filter(None, (curve.name, run)))

    return name


def _told_at(curve: Curve, t: float) -> str:
    """Return the sample next to a time; of measured points, which may be far from it, with its own time."""
    number = _sample_at(curve, t)
    if number is None:
        return GAP
    x, y = curve.samples(number, number + 1)
    value = _shown(float(y[0]))
    return f"{value} at {x[0]:.6g}" if curve.measured else value


def _sample_at(curve: Curve, t: float) -> int | None:
    import numpy as np

    x, _ = curve.samples()
    backward = len(x) > 0 and x[-1] < x[0]
    if backward:
        x = x[::-1]
    if not _reaches(x, t):
        return None
    number = min(int(np.searchsorted(x, t)), len(x) - 1)
    if number and abs(x[number - 1] - t) < abs(x[number] - t):
        number -= 1
    return len(x) - 1 - number if backward else number


def sample_at(graph: Graph, curve: Curve, window: Window, part: float) -> int | None:
    """Return the number of a curve's sample at `part` of the window's width, as `read` takes it."""
    if graph.frame.kind != "dispt":
        return min(int(part * (curve.count - 1) + 0.5), curve.count - 1) if curve.count else None
    at = window.left + part * (window.right - window.left)
    return _sample_at(curve, graph.axes.abscissa(graph.frame, at))


def told(graph: Graph, curve: Curve, number: int) -> str:
    """Return what is said of a curve that is picked: its run, what varies there, and one of its samples."""
    x, y = curve.samples(number, number + 1)
    study, record = graph.study, curve.record
    if curve.measured:
        return f"{curve.name} = {_shown(float(y[0]))} measured at {curve.x_name} = {_shown(float(x[0]))}"
    parts = [f"run {record.number}"] if record.number and len(study.records) > 1 else []
    parts += [varied.at(study.place(record)) for varied in study.every]
    sample = f"{curve.name} = {_shown(float(y[0]))}"
    if not curve.x_column:
        parts.append(f"{sample} at {curve.x_name} = {_shown(float(x[0]))}")
    else:
        t = curve.record.rows[number, 0]
        parts.append(f"{sample}, {curve.x_name} = {_shown(float(x[0]))} at t = {_shown(float(t))}")
    return " · ".join(parts)


def _reaches(x: Floats, t: float) -> bool:
    """Whether t lies in the time of the samples, or as near to it as one of them to the next."""
    if not len(x):
        return False
    step = float(x[-1] - x[0]) / max(len(x) - 1, 1)
    return bool(x[0] - step <= t <= x[-1] + step)


def _shown(value: float) -> str:
    return f"{value:.6g}" if isfinite(value) else GAP
