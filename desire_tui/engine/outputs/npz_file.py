"""Results as an archive of NumPy arrays."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from desire_tui.engine.outputs.results import Result


def write_npz(result: Result, file: IO[bytes]) -> None:
    """Write an archive for `numpy.load`: `1/t`, `1/x` … are samples of run 1, `final/x` … final values.

    `parameters/c`, `initial/x`: what each run started with, one number for each; nan where it has none.
    `segment`: their labels, empty without one. `points/x`, `points/y`, `points/color`: what `plot` drew.
    """
    arrays = {f"final/{name}": np.asarray(value) for name, value in result.quantities.items()}
    for number, run in enumerate(result.runs, 1):
        arrays[f"{number}/t"] = run.t
        arrays |= {f"{number}/{curve.name}": curve.values for curve in run.curves}
    for kind in ("parameters", "initial"):
        starts: list[dict[str, float]] = [getattr(run, kind) for run in result.runs]
        for name in dict.fromkeys(name for start in starts for name in start):
            arrays[f"{kind}/{name}"] = np.array([start.get(name, np.nan) for start in starts])
    arrays["segment"] = np.array([run.segment or "" for run in result.runs], dtype=str)
    for part in ("x", "y", "color"):
        arrays[f"points/{part}"] = np.array([getattr(point, part) for point in result.plots])
    np.savez(file, **arrays)  # type: ignore[arg-type]  # its stub takes the first name for allow_pickle
