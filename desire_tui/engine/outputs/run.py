"""One simulation run as a caller gets it: its samples by name, and how it went.

The dataclass fields are the public layout of the JSON, but those marked `IN_MEMORY`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.outputs.sampled_run import CurveData, curves_over_t, samples

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from desire_tui.engine.diagnostics import DesireError, Diagnostic
    from desire_tui.engine.runtime.point_set import PointSet

    Floats = NDArray[np.float64]

IN_MEMORY = {"in_memory": True}
"""Marks fields that are no part of the JSON."""


@dataclass(frozen=True, eq=False, repr=False)
class Run(Mapping[str, "Floats"]):
    """One run: a mapping from names to samples, `t` first. `curves` holds every variable recorded."""

    segment: str | None
    line: int
    request: str
    overlay: bool
    rule: int
    scale: float
    t0: float
    tmax: float
    nn: int
    dt: float
    t: Floats
    curves: tuple[CurveData, ...]
    ended: str
    end_time: float
    steps: int
    rejected: int
    derivative_calls: int
    jacobian_calls: int
    dt_least: float
    """Smallest and largest step taken; 0 where there was none."""
    dt_most: float
    order: int
    """Of the last step under a rule 9 … 16; otherwise 0."""
    seconds: float
    parameters: dict[str, float] = field(default_factory=dict)
    """What the segment reads and does not change, as it was when the run began."""
    initial: dict[str, float] = field(default_factory=dict)
    """Values of the states then; here as there, elements of small arrays too."""
    continues: bool = False
    """Whether the states were where the run before had left them."""
    program: str = field(default="", metadata=IN_MEMORY)
    """The program's name."""
    state: Floats = field(default_factory=lambda: np.empty(0), metadata=IN_MEMORY)
    """All states as the run left them, in the order of `Model.states`: `initial` of another run."""
    error: DesireError | None = field(default=None, metadata=IN_MEMORY)
    """What ended the run early; None: it came to its end, or to a `term`."""
    warnings: tuple[Diagnostic, ...] = field(default=(), metadata=IN_MEMORY)
    points: tuple[PointSet, ...] = field(default=(), metadata=IN_MEMORY)
    """What was measured, which the program draws over its curves: `name`, `x_name`, `x`, `y`."""

    def __getitem__(self, name: str) -> Floats:
        """Return the samples of a variable, or of `t`; KeyError for one that was not recorded."""
        return samples(self, name)

    def __iter__(self) -> Iterator[str]:
        yield "t"
        yield from (curve.name for curve in curves_over_t(self))

    def __len__(self) -> int:
        return 1 + len(curves_over_t(self))

    def __repr__(self) -> str:
        return f"<Run{f' of {self.program}' if self.program else ''}: {self.summary}>"

    @property
    def summary(self) -> str:
        """One line: what was sampled, how it ended."""
        names = [name for name in self if name != "t"]
        shown = ", ".join(names[:6]) + (", …" if len(names) > 6 else "")
        of = f" of {shown}" if names else ""
        end = {"term": ", ended by term", "stopped": ", stopped", "failed": ", failed"}.get(self.ended, "")
        return (
            f"{len(self.t)} samples{of}, t = {self.t0:g} … {self.end_time:g}{end}; "
            f"rule {self.rule}, {self.steps} steps"
        )

    def check(self) -> Run:
        """Return the run. DesireError: what ended it early."""
        if self.error is not None:
            raise self.error
        return self

    def to_dataframe(self) -> pd.DataFrame:
        """Return the samples as a pandas table over `t`. ImportError: pandas is not installed."""
        from desire_tui.engine.outputs.tables import dataframe

        return dataframe(self)

    def to_xarray(self) -> xr.Dataset:
        """Return the samples as an xarray data set over `t`. ImportError: xarray is not installed."""
        from desire_tui.engine.outputs.tables import dataset

        return dataset(self)

    def plot(self, *names: str, ax: Axes | None = None, **style: Any) -> Axes:
        """Draw curves with matplotlib, all or those named, and return the axes.

        Over t, or as the program's `dispxy` says. `style` goes to `Axes.plot`.
        """
        from desire_tui.engine.outputs.run_plot import plot_run

        return plot_run(self, names, ax, style)

    def _repr_png_(self) -> bytes:
        from desire_tui.engine.outputs.run_plot import run_png

        return run_png((self,))

    def _repr_html_(self) -> str:
        from desire_tui.engine.outputs.run_plot import run_html

        return run_html((self,), repr(self), {**self.parameters})
