"""What a fit shows: estimates, correlations, curves through points with their bands, residuals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.fit.estimates import LEVEL
from desire_tui.analysis.result import Result, Table
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.fit.curves import Curves
    from desire_tui.analysis.fit.estimates import Estimates
    from desire_tui.analysis.fit.request import Asked
    from desire_tui.analysis.fit.solve import Problem, Solution
    from desire_tui.analysis.subject import Subject
    from desire_tui.api.sensitive_runs import SensitiveRun

    Floats = NDArray[np.float64]

_SAMPLES_LEAST = 401
_AT_BOUND = 1e-6


@dataclass(frozen=True)
class Fitted:
    """A fit that has come to its end."""

    problem: Problem
    solution: Solution
    start: Floats
    residuals: Floats
    """In standard deviations."""
    estimates: Estimates


def sketch(subject: Subject, problem: Problem) -> Result:
    """Return what is known while the search goes on: the best values so far, curves through points."""
    values = problem.values(problem.best_z)
    table = Table("", {"": list(values), "so far": list(values.values())})
    charts = []
    for curves in problem.curves:
        made = curves.last
        if made is not None:
            charts += [
                Chart(f"{quantity} and {curves.data.name}", "t", quantity,
                      [points(curves, k), Series(quantity, made.t, made.values[made.names.index(quantity)])])
                for k, quantity in enumerate(curves.quantities)
            ]  # fmt: skip
    return Result(f"Fit of {', '.join(values)}, {subject.name}", dict(values), [table], charts)


def report(subject: Subject, asked: Asked, fitted: Fitted, notes: Sequence[str]) -> Result:
    """Return everything about a fit."""
    problem, judged, z = fitted.problem, fitted.estimates, fitted.solution.z
    values = problem.values(z)
    names = list(values)
    width = judged.factor * judged.errors
    low, high = ([problem.values(z + side * width)[name] for name in names] for side in (-1.0, 1.0))
    slopes = np.where(problem.log, list(values.values()), 1.0)
    errors = np.abs(slopes) * judged.errors
    told = [*_said(asked, fitted, values), *notes]
    table = Table("estimates", {
        "": names, "from": fitted.start.tolist(), "estimate": list(values.values()),
        "standard error": errors.tolist(), f"{LEVEL:.0%} from": low, "to": high,
    })  # fmt: skip
    tables = [table]
    if len(names) > 1:
        columns = {name: judged.correlations[:, k].tolist() for k, name in enumerate(names)}
        tables.append(Table("correlations", {"": names, **columns}))
    criteria = _criteria(fitted)
    tables.append(Table("", {"": list(criteria), "value": list(criteria.values())}))
    charts = [chart for curves in problem.curves for chart in _charts(curves, fitted, values)]
    found: dict[str, Any] = {
        **values,
        "errors": dict(zip(names, errors.tolist(), strict=True)),
        "intervals": {name: (a, b) for name, a, b in zip(names, low, high, strict=True)},
        "correlations": judged.correlations,
        "residuals": fitted.residuals,
        "converged": fitted.solution.converged,
        "runs": problem.runs,
        **criteria,
    }
    title = f"Fit of {', '.join(names)}, {subject.name} ({problem.runs} runs)"
    return Result(title, found, tables, charts, told)


def _said(asked: Asked, fitted: Fitted, values: dict[str, float]) -> list[str]:
    told = []
    if not fitted.solution.converged:
        told.append(f"no convergence: {fitted.solution.said}; begin nearer, or give bounds: k in [0, 10]")
    lost = fitted.estimates.undetermined
    if len(lost) == 1:
        told.append(f"{lost[0]} cannot be identified: it has no influence on the data there")
    elif lost:
        told.append(f"{', '.join(lost)} cannot be identified: the data determine combinations of them only")
    told += [
        f"{one.name} stands at its bound {end:g}: its interval means nothing"
        for one in asked.unknowns
        for end in (one.low, one.high)
        if np.isfinite(end) and abs(values[one.name] - end) <= _AT_BOUND * max(abs(end), 1.0)
    ]
    return told


def _criteria(fitted: Fitted) -> dict[str, float]:
    """Return how good a fit is, by Akaike's and Schwarz's criteria (Burnham and Anderson 2002, 2.2) too."""
    problem, judged = fitted.problem, fitted.estimates
    count, unknowns = len(fitted.residuals), len(problem.unknowns)
    sizes = {
        f"standard deviation of {pair}": problem.sigma[k]
        for k, pair in enumerate(problem.curves[0].quantities)
        if any(curves.data.measured[k].sigma is None for curves in problem.curves)
    }
    found = {**sizes, "chi^2": judged.chi2, "chi^2 per degree of freedom": judged.chi2 / judged.freedom}
    likelihood = judged.chi2
    estimated = 0
    if problem.estimates_sigma:
        estimated = len(problem.sigma)
        likelihood = count * np.log(max(judged.chi2 / count, 1e-300))
        likelihood += 2.0 * sum(
            len(one.t) * np.log(problem.sigma[k])
            for curves in problem.curves
            for k, one in enumerate(curves.data.measured)
            if one.sigma is None
        )
    k = unknowns + estimated
    found["AIC"] = float(likelihood + 2 * k)
    if count > k + 1:
        found["AICc"] = float(found["AIC"] + 2.0 * k * (k + 1) / (count - k - 1))
    found["BIC"] = float(likelihood + k * np.log(count))
    return found


def points(curves: Curves, pair: int) -> Series:
    """Return what was measured as points."""
    one = curves.data.measured[pair]
    return Series(f"{curves.quantities[pair]} measured", one.t, one.y, "points")


def _charts(curves: Curves, fitted: Fitted, values: dict[str, float]) -> list[Chart]:
    """Return residuals over t, and curves with points and bands: the last is what the desktop shows."""
    made = curves.drawn(values, _SAMPLES_LEAST)
    rest, charts = [], []
    for pair, (one, predicted) in enumerate(
        zip(curves.data.measured, curves.at_measurements(values), strict=True)
    ):
        quantity = curves.quantities[pair]
        sigma = fitted.problem.sigma[pair] if one.sigma is None else one.sigma
        rest.append(Series(quantity, one.t, (one.y - predicted.values) / sigma, "points"))
        number = made.names.index(quantity)
        y, half = made.values[number], _band(made, number, fitted, values)
        series = [points(curves, pair), Series(quantity, made.t, y)]
        if np.isfinite(half).all():
            gap = [np.nan]
            both = np.concatenate([y - half, gap, y + half])
            series.append(
                Series(f"{LEVEL:.0%} of {quantity}", np.concatenate([made.t, gap, made.t]), both, "dashes")
            )
        charts.append(Chart(f"{quantity} and {curves.data.name}", "t", quantity, series))
    return [Chart(f"Residuals of {curves.data.name}", "t", "standard deviations", rest), *charts]


def _band(made: SensitiveRun, number: int, fitted: Fitted, values: dict[str, float]) -> Floats:
    """Return half the width of a curve's confidence band, by the derivatives along it."""
    by_z = np.where(fitted.problem.log, list(values.values()), 1.0)[:, None] * made.derivatives[:, number]
    with np.errstate(invalid="ignore"):
        variance = np.einsum("kt,kl,lt->t", by_z, fitted.estimates.covariance, by_z)
    half: Floats = fitted.estimates.factor * np.sqrt(np.maximum(variance, 0.0))
    return half
