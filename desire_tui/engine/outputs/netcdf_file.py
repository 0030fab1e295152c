"""Results as NetCDF, which xarray, MATLAB, R, Julia and Panoply read."""

from __future__ import annotations

from io import BytesIO
from typing import IO, TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.outputs.results import PlotPoint, Result
    from desire_tui.engine.outputs.run import Floats, Run

_CLASSIC_64_BIT = 2


def write_netcdf(result: Result, file: IO[bytes]) -> None:
    """Write variables over `run` and `t`; where times differ, over `run` and `sample`, padded with nan.

    Over `run`: parameters, starts of states as `x(0)`, labels as `segment`. Over `point`: `plot_x`, `plot_y`,
    `plot_color`.
    """
    from scipy.io import netcdf_file

    made = BytesIO()  # the library closes what it is given
    data: Any = netcdf_file(made, "w", version=_CLASSIC_64_BIT)
    data.title, data.source = result.program.encode(), f"desire-tui {result.desire}".encode()
    if result.runs:
        _add_runs(data, result.runs)
    if result.plots:
        _add_points(data, result.plots)
    data.flush()
    file.write(made.getbuffer())


def _add_runs(data: Any, runs: Sequence[Run]) -> None:
    data.createDimension("run", len(runs))
    longest = max(runs, key=lambda run: len(run.t)).t
    same = all(np.array_equal(run.t, longest) for run in runs)
    samples = "t" if same else "sample"
    width = max(1, len(longest))  # of no samples: in this format 0 stands for a length that grows
    data.createDimension(samples, width)
    if same:
        _variable(data, "t", _padded([longest], width)[0], "t")
    else:
        _variable(data, "t", _padded([run.t for run in runs], width), "run", samples)
    nothing = np.empty(0)
    for name in dict.fromkeys(curve.name for run in runs for curve in run.curves):
        if name != "t":
            own = [next((c.values for c in run.curves if c.name == name), nothing) for run in runs]
            _variable(data, name, _padded(own, width), "run", samples)
    starts = [run.parameters | {f"{name}(0)": x for name, x in run.initial.items()} for run in runs]
    for name in dict.fromkeys(name for start in starts for name in start):
        if name not in data.variables:
            _variable(data, name, np.array([start.get(name, np.nan) for start in starts]), "run")
    _add_labels(data, [(run.segment or "").encode() for run in runs])


def _add_labels(data: Any, labels: list[bytes]) -> None:
    if "segment" in data.variables:
        return
    width = max(1, *map(len, labels))
    data.createDimension("letters", width)
    letters = np.array(labels, dtype=f"S{width}").view("S1").reshape(len(labels), width)
    data.createVariable("segment", "c", ("run", "letters"))[:] = letters


def _add_points(data: Any, points: Sequence[PlotPoint]) -> None:
    data.createDimension("point", len(points))
    for part in ("x", "y", "color"):
        numbers = np.array([getattr(point, part) for point in points], dtype=np.float64)
        _variable(data, f"plot_{part}", numbers, "point")


def _variable(data: Any, name: str, numbers: Floats, *dimensions: str) -> None:
    data.createVariable(name, "d", dimensions)[:] = numbers


def _padded(rows: Sequence[Floats], width: int) -> Floats:
    table = np.full((len(rows), width), np.nan)
    for place, row in enumerate(rows):
        table[place, : len(row)] = row
    return table
