"""Measured points that are drawn over the curves of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PointSet:
    """Points of a column: its values `y` over the times, or over another column's values (`x_name`)."""

    name: str
    x_name: str
    x: Floats
    y: Floats
