"""Runs with their derivatives at the times of measurements.

Where all times are steps of one grid, the run is sampled there. Otherwise it is sampled densely, and cubics
through four samples give the values between; the same weights give their derivatives.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.fit.measurements import DataSet
    from desire_tui.api.sensitive_runs import SensitiveRun, SensitiveRuns

    Floats = NDArray[np.float64]

_GRID_MOST = 20_000
_SAMPLES_LEAST = 501
_DENSER = 8
_SAME = 1e-7
"""Part of a step of the grid by which times may be beside it."""


class FailedRunError(Exception):
    """A run ended early; `error` says why."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.error = error


class Predicted(NamedTuple):
    """What a run says about measurements: `values` (numbers), `derivatives` (parameters, numbers)."""

    values: Floats
    derivatives: Floats


class Curves:
    """The runs of one data set; `span` is the program's own, `step` its DT where that is constant, else 0."""

    def __init__(
        self, runs: SensitiveRuns, data: DataSet, quantities: Sequence[str], span: tuple[float, float],
        fixed: Mapping[str, float], step: float,
    ) -> None:  # fmt: skip
        self._runs, self.data, self.quantities = runs, data, quantities
        self._fixed = {**fixed, **data.settings}
        times = np.unique(np.concatenate([one.t for one in data.measured]))
        end = min(max(times[-1], span[0] + 1e-3 * (span[1] - span[0])), span[1])
        self._samples_most = _GRID_MOST
        if step > 0.0:  # whole steps, none of which is longer than the time between samples
            steps = max(int(np.ceil((end - span[0]) / step - 1e-6)), 1)
            end, self._samples_most = span[0] + steps * step, steps + 1
        self._span = span[0], float(end)
        dense = min(max(_SAMPLES_LEAST, _DENSER * len(times)), _GRID_MOST)
        if step > 0.0 and self._samples_most <= _GRID_MOST:
            dense = self._samples_most
        self._samples = _grid(times, self._span, step) or dense
        self._known: tuple[Floats, list[tuple[NDArray[np.intp], Floats]]] | None = None
        self._last: tuple[dict[str, float], SensitiveRun] | None = None

    def run(self, values: Mapping[str, float]) -> SensitiveRun:
        """Make the run with these values. FailedRunError: it ends early."""
        given = {**self._fixed, **values}
        if self._last is None or self._last[0] != given:
            made = self._runs(given, samples=self._samples, t=self._span)
            if made.error is not None:
                raise FailedRunError(made.error)
            self._last = given, made
        return self._last[1]

    @property
    def last(self) -> SensitiveRun | None:
        """The last run made, None before the first."""
        return None if self._last is None else self._last[1]

    def drawn(self, values: Mapping[str, float], samples: int) -> SensitiveRun:
        """Make a run whose curves are smooth to look at; one that fails is drawn as far as it comes."""
        given = {**self._fixed, **values}
        return self._runs(given, samples=min(max(samples, self._samples), self._samples_most), t=self._span)

    def at_measurements(self, values: Mapping[str, float]) -> list[Predicted]:
        """Return values and derivatives where something was measured, for each pair. FailedRunError."""
        made = self.run(values)
        found = []
        for quantity, (places, weights) in zip(self.quantities, self._weights(made.t), strict=True):
            number = made.names.index(quantity)
            curve, derivatives = made.values[number], made.derivatives[:, number]
            found.append(Predicted(
                np.einsum("ij,ij->i", curve[places], weights),
                np.einsum("kij,ij->ki", derivatives[:, places], weights),
            ))  # fmt: skip
        return found

    def _weights(self, t: Floats) -> list[tuple[NDArray[np.intp], Floats]]:
        if self._known is None or not np.array_equal(self._known[0], t):
            self._known = t, [cubic_weights(t, one.t) for one in self.data.measured]
        return self._known[1]


def _grid(times: Floats, span: tuple[float, float], step: float) -> int | None:
    """Return the number of samples of the coarsest grid from the run's start that holds all times."""
    since = times - span[0]
    whole = span[1] - span[0]
    apart = np.diff(np.concatenate([[0.0], since]))
    apart = apart[apart > _SAME * whole]
    if not len(apart):
        return None
    for part in range(1, 11):
        h = apart.min() / part
        count: int = round(float(whole / h))
        if count > _GRID_MOST:
            return None
        h = whole / max(count, 1)
        is_on_grid = np.abs(since / h - np.round(since / h)).max() < 1e-6
        if is_on_grid and (step == 0.0 or _is_whole(h / step)):
            return count + 1
    return None


def _is_whole(multiple: float) -> bool:
    return round(multiple) >= 1 and abs(multiple - round(multiple)) < 1e-6


def cubic_weights(t: Floats, wanted: Floats) -> tuple[NDArray[np.intp], Floats]:
    """Return for each time wanted the numbers of four samples, and the weights of Lagrange's cubic there."""
    count = min(4, len(t))
    right = np.clip(np.searchsorted(t, wanted) - count // 2, 0, len(t) - count)
    places = right[:, None] + np.arange(count)
    nodes = t[places]
    weights = np.ones(nodes.shape)
    for j in range(count):
        for k in range(count):
            if k != j:
                apart = nodes[:, j] - nodes[:, k]
                weights[:, j] *= (wanted - nodes[:, k]) / np.where(apart == 0.0, np.inf, apart)
    return places, weights
