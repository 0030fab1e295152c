"""Results as files: JSON, CSV, NPZ."""

from __future__ import annotations

import json
import math
from dataclasses import fields, is_dataclass
from typing import IO, TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from desire_tui.engine.outputs.results import Result

_CSV_ROWS = 10_000  # rows turned to text at a time


def as_json(result: Result) -> str:
    """Return a result as one JSON object; inf and nan as strings, complex numbers as [re, im]."""
    return json.dumps(_plain(result), ensure_ascii=False, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        if np.iscomplexobj(value):
            return _plain(np.stack([value.real, value.imag], axis=-1))
        return value.tolist() if np.isfinite(value).all() else _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, complex):
        return [_plain(value.real), _plain(value.imag)]
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
    return value


def write_csv(result: Result, file: IO[str]) -> None:
    """Write one row for each sample: `run, t, names…`; empty where a run did not show a variable."""
    shown = dict.fromkeys(curve.name for run in result.runs for curve in run.curves)
    names = [name for name in shown if name != "t"]  # it has its column
    file.write(",".join(["run", "t", *(_quoted(name) for name in names)]) + "\n")
    for number, run in enumerate(result.runs, 1):
        have = {curve.name: curve.values for curve in run.curves}
        columns = [have.get(name) for name in names]
        for first in range(0, len(run.t), _CSV_ROWS):
            part = slice(first, first + _CSV_ROWS)
            texts = [_texts(run.t[part]), *(_texts(c[part]) if c is not None else None for c in columns)]
            for row in range(len(run.t[part])):
                cells = (text[row] if text is not None else "" for text in texts)
                file.write(f"{number},{','.join(cells)}\n")


def write_npz(result: Result, file: IO[bytes]) -> None:
    """Write an archive for `numpy.load`: `1/t`, `1/x` … are samples of run 1, `final/x` … final values."""
    arrays = {f"final/{name}": np.asarray(value) for name, value in result.quantities.items()}
    for number, run in enumerate(result.runs, 1):
        arrays[f"{number}/t"] = run.t
        arrays |= {f"{number}/{curve.name}": curve.values for curve in run.curves}
    np.savez(file, **arrays)  # type: ignore[arg-type]  # its stub takes the first name for allow_pickle


def _texts(values: Any) -> list[str]:
    return [repr(value) for value in values.tolist()]


def _quoted(name: str) -> str:
    return f'"{name}"' if "," in name else name
