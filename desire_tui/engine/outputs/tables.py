"""Samples of runs as pandas tables and xarray data sets."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from desire_tui.engine.outputs.sampled_run import SampledRun, curves_over_t

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    import xarray as xr


def needed(library: str) -> Any:
    """Import a library that is not installed with this one. ImportError: how to install it."""
    try:
        return import_module(library)
    except ImportError:
        raise ImportError(
            f"{library} is not installed; this needs it: pip install 'desire-tui[data]'", name=library
        ) from None


def dataframe(run: SampledRun) -> pd.DataFrame:
    """Return a run's samples, indexed by t."""
    pandas = needed("pandas")
    index = pandas.Index(run.t, name="t")
    table: pd.DataFrame = pandas.DataFrame({c.name: c.values for c in curves_over_t(run)}, index=index)
    table.attrs.update(run.parameters)
    return table


def dataframe_of_runs(runs: Sequence[SampledRun]) -> pd.DataFrame:
    """Return the samples of several runs below one another, indexed by run (from 1) and t."""
    pandas = needed("pandas")
    table: pd.DataFrame = pandas.concat(
        [dataframe(run) for run in runs] or [pandas.DataFrame()],
        keys=range(1, len(runs) + 1) if runs else None,
        names=["run", "t"] if runs else None,
    )
    table.attrs.clear()
    return table


def dataset(run: SampledRun) -> xr.Dataset:
    """Return a run's samples with the coordinate t; parameters and what began it are attributes."""
    xarray = needed("xarray")
    variables = {c.name: ("t", c.values) for c in curves_over_t(run)}
    started = {f"{name}(0)": value for name, value in run.initial.items()}
    made: xr.Dataset = xarray.Dataset(variables, {"t": run.t}, {**run.parameters, **started})
    return made
