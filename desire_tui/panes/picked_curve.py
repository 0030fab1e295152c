"""The curve picked out of those on a graph: the one nearest to the mouse, drawn above the others."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.panes.zoom_window import Window

    Floats = NDArray[np.float64]

CURVES_MOST = 500
"""Among more, the mouse picks none: that would take longer than a frame."""
SAMPLES_MOST = 2000
NEAR_CELLS = 1.5
THICK = 2


def nearest(
    graph: Graph, window: Window, place: tuple[float, float], cells: tuple[int, int]
) -> tuple[Curve, int] | None:
    """Return the curve next to a place (parts of the window) and the sample there; None if none is near.

    `cells`: columns and rows of the canvas.
    """
    curves = list(graph.curves)
    if len(curves) > CURVES_MOST:
        return None
    best: tuple[float, Curve, int] | None = None
    for curve in curves:
        found = _distance(graph, curve, window, place, cells)
        if found is not None and found[0] <= NEAR_CELLS and (best is None or found[0] < best[0]):
            best = found[0], curve, found[1]
    return None if best is None else best[1:]


def draw_picked(graph: Graph, curve: Curve, window: Window, canvas: Canvas) -> Canvas:
    """Return a canvas like that one with nothing but one curve, thick and in the colour of the picked."""
    from desire_tui.engine.graph.colors import PICKED
    from desire_tui.engine.graph.polylines import thin_columns, through
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.incremental_drawing import SAMPLES_MOST as DRAWN_MOST

    alone = Canvas(canvas.columns, canvas.rows, canvas.left)
    x, y = through(window, *graph.axes.to_unit(curve.frame, *curve.samples(max(curve.count - DRAWN_MOST, 0))))
    if not curve.joined:
        alone.dots(x, y, PICKED, 3)
        return alone
    if curve.frame.kind == "dispt":
        x, y = thin_columns(x, y, canvas.width)
    if len(x):
        alone.line(x, y, PICKED, THICK)
    return alone


def _distance(
    graph: Graph, curve: Curve, window: Window, place: tuple[float, float], cells: tuple[int, int]
) -> tuple[float, int] | None:
    """Return how many rows of cells a curve is away, and its nearest sample."""
    import numpy as np

    from desire_tui.engine.graph.polylines import through

    (at_x, at_y), (columns, rows) = place, cells
    first, count = 0, curve.count
    if curve.frame.kind == "dispt":  # what stands in the mouse's column
        half = 1.5 / columns
        parts = (window.left + at * (window.right - window.left) for at in (at_x - half, at_x + half))
        times = [graph.axes.abscissa(curve.frame, part) for part in parts]
        x = curve.samples()[0]
        sign = -1.0 if len(x) and x[-1] < x[0] else 1.0  # a run backward
        first, last = sorted(np.searchsorted(sign * x, [sign * t for t in times]).tolist())
        first, count = max(first - 1, 0), min(last + 1, count)
    step = max(-(-(count - first) // SAMPLES_MOST), 1)
    x, y = (part[::step] for part in curve.samples(first, count))
    if not len(x):
        return None
    x, y = through(window, *graph.axes.to_unit(curve.frame, x, y))
    across, up = (x - at_x) * columns / 2, (y - at_y) * rows  # a cell is twice as high as wide
    with np.errstate(invalid="ignore", over="ignore"):
        far = np.nan_to_num(np.hypot(across, up), nan=np.inf)
    number = int(far.argmin())
    least = float(far[number])
    if len(x) > 1 and curve.joined:
        least = min(least, _from_lines(across, up))
    return least, first + number * step


def _from_lines(x: Floats, y: Floats) -> float:
    """Return the distance of (0, 0) from a polyline."""
    import numpy as np

    dx, dy = np.diff(x), np.diff(y)
    with np.errstate(all="ignore"):
        part = np.clip(-(x[:-1] * dx + y[:-1] * dy) / (dx * dx + dy * dy), 0.0, 1.0)
        far = np.hypot(x[:-1] + part * dx, y[:-1] + part * dy)
    finite = far[np.isfinite(far)]
    return float(finite.min()) if finite.size else float("inf")
