"""A study's result as a file: NetCDF, or a table of comma-separated values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.atomic_file import replacing
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

ENDINGS = (".nc", ".csv", ".zarr")
_ROWS = 100_000
"""Of a table that are made at once."""


def check_ending(path: Path) -> None:
    """DesireError 510: no format has this ending; 106: nothing can be written there."""
    if path.suffix not in ENDINGS:
        facts = {"what": f"{path} is no file for a study", "remedy": "end its name with .nc, .csv or .zarr"}
        raise DesireError(Diagnostic("study-form", None, facts))
    if not path.absolute().parent.is_dir():
        raise DesireError(
            Diagnostic("file-unwritable", None, {"path": str(path), "reason": "there is no such folder"})
        )


def write(result: Any, path: Path) -> None:
    """Write a Dataset as the path's ending says. DesireError 106."""
    if path.suffix == ".zarr" and path.exists():
        facts = {"path": str(path), "reason": "it is there already"}
        raise DesireError(Diagnostic("file-unwritable", None, facts))
    try:
        if path.suffix == ".nc":
            _write_netcdf(result, path)
        elif path.suffix == ".zarr":
            result.to_zarr(path, mode="w-", consolidated=False)
        else:
            _write_csv(result, path)
    except OSError as error:
        facts = {"path": str(path), "reason": error.strerror or str(error)}
        raise DesireError(Diagnostic("file-unwritable", None, facts)) from None


def _write_netcdf(result: Any, path: Path) -> None:
    renamed = result.rename({name: name.replace("/", "÷") for name in result.variables if "/" in name})
    content = renamed.to_netcdf(None, engine="scipy", format="NETCDF3_64BIT")
    with replacing(str(path), "wb") as file:
        file.write(content)


def _write_csv(result: Any, path: Path) -> None:
    """Write a line for each run, the numbers over times side by side: `y@0.5`."""
    with replacing(str(path), "w") as file:
        for number, table in enumerate(_tables(result)):
            table.to_csv(file, index=False, header=number == 0)


def _tables(result: Any) -> Iterator[Any]:
    """Yield the runs as tables, some at a time."""
    import numpy as np
    import pandas as pd

    shape = result["error"].shape
    dimensions = result["error"].dims
    for first in range(0, result["error"].size, _ROWS):
        numbers = np.arange(first, min(first + _ROWS, result["error"].size))
        places = dict(zip(dimensions, np.unravel_index(numbers, shape), strict=True))
        columns: dict[str, Any] = {"run": numbers}
        for name, values in result.coords.items():
            if values.dims and values.dims[0] in places and str(name) != "run":
                columns[str(name)] = values.values[places[values.dims[0]]]
        for name, values in result.data_vars.items():
            rows = values.values.reshape(result["error"].size, -1)[numbers]
            if values.dims == dimensions:
                columns[str(name)] = rows[:, 0]
            else:
                times = result[values.dims[-1]].values
                stem = str(name).partition("@")[0]
                columns |= {f"{stem}@{t:.12g}": rows[:, k] for k, t in enumerate(times)}
        yield pd.DataFrame(columns)


def summary(result: Any) -> list[str]:
    """Return lines that say what came out: how many runs have a quantity, its least, mean, largest number."""
    import numpy as np

    runs = result["error"].size
    lines = [f"{'':24} {'runs':>9} {'min':>14} {'mean':>14} {'max':>14}"]
    for name, values in result.data_vars.items():
        if name == "error":
            continue
        numbers = np.asarray(values.values)
        good = numbers[np.isfinite(numbers)]
        having = np.isfinite(numbers.reshape(runs, -1)).any(axis=1).sum()
        three = (good.min(), good.mean(), good.max()) if good.size else ()
        told = " ".join(f"{number:14.7g}" for number in three) or " ".join([f"{'–':>14}"] * 3)
        lines.append(f"{name!s:24} {having:9} {told}")
    return lines
