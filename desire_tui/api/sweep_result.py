"""What a sweep keeps of each run, and all of it as an xarray data set."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.outputs.results import run_data
from desire_tui.engine.outputs.tables import needed

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.prepared_run import PreparedRun

    Floats = NDArray[np.float64]
    Keep = str | Callable[[Run], "float | Mapping[str, Any]"]

CURVES, STATE = "curves", "state"
REDUCTIONS: dict[str, Callable[[Floats], Floats]] = {
    "last": lambda samples: samples[-1],
    "max": lambda samples: samples.max(axis=0),
    "min": lambda samples: samples.min(axis=0),
    "mean": lambda samples: samples.mean(axis=0),
}
"""Of samples in columns one number for each column."""


class Kept(NamedTuple):
    """Of one run: its times where whole curves are kept, numbers or curves by name, what made it fail."""

    t: Floats | None
    values: Mapping[str, Any]
    message: str = ""


def checked_keep(keep: Keep) -> Keep:
    """Return what is to be kept. ValueError, TypeError: there is no such thing."""
    if isinstance(keep, str):
        known = (CURVES, *REDUCTIONS, STATE)
        if keep not in known:
            near = closest(keep, known)
            hint = f"did you mean {near!r}?" if near else f"there are {', '.join(map(repr, known))}"
            raise ValueError(f"keep={keep!r} is unknown; {hint}")
    elif not callable(keep):
        raise TypeError(f"keep is a word or a function of a run, not {keep!r}")
    return keep


def kept_of(record: RunRecord, keep: Keep, prepared: PreparedRun, program: str) -> Kept:
    """Return what is kept of a run."""
    if not isinstance(keep, str):
        found = keep(run_data(record, more=True, program=program, state=prepared.state()))
        return Kept(None, found if isinstance(found, Mapping) else {"kept": found})
    if keep == STATE:
        return Kept(None, dict(zip(prepared.state_names(), prepared.state().tolist(), strict=True)))
    columns: dict[str, int] = {}
    for number, column in enumerate(record.columns, 1):
        if column.name != "t":
            columns.setdefault(column.name, number)
    samples = record.rows[: record.count, list(columns.values())]  # copies
    if keep == CURVES:
        return Kept(record.rows[: record.count, 0].copy(), dict(zip(columns, samples.T, strict=True)))
    return Kept(None, dict(zip(columns, REDUCTIONS[keep](samples).tolist(), strict=True)))


def data_set(
    axes: Mapping[str, Floats], fixed: Mapping[str, float], kept: Sequence[Kept], program: str
) -> xr.Dataset:
    """Return everything over the varied parameters; NaN and a `message` where a run failed.

    A parameter that is kept as well, such as a state's start, is the dimension `x(0)`.
    """
    xarray = needed("xarray")
    names = dict.fromkeys(name for one in kept for name in one.values)
    axes = {f"{name}(0)" if name in names else name: axis for name, axis in axes.items()}
    shape, over = tuple(map(len, axes.values())), tuple(axes)
    longest = max((one.t for one in kept if one.t is not None), key=len, default=None)
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = dict(axes)
    inner: tuple[str, ...] = ()
    if longest is not None:
        is_common = all(one.t is None or np.array_equal(one.t, longest[: len(one.t)]) for one in kept)
        inner = ("t",) if is_common else ("sample",)
        if is_common:
            coordinates["t"] = longest
        else:
            times = [one.t for one in kept]
            variables["t"] = (over + inner, _filled(times, (len(longest),)).reshape(*shape, -1))
    for name in names:
        values = [None if one.message else one.values.get(name) for one in kept]
        size = (len(longest),) if longest is not None else _size(values)
        dims = over + (inner or tuple(f"{name}_{k}" for k in range(len(size))))
        variables[name] = (dims, _filled(values, size).reshape(shape + size))
    variables["message"] = (over, np.array([one.message for one in kept], dtype=object).reshape(shape))
    made: xr.Dataset = xarray.Dataset(variables, coordinates, {"program": program, **fixed})
    return made


def _size(values: Sequence[Any]) -> tuple[int, ...]:
    return next((np.shape(value) for value in values if value is not None), ())


def _filled(values: Sequence[Any], size: tuple[int, ...]) -> Floats:
    """Return rows of numbers, what is missing at their ends as NaN."""
    filled = np.full((len(values), *size), np.nan)
    for row, value in enumerate(values):
        if value is not None:
            filled[row, ...][tuple(map(slice, np.shape(value)))] = value
    return filled
