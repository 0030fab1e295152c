"""Runs that share a graph: what was changed between them, and what each is called for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.integration.rules import RULES

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_record import RunRecord

    Floats = NDArray[np.float64]

NAMED_MOST = 3
"""So many changed quantities name a run."""
_FEW = 2
_DIGITS_LEAST, _DIGITS_MOST = 3, 8
_ALIKE = 1e-9


class Varied(NamedTuple):
    """A quantity that runs differ in: its name with what joins it to a value, and its value in each run."""

    name: str
    values: Floats
    joint: str = " = "

    def at(self, number: int) -> str:
        """Return `c = 0.3`."""
        return f"{self.name}{self.joint}{self.text(number)}"

    def text(self, number: int) -> str:
        """Return the value in a run, with as many digits as tell the runs apart."""
        return self._texts((self.values[number],))[0]

    @property
    def span(self) -> str:
        """Return `c = 0.3 … 1.5`, or `c = 2, 9, 5` of few values in no order."""
        steps, distinct = np.diff(self.values), np.unique(self.values)
        if len(self.values) > _FEW and (np.all(steps > 0) or np.all(steps < 0)):
            told = " … ".join(self._texts((self.values[0], self.values[-1])))
        elif len(distinct) <= NAMED_MOST:
            told = ", ".join(dict.fromkeys(self._texts(self.values)))
        else:
            told = " … ".join(self._texts((distinct[0], distinct[-1])))
        return f"{self.name}{self.joint}{told}"

    def _texts(self, values: Iterable[float]) -> list[str]:
        distinct = np.unique(self.values).tolist()
        for digits in range(_DIGITS_LEAST, _DIGITS_MOST):
            if len({f"{value:.{digits}g}" for value in distinct}) == len(distinct):
                break
        return [f"{value + 0.0:.{digits}g}" for value in values]


class Study:
    """Runs, in the order in which they were made, and what varies over them."""

    def __init__(self, records: Sequence[RunRecord]) -> None:
        self.records = list(dict.fromkeys(records))
        self._numbers = {record: number for number, record in enumerate(self.records)}
        self.every = tuple(_varied(self.records)) if len(self.records) > 1 else ()
        """Everything that varies."""
        self.varied = self.every[:NAMED_MOST]

    @property
    def span(self) -> str:
        """What varies, from where to where: `c = 0.3 … 1.5`; nothing where that is not known."""
        return "; ".join(varied.span for varied in self.varied)

    @property
    def run_name(self) -> str:
        """Return which runs they are: `run 3`, `runs 1–5`; nothing where none has a number."""
        numbers = [record.number for record in self.records if record.number]
        if not numbers:
            return ""
        first, last = min(numbers), max(numbers)
        return f"run {last}" if first == last else f"runs {first}–{last}"

    def place(self, record: RunRecord) -> int:
        """Return the number of a run among those of the study, from 0."""
        return self._numbers.get(record, 0)

    def name(self, record: RunRecord) -> str:
        """Return what a run is called: `c = 0.3`, or `run 3` where nothing known varies."""
        place = self.place(record)
        told = ", ".join(varied.at(place) for varied in self.varied)
        return told or (f"run {record.number}" if record.number else "")


def _varied(records: list[RunRecord]) -> list[Varied]:
    """Return what differs: parameters, then starts of states, then settings.

    What goes in step with a quantity named before is left out (`k` where `c` is 0.3 k).
    """
    found = [*_quantities(records), *_settings(records)]
    kept: list[Varied] = []
    for varied in found:
        if len(records) == _FEW or not any(_in_step(varied.values, other.values) for other in kept):
            kept.append(varied)
    return kept


def _quantities(records: list[RunRecord]) -> list[Varied]:
    starts = [record.start for record in records if record.start is not None]
    if len(starts) < len(records):
        return []
    names, parameters = starts[0].names, starts[0].parameter_count
    if any(start.names != names for start in starts):
        return _shared([start.parameters for start in starts])
    table = np.array([start.values for start in starts])
    if all(start.continues for start in starts[1:]):
        table = table[:, :parameters]  # each run goes on where the one before ended: no script changed that
    with np.errstate(invalid="ignore"):
        differs = np.any((table != table[0]) & ~(np.isnan(table) & np.isnan(table[0])), axis=0)
    return [
        Varied(names[column] if column < parameters else f"{names[column]}(0)", table[:, column])
        for column in np.flatnonzero(differs).tolist()
    ]


def _shared(values: list[dict[str, float]]) -> list[Varied]:
    """Return what differs between runs of several segments, of what all of them read."""
    names = [name for name in values[0] if all(name in others for others in values[1:])]
    columns = {name: np.array([each[name] for each in values]) for name in names}
    return [Varied(name, column) for name, column in columns.items() if len(np.unique(column)) > 1]


def _settings(records: list[RunRecord]) -> list[Varied]:
    fixed = all(RULES[run.rule].kind == "fixed" for run in records)
    settings: list[tuple[str, list[float]]] = [
        ("rule", [run.rule for run in records]),
        ("ERMAX", [run.error_max for run in records]),
        ("DT", [run.dt for run in records] if fixed else []),
    ]
    return [
        Varied(name, np.array(values, dtype=float), " ") for name, values in settings if len(set(values)) > 1
    ]


def _in_step(values: Floats, others: Floats) -> bool:
    """Whether the one is a straight-line function of the other."""
    a, b = values - values.mean(), others - others.mean()
    with np.errstate(all="ignore"):
        alike = abs(float(a @ b)) / float(np.sqrt((a @ a) * (b @ b)) or 1.0)
    return alike > 1 - _ALIKE
