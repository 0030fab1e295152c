"""A chart that no run draws: numbers and words only; `chart_page` lays it out as a page of the display."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Look = Literal["line", "dashes", "points"]


@dataclass(frozen=True)
class Series:
    """A curve or a cloud of points; a nan parts a curve in two.

    `part` (0 … 1) is its place on the ramp of colours, if it is one of many alike; `color` a number of the
    original's sixteen. Neither: the next colour.
    """

    name: str
    x: Floats
    y: Floats
    look: Look = "line"
    part: float | None = None
    color: int | None = None


@dataclass(frozen=True)
class Chart:
    """A graph. `limits` are left, right, bottom, top; None: all that is finite is shown."""

    title: str
    x_name: str
    y_name: str
    series: Sequence[Series]
    log_x: bool = False
    log_y: bool = False
    equal: bool = False
    """The same scale along both axes."""
    limits: tuple[float, float, float, float] | None = None
