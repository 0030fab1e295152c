"""A chart as a page of the display: zoomed, read out, saved like any other graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.graph.axes import Axes
from desire_tui.engine.graph.colors import ramp_color
from desire_tui.engine.graph.curve import Curve, Frame
from desire_tui.engine.graph.settings import DisplaySettings
from desire_tui.engine.graph.still_record import still_record

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.graph.chart import Chart, Series
    from desire_tui.engine.graph.curve import FrameKind
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages

    Floats = NDArray[np.float64]

MARGIN = 0.05
KEYS_MOST = 8
_UNIT = Frame("dispxy", 0.0, 1.0, 0.0, 1.0, 1.0)


def begin_page(pages: GraphPages, chart: Chart, program: str) -> Graph:
    """Open a page for a chart."""
    page = pages.show_curves(_UNIT, "", [])
    page.program = program
    update_page(page, chart)
    return page


def update_page(page: Graph, chart: Chart) -> None:
    """Show a chart on its page in place of what is there."""
    page.texts |= {"title": chart.title, "xlabel": chart.x_name, "ylabel": chart.y_name}
    page.caption = f"{chart.y_name} vs. {chart.x_name}"
    page.axes = Axes(chart.log_x, chart.log_y, chart.equal)
    page.frame = frame = _frame(chart)
    page.has_keys = 1 < len({one.name for one in chart.series} - {""}) <= KEYS_MOST
    colors, number = DisplaySettings(), 0
    curves = []
    for one in chart.series:
        color = one.color
        if one.part is not None:
            color = ramp_color(one.part)
        elif color is None:
            color = colors.curve_color(number)
            number += 1
        curves.append(_curve(one, chart, frame, color))
    page.curves = curves
    page.fit, page.has_scale = "no", False
    page.erased += 1


def _curve(one: Series, chart: Chart, frame: Frame, color: int) -> Curve:
    return Curve(
        one.name, chart.x_name, color, still_record([one.x, one.y], frame), 1, 0, frame,
        joined=one.look != "points", dash=int(one.look == "dashes"),
    )  # fmt: skip


def limits_of(columns: Sequence[Floats], margin: float, *, positive: bool = False) -> tuple[float, float]:
    """Return the least and the largest finite number, apart from each other; of a logarithm the positive."""
    numbers = np.concatenate([*columns, np.empty(0)])
    finite = numbers[np.isfinite(numbers) & (numbers > 0 if positive else True)]
    if positive:
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.1, 1.0)
        room = (high / low) ** margin if high > low else 2.0
        return low / room, high * room
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    room = margin * (high - low) or (0.0 if high > low else 0.05 * abs(high) or 1.0)
    return low - room, high + room


def _frame(chart: Chart) -> Frame:
    if chart.limits is not None:
        left, right, bottom, top = chart.limits
    else:
        left, right = limits_of([one.x for one in chart.series], 0.0, positive=chart.log_x)
        bottom, top = limits_of([one.y for one in chart.series], MARGIN, positive=chart.log_y)
    kind: FrameKind = "dispt" if chart.x_name == "t" else "dispxy"
    return Frame(kind, left, right, bottom, top, max(abs(bottom), abs(top)))
