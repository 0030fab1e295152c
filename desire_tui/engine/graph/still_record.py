"""Columns of numbers as samples that no run makes: curves of charts, arrays, measured points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.rules import DUMMY
from desire_tui.engine.runtime.run_record import RunRecord

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Frame

    Floats = NDArray[np.float64]


def still_record(columns: Sequence[Floats], frame: Frame) -> RunRecord:
    """Return columns of numbers as samples; the first is the abscissa."""
    table = np.column_stack(columns)
    return RunRecord(
        number=0, segment=None, line=0, requests=(), columns=(), overlay=False, rule=DUMMY, scale=frame.scale,
        t0=frame.left, t_max=frame.right - frame.left, nn=len(table), dt=1.0, rows=table, count=len(table),
        ended="tmax",
    )  # fmt: skip
