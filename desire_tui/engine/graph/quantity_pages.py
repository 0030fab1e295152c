"""Pages made on demand: an array's elements over their index, one variable of a run over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.graph.curve import Curve, Frame
from desire_tui.engine.integration.rules import DUMMY
from desire_tui.engine.runtime.run_record import RunRecord

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphPages

ROWS_MOST = 8
"""A matrix of more rows is shown as a picture."""
MARGIN = 0.05
"""Room above and below a curve, in parts of its height."""


def history_page(pages: GraphPages, name: str, record: RunRecord, column: int) -> Graph:
    """Show one of a run's columns over time on a page of its own, as high as it needs."""
    bottom, top = _limits(record.rows[: record.count, 1 + column])
    frame = Frame("dispt", *record.time_range, bottom, top, _scale(bottom, top))
    curve = Curve(name, "t", pages.settings.curve_color(0), record, 1 + column, 0, frame)
    return pages.show_curves(frame, f"{name} vs. t", [curve])


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
    bottom, top = _limits(table[:, 1:])
    frame = Frame("dispxy", 1.0, max(float(length), 2.0), bottom, top, _scale(bottom, top))
    record = RunRecord(
        number=0, segment=None, line=0, requests=(), columns=(), overlay=False, rule=DUMMY, scale=frame.scale,
        t0=1.0, t_max=frame.right - 1.0, nn=length, dt=1.0, rows=table, count=length, ended="tmax",
    )  # fmt: skip
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


def _limits(values: NDArray[np.float64]) -> tuple[float, float]:
    """Return the least and the largest finite value, with a margin."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (-1.0, 1.0)
    room = MARGIN * (high - low) or MARGIN * abs(high) or 1.0
    return low - room, high + room


def _scale(bottom: float, top: float) -> float:
    return max(abs(bottom), abs(top))


def _largest(values: NDArray[Any]) -> float:
    finite = np.abs(values[np.isfinite(values)])
    return float(finite.max()) if finite.size and finite.max() > 0 else 1.0
