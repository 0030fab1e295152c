"""Curves, bands and points of a picture, drawn by matplotlib."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.graph.colors import Rgb, curve_rgb, rgb
from desire_tui.engine.graph.model import FEW_POINTS
from desire_tui.engine.graph.polylines import clip_polyline, thin_columns, through

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.fit import View
    from desire_tui.engine.graph.model import Graph

    Tint = tuple[float, float, float]

DASHES: tuple[Any, ...] = ("solid", (0, (5, 2)), (0, (1, 1.2)), (0, (8, 1.5, 1, 1.5)))
MARKERS = "osD^"
POINT_WIDTH = 5.0
"""Of points that are few."""
_WIDTHS = {1: 1.1, 2: 2.2, 3: 3.6}
"""In points, as they all are here; by thickness."""
_BAND_ALPHA = 0.2
_COLUMNS = 4000
"""Finer than any printer shows at this size."""


def fill_band(axes: Axes, low: Curve, high: Curve, graph: Graph, window: View) -> None:
    """Fill what lies between two curves over the same abscissas."""
    x, bottom = through(window, *graph.axes.to_unit(low.frame, *low.samples()))
    _, top = through(window, *graph.axes.to_unit(high.frame, *high.samples()))
    axes.fill_between(
        x, bottom, top, color=curve_tint(low.color, graph), alpha=_BAND_ALPHA, linewidth=0,
        transform=axes.transAxes, zorder=1,
    )  # fmt: skip


def draw_curve(axes: Axes, curve: Curve, graph: Graph, window: View) -> None:
    """Draw in parts of the window: a curve of an earlier run keeps its own scale."""
    x, y = through(window, *graph.axes.to_unit(curve.frame, *curve.samples()))
    color, width = curve_tint(curve.color, graph), _WIDTHS[curve.thickness]
    if not curve.joined:
        marker = MARKERS[curve.dash % len(MARKERS)]
        few = _point_width(graph)
        if curve.measured:
            few = POINT_WIDTH if curve.count <= FEW_POINTS else POINT_WIDTH / 2
        with np.errstate(invalid="ignore"):
            inside = (x >= 0) & (x <= 1) & (y >= 0) & (y <= 1)
        axes.plot(
            x[inside], y[inside], linestyle="none", marker=marker, markersize=max(few, 0.8 * width),
            markeredgewidth=0, color=color, transform=axes.transAxes,
            zorder=4 if curve.measured else 2, clip_on=not curve.measured,
        )  # fmt: skip
        return
    if curve.frame.kind == "dispt":
        x, y = thin_columns(x, y, _COLUMNS)
    x1, y1, x2, y2 = clip_polyline(x, y)
    path_x, path_y = _connected(x1, y1, x2, y2)
    axes.plot(
        path_x, path_y, color=color, linewidth=width, linestyle=DASHES[curve.dash % len(DASHES)],
        solid_joinstyle="round", transform=axes.transAxes, clip_on=False, zorder=3,
    )  # fmt: skip


def _point_width(graph: Graph) -> float:
    """Return how wide points are: the smaller the more there are, so that few are seen."""
    return POINT_WIDTH * min(1.0, sqrt(FEW_POINTS / max(graph.point_count, 1)))


def _connected(x1: Any, y1: Any, x2: Any, y2: Any) -> tuple[Any, Any]:
    """Segments end to end as one path, broken by nan where they do not meet."""
    if not len(x1):
        return x1, y1
    broken = np.flatnonzero((x1[1:] != x2[:-1]) | (y1[1:] != y2[:-1])) + 1
    paths = []
    for first, last in ((x1, x2), (y1, y2)):
        points = np.append(first, last[-1])
        # before each break: the end of the old piece, then a gap
        values = np.column_stack((last[broken - 1], np.full(len(broken), np.nan))).ravel()
        paths.append(np.insert(points, np.repeat(broken, 2), values))
    return paths[0], paths[1]


def draw_points(axes: Axes, graph: Graph) -> None:
    """Draw the points of `plot`, in their colours."""
    x, y, colors = graph.points.so_far()
    if not len(x):
        return
    few = _point_width(graph)
    x, y = graph.axes.values(x, y)
    axes.scatter(
        x, y, s=max(few, 2.0 * _WIDTHS[graph.thickness]) ** 2, c=[curve_tint(int(c), graph) for c in colors],
        linewidths=0, zorder=3,
    )  # fmt: skip


def tint(color: int, graph: Graph) -> Tint:
    """Return a colour of the ground, the net or the ink."""
    return _parts(rgb(color, white=graph.white))


def curve_tint(color: int, graph: Graph) -> Tint:
    """Return a colour of curves or points."""
    return _parts(curve_rgb(color, white=graph.white))


def _parts(color: Rgb) -> Tint:
    red, green, blue = color
    return red / 255, green / 255, blue / 255
