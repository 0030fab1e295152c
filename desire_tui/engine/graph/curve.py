"""One curve of one run, and the window of program values that it is drawn in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_record import RunRecord

    Floats = NDArray[np.float64]

FrameKind = Literal["dispt", "dispxy", "DISPXY", "plot", "picture"]


@dataclass(frozen=True, slots=True)
class Frame:
    """The window of program values that a graph shows: `left … right` by `bottom … top`."""

    kind: FrameKind
    left: float
    right: float
    bottom: float
    top: float
    scale: float


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """One curve of one run; its samples grow while the run goes on.

    `frame` is the window of its own run: in a graph shared by runs (`display 2`) every curve keeps the scale
    it was made with, as ink on a screen does. `joined`: neighbouring samples are joined by lines; maps
    (dispxy without `d/dt`) are clouds of dots.
    """

    name: str
    x_name: str
    color: int
    record: RunRecord
    y_column: int
    x_column: int
    frame: Frame
    thickness: int = 1
    joined: bool = True
    dash: int = 0
    """0 solid; from 1 on dashed, dotted …: there are more curves than colours."""
    measured: bool = False
    """Points of a data file, no run's: they are markers, as large as may be overlooked by none."""
    own_color: int | None = None
    """Its colour without regard to runs that share the graph; None: `color`."""

    @property
    def hue(self) -> int:
        """The colour that `display` gives it."""
        return self.color if self.own_color is None else self.own_color

    @property
    def count(self) -> int:
        """Samples so far."""
        return self.record.count

    def samples(self, start: int = 0, stop: int | None = None) -> tuple[Floats, Floats]:
        """Abscissas and ordinates of samples `start … stop - 1` (default: all so far), in program units."""
        count = self.record.count
        rows = self.record.rows
        stop = count if stop is None else min(stop, count)
        return rows[start:stop, self.x_column], rows[start:stop, self.y_column]
