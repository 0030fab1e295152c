"""`histogram x`: how often values come; `average x`: means with the confidence that their samples allow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.signals import read
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
_WINDOW = 5.0
"""The autocorrelation is summed up to so many times its own sum (Sokal 1997)."""
_NORMAL_95 = 1.959963984540054
_FEW = 50.0


def histogram(subject: Subject, request: str, progress: Progress) -> Result:
    """Return how values are distributed. DesireError: see `Request`, `read.columns`."""
    asked = Request(request, "histogram x bins 40 from 10")
    names, bins, start = read.names(asked), None, None
    while not asked.is_done:
        if asked.expect("bins", "from") == "from":
            start = asked.number("a time")
        else:
            bins = asked.whole(1, "bins 40")
    progress(None, "run")
    _, samples = read.columns(subject, names, start)
    charts, values, rows = [], {}, []
    for name, x in zip(names, samples, strict=True):
        counts, edges = np.histogram(x, bins if bins is not None else "fd" if np.ptp(x) > 0 else 1)
        density = counts / (len(x) * np.diff(edges))
        values[name] = {"edges": edges, "density": density}
        sides = np.repeat(edges, 2)
        heights = np.concatenate([[0.0], np.repeat(density, 2), [0.0]])
        charts.append(Chart(f"Distribution of {name}", name, "density", [Series(name, sides, heights)]))
        rows.append([float(x.min()), *np.quantile(x, _QUANTILES).tolist(), float(x.max())])
    heads = ["least", *(f"{100 * q:g} %" for q in _QUANTILES), "greatest"]
    table = Table("", {"": names, **dict(zip(heads, map(list, zip(*rows, strict=True)), strict=True))})
    return Result(f"Distribution of {', '.join(names)}, {subject.name}", values, [table], charts)


def average(subject: Subject, request: str, progress: Progress) -> Result:
    """Return means with 95 % intervals; samples that follow each other count for less than independent ones.

    DesireError: see `Request`, `read.columns`.
    """
    asked = Request(request, "average x, y from 10")
    names = read.names(asked)
    start = asked.number("a time") if not asked.is_done and asked.expect("from") else None
    asked.end()
    progress(None, "run")
    t, samples = read.columns(subject, names, start)
    step = float(t[-1] - t[0]) / (len(t) - 1)
    rows: dict[str, list[float]] = {
        head: [] for head in ("mean", "± 95 %", "deviation", "rms", "correlation time", "independent")
    }
    notes = []
    for name, x in zip(names, samples, strict=True):
        times = correlation_time(x)
        independent = len(x) / times
        deviation = float(x.std(ddof=1))
        margin = _NORMAL_95 * deviation / np.sqrt(independent)
        found = (
            float(x.mean()),
            margin,
            deviation,
            float(np.sqrt(np.mean(x * x))),
            step * times,
            independent,
        )
        for column, value in zip(rows.values(), found, strict=True):
            column.append(value)
        if independent < _FEW and deviation > 0:
            notes.append(
                f"{name}: {independent:.3g} independent samples are too few for its interval to be trusted"
            )
    values = {name: {head: column[k] for head, column in rows.items()} for k, name in enumerate(names)}
    return Result(
        f"Averages from t = {t[0]:g} to {t[-1]:g}, {subject.name}", values, [Table("", {"": names, **rows})],
        notes=notes,
    )  # fmt: skip


def correlation_time(x: Floats) -> float:
    """Return how many samples count as one: 1 + 2 times the sum of the autocorrelation (Sokal 1997).

    By the fast Fourier transform of the samples, twice as long as they are so that their ends do not meet.
    """
    centred = x - x.mean()
    if not np.any(centred):
        return 1.0
    spectrum = np.fft.rfft(centred, 2 * len(x))
    correlation = np.fft.irfft(np.abs(spectrum) ** 2)[: len(x)]
    sums = 2.0 * np.cumsum(correlation / correlation[0]) - 1.0
    enough = np.flatnonzero(np.arange(len(x)) >= _WINDOW * sums)
    return float(min(max(sums[enough[0] if len(enough) else -1], 1.0), len(x)))
