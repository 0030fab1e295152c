"""Nonlinear least squares with exact derivatives (scipy's trust region), estimated weights, robust losses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.fit.curves import FailedRunError
from desire_tui.analysis.libraries import needed
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.fit.curves import Curves
    from desire_tui.analysis.unknowns import Unknown

    Floats = NDArray[np.float64]

WHAT = "a fit"
_FAR = 1e8
"""Residual where a run fails, in standard deviations."""
_ROUNDS = 3
_MAD = 1.4826
"""A normal distribution's standard deviation over its median absolute deviation."""


class StoppedError(Exception):
    """The user ended the fit."""


@dataclass
class Problem:
    """Residuals and their derivatives as functions of z: the unknowns, logarithms of those on such a scale.

    `sigma` are the standard deviations of the pairs: numbers that are estimated where none are given.
    """

    unknowns: Sequence[Unknown]
    curves: Sequence[Curves]
    go_on: Callable[[Problem], bool]
    runs_most: int
    sigma: list[float] = field(default_factory=list)
    runs: int = 0
    best: float = np.inf
    best_z: Floats = field(default_factory=lambda: np.empty(0))
    _last: tuple[Floats, Floats, Floats] | None = None
    _size: int = 0

    def __post_init__(self) -> None:
        """Begin with the spread of what was measured as its standard deviation."""
        self.log = np.array([one.is_log for one in self.unknowns])
        measured = [
            [curves.data.measured[k] for curves in self.curves]
            for k in range(len(self.curves[0].data.measured))
        ]
        for sets in measured:
            everything = np.concatenate([one.y for one in sets])
            self.sigma.append(float(np.std(everything)) or float(np.abs(everything).max()) or 1.0)
        self._given = [all(one.sigma is not None for one in sets) for sets in measured]
        self._size = sum(curves.data.count for curves in self.curves)

    @property
    def estimates_sigma(self) -> bool:
        """Whether any standard deviation is estimated from the residuals."""
        return not all(self._given)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """Bounds of z."""
        low, high = (np.array([getattr(one, end) for one in self.unknowns]) for end in ("low", "high"))
        return self.z_of(low), self.z_of(high)

    def z_of(self, values: Floats) -> Floats:
        """Return z of values."""
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = np.log(np.maximum(values, 0.0))
        return np.where(self.log, logs, values)

    def values(self, z: Floats) -> dict[str, float]:
        """Return values by name."""
        numbers = np.where(self.log, np.exp(np.where(self.log, np.minimum(z, 700.0), 0.0)), z)
        return {one.name: float(number) for one, number in zip(self.unknowns, numbers, strict=True)}

    def raw(self, z: Floats) -> list[tuple[int, Floats, Floats, Floats]]:
        """Return pair, residuals y - model, standard deviations, derivatives of the model by z."""
        values = self.values(z)
        by_z = np.where(self.log, [values[one.name] for one in self.unknowns], 1.0)[:, None]
        found = []
        for curves in self.curves:
            self.runs += 1
            for pair, (one, made) in enumerate(
                zip(curves.data.measured, curves.at_measurements(values), strict=True)
            ):
                sigma = np.full(len(one.t), self.sigma[pair]) if one.sigma is None else one.sigma
                found.append((pair, one.y - made.values, sigma, made.derivatives * by_z))
        return found

    def residuals(self, z: Floats) -> Floats:
        """Return (model - measured)/sigma; far away where a run fails."""
        if self._last is None or not np.array_equal(self._last[0], z):
            if self.runs >= self.runs_most or not self.go_on(self):
                raise StoppedError
            try:
                parts = self.raw(z)
                residuals = np.concatenate([-rest / sigma for _, rest, sigma, _ in parts])
                jacobian = np.concatenate([(slopes / sigma).T for _, _, sigma, slopes in parts])
            except FailedRunError:
                residuals, jacobian = np.full(self._size, _FAR), np.zeros((self._size, len(z)))
            bad = ~np.isfinite(residuals)
            residuals[bad] = _FAR
            jacobian[~np.isfinite(jacobian)] = 0.0
            self._last = np.array(z), residuals, jacobian
            total = float(residuals @ residuals)
            if total < self.best:
                self.best, self.best_z = total, np.array(z)
        return self._last[1]

    def jacobian(self, z: Floats) -> Floats:
        """Return the derivatives of the residuals, (numbers, unknowns)."""
        self.residuals(z)
        assert self._last is not None
        return self._last[2]

    def estimate_sigma(self, z: Floats, *, robust: bool) -> None:
        """Take the residuals' own size for the standard deviations that are not given."""
        parts = self.raw(z)
        free = len(z) / max(len(self.sigma), 1)
        for pair, is_given in enumerate(self._given):
            rest = np.concatenate([r for p, r, _, _ in parts if p == pair])
            if is_given or not len(rest):
                continue
            if robust:
                size = _MAD * float(np.median(np.abs(rest)))
            else:
                size = float(np.sqrt(rest @ rest / max(len(rest) - free, 1.0)))
            self.sigma[pair] = size or self.sigma[pair] * 1e-12
        self._last, self.best = None, np.inf


@dataclass(frozen=True)
class Solution:
    """Where the search has ended: z, whether it converged, and what scipy says."""

    z: Floats
    converged: bool
    said: str


def solve(problem: Problem, start: Floats, loss: str) -> Solution:
    """Look for the least sum of squares. StoppedError: the user, or `runs_most`, ended it; see `best_z`."""
    least_squares = needed("scipy.optimize", WHAT).least_squares
    low, high = problem.bounds
    z = np.clip(start, np.nextafter(low, high), np.nextafter(high, low))
    rounds = _ROUNDS if problem.estimates_sigma and (loss != "linear" or len(problem.sigma) > 1) else 1
    found = None
    for turn in range(rounds):
        if turn:
            problem.estimate_sigma(z, robust=loss != "linear")
        found = least_squares(
            problem.residuals, z, problem.jacobian, bounds=(low, high), x_scale="jac",
            loss=loss if turn or rounds == 1 else "soft_l1" if loss != "linear" else "linear",
            ftol=1e-11, xtol=1e-9, gtol=1e-11, f_scale=1.0, max_nfev=problem.runs_most,
        )  # fmt: skip
        z = np.asarray(found.x, dtype=np.float64)
    assert found is not None
    return Solution(z, bool(found.status > 0), str(found.message))
