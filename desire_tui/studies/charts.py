"""What a study shows of itself, from the runs made so far: curves, fans, distributions, maps.

A chart is numbers and words only; `chart_page` lays it out as a graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.graph.cells import Cells

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.studies.dataset import Layout
    from desire_tui.studies.plan import Plan

    Floats = NDArray[np.float64]

ChartKind = Literal["fan", "curves", "histogram", "cumulated", "over", "map", "scatter"]
CHART_KINDS: tuple[ChartKind, ...] = get_args(ChartKind)
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
QUANTILE_NAMES = ("5 %", "25 %", "median", "75 %", "95 %")
CURVES_MOST = 200
"""Of more runs, evenly spread ones are drawn."""
RUNS_MOST = 20_000
"""Of more runs, evenly spread ones give the quantiles of a fan."""
SCATTER_MOST = 100_000
"""Of more runs, the first ones are drawn."""
BINS_MOST = 60
CURVE_NOT_NUMBER = "{name} is a curve of each run: fan or curves show it"


class Line(NamedTuple):
    """A curve: ordinates over the chart's `x`; its part of the ramp of colours, if it is one of many."""

    name: str
    y: Floats
    part: float | None = None


@dataclass(frozen=True)
class Chart:
    """What is drawn. `picture` (its rows from the top down, named by `cells`), or else `lines` over `x`."""

    kind: ChartKind
    title: str
    x_name: str
    y_name: str
    x: Floats = field(default_factory=lambda: np.empty(0))
    lines: Sequence[Line] = ()
    joined: bool = True
    picture: Floats | None = None
    cells: Cells | None = None


@dataclass(frozen=True)
class Results:
    """A quantity of a study as far as it is: of each run the numbers, (runs, numbers), nan where none are."""

    plan: Plan
    layout: Layout
    numbers: Floats

    def values(self, run: int) -> Floats:
        """Return what varied, in one run."""
        return np.asarray(self.plan.design.rows(run, 1)[0])

    @property
    def made(self) -> NDArray[np.bool_]:
        """Which runs have numbers."""
        return np.asarray(np.isfinite(self.numbers).any(axis=1))


def usual_kind(plan: Plan, layout: Layout) -> ChartKind:
    """Return the chart that says most of a quantity."""
    shape = plan.design.shape
    is_curve = len(layout.shape) > len(shape)
    grid = [axis for axis in plan.design.axes if axis.values is not None and axis.size > 1]
    drawn = any(axis.values is None and axis.size > 1 for axis in plan.design.axes)
    if is_curve:
        return "fan" if drawn or plan.runs > CURVES_MOST else "curves"
    if drawn:
        return "over" if len(grid) == 1 else "histogram"
    return {1: "over", 2: "map"}.get(len(grid), "histogram")  # type: ignore[return-value]  # literals


def chart(results: Results, kind: ChartKind, parameter: str = "") -> Chart | str:
    """Return a chart of the runs made so far, or why there is none of this kind."""
    match kind:
        case "fan" | "curves":
            if results.numbers.shape[1] == 1:
                told = f"{results.layout.name} is one number of a run"
                return f"{told}: a {kind} chart needs times, {example(results)}"
            return _fan(results) if kind == "fan" else _curves(results, parameter)
        case "histogram" | "cumulated":
            if results.numbers.shape[1] > 1:
                return CURVE_NOT_NUMBER.format(name=results.layout.name)
            return _histogram(results) if kind == "histogram" else _cumulated(results)
        case "over" | "map" | "scatter":
            if results.numbers.shape[1] > 1:
                return CURVE_NOT_NUMBER.format(name=results.layout.name)
            if kind == "map":
                return _map(results)
            return _over(results) if kind == "over" else _scatter(results, parameter)


def example(results: Results) -> str:
    """Return how the same quantity would be kept over times."""
    return f"for instance {results.layout.item.expression.text.strip()}@0:1:0.1"


def _ordinate(results: Results) -> str:
    return results.layout.item.expression.text.strip()


def _times(results: Results) -> Floats:
    return np.array(results.layout.item.times)


def _fan(results: Results) -> Chart:
    numbers = _spread(results.numbers[results.made], RUNS_MOST)
    times = _times(results)
    if len(numbers):
        with np.errstate(invalid="ignore"):
            bands = _quantiles(numbers)
    else:
        bands = np.full((len(QUANTILES), len(times)), np.nan)
    lines = [Line(name, band) for name, band in zip(QUANTILE_NAMES, bands, strict=True)]
    return Chart("fan", _named(results), "t", _ordinate(results), times, lines)


def _quantiles(numbers: Floats) -> Floats:
    """Return the quantiles over runs, (quantiles, times), of those that have a number."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a time that no run has reached: nan
        return np.asarray(np.nanquantile(numbers, QUANTILES, axis=0))


def _curves(results: Results, parameter: str) -> Chart | str:
    """Draw the curves in the colours of a quantity that varies, of the first one if none is named."""
    names = results.plan.design.names
    if parameter and parameter not in names:
        return _not_varied(parameter, names)
    shown = _spread(np.flatnonzero(results.made), CURVES_MOST)
    rows = [results.values(run) for run in shown.tolist()]
    if not names:
        parts, title = shown / max(results.plan.runs - 1, 1), _named(results)
    else:
        chosen = parameter or names[0]
        along = np.array([row[names.index(chosen)] for row in rows])
        low, high = (along.min(), along.max()) if len(along) else (0.0, 1.0)
        parts = (along - low) / ((high - low) or 1.0)
        title = _named(results) + (f" · {chosen} = {low:.4g} … {high:.4g}" if len(along) else "")
    lines = [
        Line(_values(names, row), results.numbers[run], part)
        for run, row, part in zip(shown.tolist(), rows, parts.tolist(), strict=True)
    ]
    return Chart("curves", title, "t", _ordinate(results), _times(results), lines)


def _not_varied(name: str, names: Sequence[str]) -> str:
    return f"'{name}' does not vary; what does: {', '.join(names)}"


def _values(names: Sequence[str], row: Floats) -> str:
    return (
        ", ".join(f"{name} = {value:.4g}" for name, value in zip(names, row.tolist(), strict=True)) or "run"
    )


def _histogram(results: Results) -> Chart:
    numbers = _finite(results)
    if not len(numbers):
        return Chart("histogram", _named(results), results.layout.name, "runs")
    bins = min(max(int(np.ceil(np.sqrt(len(numbers)))), 1), BINS_MOST)
    counts, edges = np.histogram(numbers, bins)
    zeros = np.zeros(len(counts))
    y = np.stack([zeros, counts, counts, zeros], axis=1).ravel()
    x = np.stack([edges[:-1], edges[:-1], edges[1:], edges[1:]], axis=1).ravel()
    return Chart("histogram", _named(results), results.layout.name, "runs", x, [Line("runs", y)])


def _cumulated(results: Results) -> Chart:
    numbers = np.sort(_finite(results))
    part = np.arange(1, len(numbers) + 1) / max(len(numbers), 1)
    steps = np.repeat(numbers, 2)
    y = np.stack([part - part[:1], part], axis=1).ravel() if len(part) else part
    if len(part):
        y[0::2] = np.concatenate([[0.0], part[:-1]])
    lines = [Line("part of the runs", y)]
    return Chart("cumulated", _named(results), results.layout.name, "part of the runs", steps, lines)


def _over(results: Results) -> Chart | str:
    """Draw a number over the one quantity of the grid that varies; of drawn runs the quantiles."""
    axes = [n for n, axis in enumerate(results.plan.design.axes) if axis.values is not None and axis.size > 1]
    if len(axes) != 1:
        return f"{len(axes)} quantities vary over a grid: 'over' shows one; scatter or map show more"
    axis = results.plan.design.axes[axes[0]]
    assert axis.values is not None
    name = results.layout.name
    shape = results.plan.design.shape
    numbers = np.moveaxis(results.numbers[:, 0].reshape(shape), axes[0], 0).reshape(axis.size, -1)
    if numbers.shape[1] == 1:
        lines = [Line(name, numbers[:, 0])]
    else:
        bands = _quantiles(numbers.T)
        lines = [Line(told, band) for told, band in zip(QUANTILE_NAMES, bands, strict=True)]
    return Chart("over", _named(results), axis.name, name, axis.values, lines)


def _map(results: Results) -> Chart | str:
    axes = [n for n, axis in enumerate(results.plan.design.axes) if axis.size > 1]
    grid = [results.plan.design.axes[n] for n in axes]
    if len(grid) != 2 or any(axis.values is None for axis in grid):
        return "a map needs a grid over two quantities: --over a=…  --over b=…"
    numbers = results.numbers[:, 0].reshape(grid[0].size, grid[1].size)
    down, across = grid
    assert across.values is not None
    assert down.values is not None
    finite = numbers[np.isfinite(numbers)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    span = f" · {low:.4g} … {high:.4g}" if finite.size else ""
    return Chart(
        "map", _named(results) + span, across.name, down.name,
        picture=(numbers - low) / ((high - low) or 1.0),
        cells=Cells(tuple(across.values.tolist()), tuple(down.values.tolist()), low, high),
    )  # fmt: skip


def _scatter(results: Results, parameter: str) -> Chart | str:
    names = results.plan.design.names
    if not names:
        return "nothing varies in this study"
    chosen = parameter or names[0]
    if chosen not in names:
        return _not_varied(chosen, names)
    runs = min(results.plan.runs, SCATTER_MOST)
    made = results.made[:runs]
    x = results.plan.design.rows(0, runs)[made, names.index(chosen)]
    y = results.numbers[:runs][made, 0]
    lines = [Line(results.layout.name, y)]
    return Chart("scatter", _named(results), chosen, results.layout.name, x, lines, joined=False)


def _named(results: Results) -> str:
    made, runs = int(results.made.sum()), results.plan.runs
    return (
        f"{results.layout.name} of {runs} runs"
        if made == runs
        else f"{results.layout.name} of {made}/{runs} runs"
    )


def _finite(results: Results) -> Floats:
    return results.numbers[np.isfinite(results.numbers)]


def _spread(rows: Any, most: int) -> Any:
    return rows if len(rows) <= most else rows[np.linspace(0, len(rows) - 1, most).astype(np.intp)]
