"""Samples of runs as CSV."""

from __future__ import annotations

import csv
from itertools import repeat
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from desire_tui.engine.outputs.results import PlotPoint
    from desire_tui.engine.outputs.run import Run

_ROWS = 10_000  # turned into text at a time
SEGMENT = "segment"
"""The column of labels."""


def write_csv(runs: Sequence[Run], file: IO[str], *, numbered: bool = True, delimiter: str = ",") -> None:
    """Write one row for each sample: `run, t, names…`, without `run` unless `numbered`.

    Behind them stands what differs between the runs: parameters that the script changed, starts of states as
    `x(0)`, and the label of the segment. A variable that a run did not record is empty there. Numbers read
    back as the same floats.
    """
    names, varied = columns_of(runs)
    header = csv.writer(file, delimiter=delimiter, lineterminator="\n")
    header.writerow([*(["run"] if numbered else []), "t", *names, *varied])
    for number, run in enumerate(runs, 1):
        first = [repeat(str(number))] if numbered else []
        last = [repeat(_text(values[number - 1])) for values in varied.values()]
        for columns in _texts(run, names):
            # numbers need no quotes: `csv` would look for something to quote, in a third more time
            rows = map(
                delimiter.join, zip(*first, *columns, *last, strict=False)
            )  # what is repeated has no end
            file.writelines(f"{row}\n" for row in rows)


def write_points(points: Iterable[PlotPoint], file: IO[str]) -> None:
    """Write the points of `plot`, one row each: `x, y, color`."""
    file.write("x,y,color\n")
    file.writelines(f"{point.x!r},{point.y!r},{point.color}\n" for point in points)


def columns_of(runs: Sequence[Run]) -> tuple[list[str], dict[str, list[float | str | None]]]:
    """Return the names of the samples' columns, and of those behind them each run's value.

    The latter hold what differs: parameters, starts of states, segments. None: the run has none.
    """
    shown = dict.fromkeys(curve.name for run in runs for curve in run.curves)
    names = [name for name in shown if name != "t"]  # it has its column
    starts: list[dict[str, float]] = [run.parameters for run in runs]
    if not all(run.continues for run in runs[1:]):
        starts = [run.parameters | {f"{name}(0)": x for name, x in run.initial.items()} for run in runs]
    varied: dict[str, list[float | str | None]] = {
        name: [start.get(name) for start in starts] for name in _varied(starts) if name not in shown
    }
    if len({run.segment for run in runs}) > 1 and SEGMENT not in {*names, *varied}:
        varied[SEGMENT] = [run.segment for run in runs]
    return names, varied


def _varied(starts: Sequence[dict[str, float]]) -> Iterator[str]:
    """Return the names that have several values; nan is as good as nan."""
    values: dict[str, set[str]] = {}
    for start in starts:
        for name, value in start.items():
            values.setdefault(name, set()).add(repr(value))
    return (name for name, found in values.items() if len(found) > 1)


def _text(value: float | str | None) -> str:
    return value if isinstance(value, str) else "" if value is None else repr(value)


def _texts(run: Run, names: Sequence[str]) -> Iterator[list[Iterable[str]]]:
    """Return the columns of a run as texts, t first, some rows at a time."""
    recorded = {curve.name: curve.values for curve in run.curves}
    columns = [run.t, *(recorded.get(name) for name in names)]
    for start in range(0, len(run.t), _ROWS):
        rows = slice(start, start + _ROWS)
        yield [map(repr, column[rows].tolist()) if column is not None else repeat("") for column in columns]
