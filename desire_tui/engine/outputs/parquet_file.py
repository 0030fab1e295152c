"""Samples of runs as Parquet: the table of the CSV file, with types."""

from __future__ import annotations

import json
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.outputs.csv_file import columns_of

if TYPE_CHECKING:
    from desire_tui.engine.outputs.results import Result


def write_parquet(result: Result, file: IO[bytes]) -> None:
    """Write one row for each sample, columns as in CSV; null where a run has no value.

    The key `desire` of its metadata is a JSON object: program and version, and of each run segment, rule,
    parameters and starts.
    """
    import pyarrow as pa

    runs = result.runs
    names, varied = columns_of(runs)
    counts = [len(run.t) for run in runs]
    empty = np.empty(0)
    columns = {
        "run": np.repeat(np.arange(1, len(runs) + 1, dtype=np.int32), counts),
        "t": np.concatenate([empty, *(run.t for run in runs)]),
    }
    for name in names:
        pieces = [{c.name: c.values for c in run.curves}.get(name) for run in runs]
        nothing = np.repeat([piece is None for piece in pieces], counts)
        numbers = [np.zeros(n) if a is None else a for a, n in zip(pieces, counts, strict=True)]
        columns[name] = pa.array(np.concatenate([empty, *numbers]), mask=nothing)
    for name, values in varied.items():
        kind = pa.string() if any(isinstance(value, str) for value in values) else pa.float64()
        columns[name] = pa.array(values, kind).take(np.repeat(np.arange(len(runs)), counts))
    about = {
        "desire": result.desire,
        "program": result.program,
        "runs": [
            {"segment": run.segment, "rule": run.rule, "parameters": run.parameters, "initial": run.initial}
            for run in runs
        ],
    }
    _write(pa.table(columns), about, file)


def write_points(result: Result, file: IO[bytes]) -> None:
    """Write the points of `plot`, one row each: `x, y, color`."""
    import pyarrow as pa

    points = result.plots
    columns = {
        "x": np.array([point.x for point in points], dtype=np.float64),
        "y": np.array([point.y for point in points], dtype=np.float64),
        "color": np.array([point.color for point in points], dtype=np.int32),
    }
    _write(pa.table(columns), {"desire": result.desire, "program": result.program}, file)


def _write(table: Any, about: dict[str, Any], file: IO[bytes]) -> None:
    from pyarrow import parquet

    described = table.replace_schema_metadata({"desire": json.dumps(about)})
    parquet.write_table(described, file)
