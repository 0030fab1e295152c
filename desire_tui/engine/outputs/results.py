"""Everything a program produced, as plain data: what `desire run --json` writes and `desire_tui.run` returns.

The layout is public (docs: headless runs); programs rely on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.outputs.run import IN_MEMORY, Run
from desire_tui.engine.outputs.sampled_run import CurveData
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import pandas as pd
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.values import Values

    Value = float | complex | NDArray[Any]

StatusWord = Literal["done", "failed", "stopped", "limit"]


@dataclass(frozen=True, slots=True)
class ResultProblem:
    """One message; rows and columns from 1, None where it has no place."""

    code: int
    severity: str
    message: str
    file: str | None
    line: int | None
    column: int | None
    end_line: int | None
    end_column: int | None
    hint: str | None


@dataclass(frozen=True, slots=True)
class PlotPoint:
    """A point of an interpreter plot."""

    x: float
    y: float
    color: int


@dataclass(eq=False, repr=False)
class Result(Mapping[str, "Value"]):
    """What a program produced: a mapping from names to final values, arrays in their shape."""

    desire: str
    program: str
    status: StatusWord = "done"
    problems: tuple[ResultProblem, ...] = ()
    console: str = ""
    runs: tuple[Run, ...] = ()
    plots: tuple[PlotPoint, ...] = ()
    quantities: dict[str, Value] = field(default_factory=dict)
    timings: dict[str, float] = field(default_factory=dict)
    error: DesireError | None = field(default=None, metadata=IN_MEMORY)
    """What ended the program early."""

    def __getitem__(self, name: str) -> Value:
        """Return the final value of a quantity, 0 for `t` before any run; KeyError for one that has none."""
        return self.quantities.get("t", 0.0) if name == "t" else self.quantities[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)

    def __repr__(self) -> str:
        runs = f"{len(self.runs)} run{'s' * (len(self.runs) != 1)}"
        last = f", the last: {self.runs[-1].summary}" if self.runs else ""
        reason = f": {self.error.message}" if self.error is not None else ""
        return f"<Result of {self.program}: {self.status}, {runs}{last}{reason}>"

    def check(self) -> Result:
        """Return the result. DesireError: what ended the program early."""
        if self.error is not None:
            raise self.error
        return self

    def to_dataframe(self) -> pd.DataFrame:
        """Return the samples of all runs as a pandas table over run (from 1) and `t`."""
        from desire_tui.engine.outputs.tables import dataframe_of_runs

        return dataframe_of_runs(self.runs)

    def plot(self, *names: str, ax: Axes | None = None, **style: Any) -> Axes:
        """Draw the curves of all runs with matplotlib, all or those named, and return the axes."""
        from desire_tui.engine.outputs.run_plot import plot_runs

        return plot_runs(self.runs, names, ax, style)

    def _repr_png_(self) -> bytes:
        from desire_tui.engine.outputs.run_plot import run_png

        return run_png(self.runs)

    def _repr_html_(self) -> str:
        from desire_tui.engine.outputs.run_plot import run_html

        return run_html(self.runs, repr(self), {})


def problem_data(diagnostic: Diagnostic) -> ResultProblem:
    """Return a diagnostic as plain data."""
    source, span = diagnostic.source, diagnostic.span
    start = source.position(span.start) if source is not None and span is not None else (None, None)
    end = source.position(span.end) if source is not None and span is not None else (None, None)
    return ResultProblem(
        diagnostic.code, diagnostic.severity, diagnostic.message, source.name if source is not None else None,
        start[0], start[1], end[0], end[1], diagnostic.hint,
    )  # fmt: skip


def run_data(record: RunRecord, *, more: bool = False, **in_memory: Any) -> Run:
    """Return a run as plain data, its samples copied; `more`: those of stashed variables too."""
    requests = {request.kind: request for request in record.requests}
    shown = next((k for k in ("dispt", "dispxy", "DISPXY") if k in requests), None)
    count, rows = record.count, record.rows
    curves: dict[str, CurveData] = {}
    for request in record.requests:
        first = 1 + record.first_column(request)
        for number, column in enumerate(request.columns):
            if column.name not in curves:
                x = _abscissa(request.kind, [c.name for c in request.columns], number)
                curves[column.name] = CurveData(column.name, x, rows[:count, first + number].copy())
    for number, column in enumerate(record.columns if more else (), 1):
        if column.name not in curves:
            curves[column.name] = CurveData(column.name, None, rows[:count, number].copy())
    return Run(
        segment=record.segment, line=record.line, request=shown or ("type" if "type" in requests else "none"),
        overlay=record.overlay, rule=record.rule, scale=record.scale, t0=record.t0, tmax=record.t_max,
        nn=record.nn, dt=record.dt, t=rows[:count, 0].copy(), curves=tuple(curves.values()),
        ended=record.ended, end_time=record.end_time, steps=record.steps, rejected=record.rejected,
        derivative_calls=record.derivative_calls, jacobian_calls=record.jacobian_calls,
        dt_least=record.dt_least, dt_most=record.dt_most, order=record.order, seconds=record.seconds,
        parameters=record.start.parameters if record.start is not None else {},
        initial=record.start.initial if record.start is not None else {},
        continues=record.start is not None and record.start.continues, points=record.points,
        **in_memory,
    )  # fmt: skip


def _abscissa(kind: str, names: Sequence[str], number: int) -> str | None:
    if kind == "dispxy":
        return names[0] if number else None
    if kind == "DISPXY":
        return names[number - 1] if number % 2 else None
    return None


def plot_points(graphs: GraphPages) -> tuple[PlotPoint, ...]:
    """Return all points of interpreter plots, page by page."""
    return tuple(
        PlotPoint(x, y, color)
        for page in graphs
        for x, y, color in zip(*(a.tolist() for a in page.points.so_far()), strict=True)
    )


def final_quantities(values: Values) -> dict[str, float | complex | NDArray[Any]]:
    """Return copies of all quantities that have a value. DesireError 40: they would fill the memory."""
    numbers = sum(quantity.size for quantity in values if values.is_defined(quantity))
    if numbers > values.spare:
        raise DesireError(Diagnostic("out-of-memory", facts={"elements": numbers}))
    found: dict[str, float | complex | NDArray[Any]] = {}
    for quantity in values:
        if not values.is_defined(quantity):
            continue
        if quantity.shape:
            found[quantity.name] = np.array(values.view(quantity))
        elif quantity.kind is Kind.COMPLEX:
            found[quantity.name] = complex(*values.data[quantity.slot : quantity.slot + 2])
        else:
            found[quantity.name] = values.cells[quantity.slot]
    return found


def timings(parse_seconds: float, runs: Iterable[RunRecord]) -> dict[str, float]:
    """Return the seconds spent on parsing, compiling and running."""
    runs = list(runs)
    return {
        "parse_s": parse_seconds,
        "compile_s": sum(r.compile_seconds for r in runs),
        "run_s": sum(r.seconds for r in runs),
    }
