"""From samples to the numbers that are kept: the same operations for one run and for many at once.

Sums are taken in the order of the samples, so that a run gives the same bits however many stand beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.studies.keep import slices

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.studies.keep import Kept

    Floats = NDArray[np.float64]

_ROUNDING = 1e-9
"""Of a communication interval: a time this near to a sample is at it."""


def reduce(items: Sequence[Kept], t: Floats, columns: Sequence[Floats], counts: NDArray[np.intp]) -> Floats:
    """Return what is kept: (runs, numbers).

    `t` and the items' `columns` are (samples, runs); of run k the first `counts[k]` samples are meant, at
    least one. What stands behind them is not looked at.
    """
    with np.errstate(all="ignore"):  # numbers behind a run's end are anything
        return _reduced(items, t, columns, counts)


def _reduced(items: Sequence[Kept], t: Floats, columns: Sequence[Floats], counts: NDArray[np.intp]) -> Floats:
    samples, runs = t.shape
    made = np.empty((runs, sum(item.size for item in items)))
    lanes, last = np.arange(runs), counts - 1
    behind = np.arange(samples)[:, None] >= counts if counts.min() < samples else None
    for (item, place), values in zip(slices(items), columns, strict=True):
        match item.kind:
            case "last":
                made[:, place] = values[last, lanes][:, None]
            case "first":
                made[:, place] = values[0][:, None]
            case "max" | "min":
                nothing = -np.inf if item.kind == "max" else np.inf
                some = values if behind is None else np.where(behind, nothing, values)
                made[:, place] = (some.max(axis=0) if item.kind == "max" else some.min(axis=0))[:, None]
            case "mean":
                made[:, place] = _mean(values, counts, lanes)[:, None]
            case "std":
                squares = (values - _mean(values, counts, lanes)) ** 2
                made[:, place] = np.sqrt(_mean(squares, counts, lanes))[:, None]
            case "integral":
                made[:, place] = _integral(t, values, last, lanes)[:, None]
            case "when":
                made[:, place] = _first_time(t, values > 0.0, behind, lanes)[:, None]
            case "at":
                made[:, place] = _at(np.array(item.times), t, values, counts)
    return made


def _mean(values: Floats, counts: NDArray[np.intp], lanes: NDArray[np.intp]) -> Floats:
    """Return the means of each run's first `counts` samples."""
    mean: Floats = np.add.accumulate(values, axis=0)[counts - 1, lanes] / counts
    return mean


def _integral(t: Floats, values: Floats, last: NDArray[np.intp], lanes: NDArray[np.intp]) -> Floats:
    """Return the areas under straight lines between the samples."""
    if len(t) == 1:
        return np.zeros(len(lanes))
    areas = 0.5 * (values[1:] + values[:-1]) * (t[1:] - t[:-1])
    totals = np.add.accumulate(areas, axis=0)
    return np.where(last > 0, totals[np.maximum(last - 1, 0), lanes], 0.0)


def _first_time(
    t: Floats, holds: NDArray[np.bool_], behind: NDArray[np.bool_] | None, lanes: NDArray[np.intp]
) -> Floats:
    """Return the times of the first samples for which a condition holds; nan where it never does."""
    if behind is not None:
        holds = holds & ~behind
    first = holds.argmax(axis=0)
    return np.where(holds[first, lanes], t[first, lanes], np.nan)


def _at(times: Floats, t: Floats, values: Floats, counts: NDArray[np.intp]) -> Floats:
    """Return values at times, on straight lines between samples; nan outside of the run."""
    made = np.empty((t.shape[1], len(times)))
    shared = bool(counts.min() == len(t)) and bool((t == t[:, :1]).all())
    for run in range(1 if shared else t.shape[1]):
        which = slice(None) if shared else slice(run, run + 1)
        own, y = t[: counts[run], run], values[: counts[run], which]
        if len(own) > 1 and own[-1] < own[0]:  # a run backward
            own, y = own[::-1], y[::-1]
        step = (own[-1] - own[0]) / max(len(own) - 1, 1)
        near = np.clip(np.searchsorted(own, times - _ROUNDING * step, side="left"), 0, len(own) - 1)
        left = np.maximum(near - 1, 0)
        at_sample = np.abs(own[near] - times) <= _ROUNDING * step
        inside = (times >= own[0]) & (times <= own[-1])
        width = np.where(near > left, own[near] - own[left], 1.0)
        part = ((times - own[left]) / width)[:, None]
        lines = y[left] + part * (y[near] - y[left])
        found = np.where(at_sample[:, None], y[near], np.where(inside[:, None], lines, np.nan))
        made[which] = found.T
    return made
