"""The listing that `type` writes while the samples come (language.md 10; book 1.3.7.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import SampleRequest


def header(request: SampleRequest) -> str:
    """Return the first line: `t,   x,y`."""
    return "t,   " + ",".join(column.name for column in request.columns)


def lines(rows: NDArray[np.float64], first: int, count: int) -> str:
    """Return one line for each sample: t left-justified, then `count` columns from number `first` on."""
    form = "%#-13.5e" + "%#13.5e " * count + "\n"
    wanted = rows[:, [0, *range(1 + first, 1 + first + count)]]
    return "".join(form % tuple(row) for row in wanted.tolist())
