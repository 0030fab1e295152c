"""Pages made on demand: an array's elements over their index, quantities of a run over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.graph.chart_page import MARGIN, limits_of
from desire_tui.engine.graph.curve import Curve, Frame
from desire_tui.engine.graph.measured_curve import measured_curve
from desire_tui.engine.graph.still_record import still_record

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.runtime.point_set import PointSet
    from desire_tui.engine.runtime.run_record import RunRecord

ROWS_MOST = 8
"""A matrix of more rows is shown as a picture."""


def history_page(
    pages: GraphPages,
    record: RunRecord | None,
    numbers: Sequence[tuple[str, int]],
    points: Sequence[PointSet] = (),
) -> Graph:
    """Show quantities (names, slots) of a run and measured points over time, as high as they need.

    Without a run (and then without quantities) the times are those of the points.
    """
    columns: dict[str, int] = {}
    if record is not None:
        columns = {name: 1 + record.slots.index(slot) for name, slot in numbers}
    samples = [] if record is None else [record.rows[: record.count, column] for column in columns.values()]
    times = limits_of([one.x for one in points], 0.0) if record is None else record.time_range
    bottom, top = limits_of([*samples, *(one.y for one in points)], MARGIN)
    frame = Frame("dispt", *times, bottom, top, _scale(bottom, top))
    settings, curves = pages.settings, list[Curve]()
    for name, column in columns.items():
        assert record is not None
        color, dash = settings.curve_color(len(curves)), settings.curve_dash(len(curves))
        curves.append(Curve(name, "t", color, record, column, 0, frame, dash=dash))
    for one in points:
        curves.append(measured_curve(one, frame, settings.curve_color(len(curves))))
    return pages.show_curves(frame, f"{', '.join(curve.name for curve in curves)} vs. t", curves)


def array_page(pages: GraphPages, name: str, values: NDArray[Any]) -> Graph:
    """Show an array's elements over their index, from 1: a vector's as a curve, a matrix's by rows.

    COMPLEX: real and imaginary parts. A matrix of more than ROWS_MOST rows becomes a picture, as by SHOW.
    """
    if values.ndim > 1 and np.prod(values.shape[:-1]) > ROWS_MOST:
        real = np.abs(values) if np.iscomplexobj(values) else values
        pages.show(name, np.asarray(real, dtype=np.float64).ravel(), values.shape[-1], _largest(real))
        assert pages.current is not None
        return pages.current
    rows = values.reshape(-1, values.shape[-1])
    named = {_row_name(name, values.shape, number): row for number, row in enumerate(rows)}
    if np.iscomplexobj(values):
        named = {
            f"{part} {n}": v for n, row in named.items() for part, v in (("Re", row.real), ("Im", row.imag))
        }
    length = values.shape[-1]
    table = np.column_stack([np.arange(1.0, length + 1), *named.values()])
    bottom, top = limits_of([table[:, 1:].ravel()], MARGIN)
    frame = Frame("dispxy", 1.0, max(float(length), 2.0), bottom, top, _scale(bottom, top))
    record = still_record([*table.T], frame)
    curves = [
        Curve(
            curve,
            "index",
            pages.settings.curve_color(n),
            record,
            1 + n,
            0,
            frame,
            joined=length > 1,
            dash=pages.settings.curve_dash(n),
        )
        for n, curve in enumerate(named)
    ]
    return pages.show_curves(frame, f"{name} vs. index", curves)


def _row_name(name: str, shape: tuple[int, ...], number: int) -> str:
    if len(shape) == 1:
        return name
    return f"{name}[{','.join(str(k + 1) for k in np.unravel_index(number, shape[:-1]))}]"


def _scale(bottom: float, top: float) -> float:
    return max(abs(bottom), abs(top))


def _largest(values: NDArray[Any]) -> float:
    finite = np.abs(values[np.isfinite(values)])
    return float(finite.max()) if finite.size and finite.max() > 0 else 1.0
