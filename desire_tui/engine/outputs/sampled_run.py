"""What tables and pictures need to know of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import closest

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.runtime.point_set import PointSet

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class CurveData:
    """All samples of one variable, as computed (not clipped); `x` names the abscissa, None for t."""

    name: str
    x: str | None
    values: Floats


class SampledRun(Protocol):
    """Samples at times."""

    @property
    def t(self) -> Floats:
        """The times."""
        ...

    @property
    def curves(self) -> tuple[CurveData, ...]:
        """Every variable recorded."""
        ...

    @property
    def points(self) -> tuple[PointSet, ...]:
        """What was measured, to be drawn over the curves."""
        ...

    @property
    def parameters(self) -> dict[str, float]:
        """What the run did not change."""
        ...

    @property
    def initial(self) -> dict[str, float]:
        """Where the states began."""
        ...


def curves_over_t(run: SampledRun) -> list[CurveData]:
    """Return what was recorded besides t."""
    return [curve for curve in run.curves if curve.name != "t"]


def samples(run: SampledRun, name: str) -> Floats:
    """Return the samples of a variable, or of `t`; KeyError for one that was not recorded."""
    return run.t if name == "t" else curve_named(run, name).values


def curve_named(run: SampledRun, name: str) -> CurveData:
    """Return a variable's curve; KeyError for one that was not recorded."""
    for curve in run.curves:
        if curve.name == name:
            return curve
    raise KeyError(_not_recorded(run, name))


def _not_recorded(run: SampledRun, name: str) -> str:
    near = closest(name, [curve.name for curve in run.curves])
    hint = f"did you mean {near!r}?" if near else "name it in record=, or in a dispt line of the program"
    return f"{name!r} was not recorded; {hint}"
