"""A chart of a study as a page of the display: zoomed, read out, saved like any other graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.graph.chart_page import KEYS_MOST, MARGIN, limits_of
from desire_tui.engine.graph.colors import ramp_color
from desire_tui.engine.graph.curve import Curve, Frame
from desire_tui.engine.graph.model import ShownArray
from desire_tui.engine.graph.still_record import still_record

if TYPE_CHECKING:
    from desire_tui.engine.graph.curve import FrameKind
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.studies.charts import Chart, ChartKind, Line
    from desire_tui.studies.dataset import Layout

_FAN_COLORS = (9, 11, 15, 11, 9)
"""Of the quantiles: alike on both sides of the median."""
_FAN_BANDS = ((0, 4), (1, 3))


@dataclass
class StudyChart:
    """A chart that follows a study. `drawn` is what its page shows next; None: it shows the newest."""

    layout: Layout
    kind: ChartKind
    parameter: str = ""
    page: Graph | None = None
    drawn: Chart | None = None


def begin_page(pages: GraphPages, drawn: Chart, program: str) -> Graph:
    """Open a page for a chart."""
    page = pages.show_curves(Frame("dispxy", 0.0, 1.0, 0.0, 1.0, 1.0), "", [])
    page.program, page.has_scale = program, False
    update_page(page, drawn)
    return page


def update_page(page: Graph, drawn: Chart) -> None:
    """Show a chart on its page in place of what is there."""
    page.texts |= {"title": drawn.title, "xlabel": drawn.x_name, "ylabel": drawn.y_name}
    page.caption = f"{drawn.y_name} vs. {drawn.x_name}"
    if drawn.picture is not None:
        finite = np.abs(drawn.picture[np.isfinite(drawn.picture)])
        scale = float(finite.max()) if finite.size and finite.max() > 0 else 1.0
        page.frame = Frame("picture", 0.0, 1.0, 0.0, 1.0, scale)
        page.cells = drawn.cells
        page.shown = [ShownArray(drawn.y_name, drawn.picture.shape[1], scale, drawn.picture.ravel())]
        page.erased += 1
        return
    page.frame = frame = _frame(drawn)
    page.has_keys = 1 < len(drawn.lines) <= KEYS_MOST
    record = still_record([drawn.x, *(line.y for line in drawn.lines)], frame)
    page.curves = [
        Curve(
            line.name, drawn.x_name, _color(drawn, line, number), record, 1 + number, 0, frame,
            joined=drawn.joined,
        )
        for number, line in enumerate(drawn.lines)
    ]  # fmt: skip
    page.bands = _FAN_BANDS if _has_quantiles(drawn) else ()
    page.erased += 1


def _has_quantiles(drawn: Chart) -> bool:
    return drawn.kind in ("fan", "over") and len(drawn.lines) == len(_FAN_COLORS)


def _color(drawn: Chart, line: Line, number: int) -> int:
    if line.part is not None:
        return ramp_color(line.part)
    return _FAN_COLORS[number] if _has_quantiles(drawn) else 14


def _frame(drawn: Chart) -> Frame:
    left, right = limits_of([drawn.x], 0.0)
    bottom, top = limits_of([line.y for line in drawn.lines], MARGIN)
    if drawn.kind in ("histogram", "cumulated"):
        bottom = 0.0
    kind: FrameKind = "dispt" if drawn.kind in ("fan", "curves", "over") else "dispxy"
    return Frame(kind, left, right, bottom, top, max(abs(bottom), abs(top)))
