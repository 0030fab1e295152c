"""What was measured: times, values and standard deviations of each pair, in one or several data sets."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.data_files.data_file import read_data_file
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.session.permissions import Asker, Permissions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.fit.request import Asked, Pair
    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.data_files.data_file import DataFile

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Measured:
    """Of one pair: `t`, `y` and standard deviations `sigma`, None where they are to be estimated."""

    t: Floats
    y: Floats
    sigma: Floats | None


@dataclass(frozen=True)
class DataSet:
    """What one run has to agree with: a list in the order of the pairs; `settings` of that run alone."""

    name: str
    measured: tuple[Measured, ...]
    settings: dict[str, float] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """How many numbers were measured."""
        return sum(len(one.t) for one in self.measured)


def data_sets(
    files: Sequence[DataFile], asked: Asked, span: tuple[float, float]
) -> tuple[list[DataSet], list[str]]:
    """Return the data sets of files within a run's `span`, and notes.

    DesireError 520: columns that are not there; 521: nothing was measured while the run lasts.
    """
    notes = [note for file in files for note in file.notes]
    found = []
    for file in files:
        measured, outside = [], 0
        for pair in asked.pairs:
            one = _measured(file, pair, asked)
            inside = (one.t >= span[0] - _slack(span)) & (one.t <= span[1] + _slack(span))
            outside += int((~inside).sum())
            sigma = None if one.sigma is None else one.sigma[inside]
            measured.append(Measured(one.t[inside], one.y[inside], sigma))
        made = DataSet(file.name, tuple(measured), dict(file.settings))
        if not made.count:
            times = file.columns[file.time]
            low, high = (float(end(times, initial=np.nan)) for end in (np.fmin.reduce, np.fmax.reduce))
            lasts = f"the run from {span[0]:g} to {span[1]:g}: they do not overlap"
            facts = {
                "what": f"the data of {file.name} go from t = {low:g} to {high:g}, {lasts}",
                "remedy": "set t and TMAX so that the run covers the data, or shift their times",
            }
            raise DesireError(Diagnostic("analysis-failed", None, facts))
        if outside:
            notes.append(f"{file.name}: {outside} values outside the run are left out")
        for name in made.settings:
            if name in {one.name for one in asked.unknowns}:
                span_of = next(one.span for one in asked.unknowns if one.name == name)
                what = f"{file.name} sets {name}, which is to be fitted"
                asked.request.fail(what, "take it out of one of both", span_of)
        found.append(made)
    return found, notes


def read_files(subject: Subject, asked: Asked) -> list[DataFile]:
    """Read the files given with the program and those that the request names, beside the program.

    DesireError 38, 531 … 534: everything wrong with them; 451: a named file that the program may not read;
    521: there are none.
    """
    source = subject.source
    folder = Path.cwd() if source.path is None else source.path.absolute().parent
    asker = Asker(Path(os.path.realpath(folder)), source.path)
    permissions = Permissions(files=subject.allow_write)
    problems: list[Diagnostic] = []
    files = []
    for number, path in enumerate((*subject.data, *map(Path, asked.files))):
        try:
            is_named = number >= len(subject.data)
            files.append(
                read_data_file(permissions.file(path, "read", asker, lambda _: False) if is_named else path)
            )
        except DesireError as error:
            problems += error.diagnostics
    if problems:
        raise DesireError(*problems)
    if not files:
        facts = {
            "what": "there are no measurements to agree with",
            "remedy": "name a file: from 'measured.csv'",
        }
        raise DesireError(Diagnostic("analysis-failed", None, facts, source))
    return files


def _slack(span: tuple[float, float]) -> float:
    return 1e-9 * (span[1] - span[0])


def _measured(file: DataFile, pair: Pair, asked: Asked) -> Measured:
    column = _column(file, pair.column, pair, asked)
    if not isinstance(pair.weights, str):
        t, y = file.measured(column)
        return Measured(t, y, None if pair.weights is None else np.full(len(t), pair.weights))
    t, y, sigma = file.measured(column, _column(file, pair.weights, pair, asked))
    if np.any(sigma <= 0.0):
        asked.request.fail(
            f"{file.name} has weights in {pair.weights} that are not above 0",
            "weights are standard deviations", pair.span,
        )  # fmt: skip
    return Measured(t, y, sigma)


def _column(file: DataFile, name: str, pair: Pair, asked: Asked) -> str:
    found = file.find(name)
    if found is None:
        near = file.near(name)
        remedy = f"did you mean {near}?" if near else f"there are {', '.join(file.columns)}"
        asked.request.fail(f"{file.name} has no column '{name}'", remedy, pair.span)
    return found
