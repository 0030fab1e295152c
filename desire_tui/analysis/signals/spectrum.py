"""`spectrum x`: power spectral density of a run's samples (Welch 1967), its peaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.libraries import needed
from desire_tui.analysis.request import Request
from desire_tui.analysis.result import Result, Table
from desire_tui.analysis.signals import read
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

EXAMPLE = "spectrum x window 256"
PEAKS_MOST = 8
_PARTS = 8
"""The run is divided into so many parts whose spectra are averaged, half overlapping."""
_PROMINENCE = 10.0
"""A peak is so many times higher than the valleys beside it,"""
_PERIODS_LEAST = 3
"""Of fewer periods in a window, the place of a peak says little."""
_ROUNDING = 1e-12
"""and so many times lower than the highest one at most: what is lower is rounding."""


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return the spectrum of each named quantity. DesireError: see `Request`, `sampled`."""
    names, window, start = _read(request)
    progress(None, "run")
    t, samples = read.columns(subject, names, start)
    step = float(t[-1] - t[0]) / (len(t) - 1)
    welch = needed("scipy.signal", "a spectrum").welch
    length = min(window or max(len(t) * 2 // (_PARTS + 1), min(len(t), 64)), len(t))
    series, tables, values, slow = [], [], {}, list[str]()
    for name, x in zip(names, samples, strict=True):
        frequency, density = welch(x, fs=1.0 / step, nperseg=length, detrend="constant")
        series.append(Series(name, frequency[1:], density[1:]))
        values[name] = {"frequency": frequency, "density": density}
        tables.append(_peaks(name, frequency, density))
        if int(np.argmax(density)) < _PERIODS_LEAST:
            longer = "a longer run" if length == len(t) else f"window {len(t)}, all samples"
            slow.append(
                f"{name}: its largest part is slower than {_PERIODS_LEAST} periods in a window: {longer}"
            )
    what = ", ".join(names)
    chart = Chart(f"Spectrum of {what}", "frequency", "power density", series, log_y=True)
    apart = f"frequencies to {0.5 / step:.6g}, {1.0 / (step * length):.3g} apart"
    notes = [f"{len(t)} samples, {step:g} apart: {apart} (Welch, windows of {length} samples)", *slow]
    return Result(f"Spectrum of {what}, {subject.name}", values, tables, [chart], notes)


def _read(request: str) -> tuple[list[str], int | None, float | None]:
    asked = Request(request, EXAMPLE)
    names, window, start = read.names(asked), None, None
    while not asked.is_done:
        if asked.expect("window", "from") == "from":
            start = asked.number("a time")
        else:
            window = asked.whole(8, "window 256")
    return names, window, start


def _peaks(name: str, frequency: Floats, density: Floats) -> Table:
    """Return the highest peaks; their places by a parabola through the logarithms of three values."""
    shown = np.log(np.maximum(density, _ROUNDING * density.max()))
    peaks, _ = needed("scipy.signal", "a spectrum").find_peaks(shown, prominence=np.log(_PROMINENCE))
    peaks = peaks[peaks > 1]  # the mean beside the first frequency is taken out
    highest = sorted(peaks[np.argsort(density[peaks])[::-1]][:PEAKS_MOST], key=lambda k: -density[k])
    step = frequency[1] - frequency[0]
    places = []
    for k in highest:
        left, middle, right = np.log(density[k - 1 : k + 2])
        places.append(float(frequency[k] + step * 0.5 * (left - right) / (left - 2.0 * middle + right)))
    power = [float(step * density[max(k - 2, 0) : k + 3].sum()) for k in highest]
    return Table(f"peaks of {name}", {
        "frequency": places, "period": [1.0 / place for place in places],
        "amplitude": [float(np.sqrt(2.0 * p)) for p in power],
    })  # fmt: skip
