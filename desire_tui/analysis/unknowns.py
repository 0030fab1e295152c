"""What is searched for: names with bounds, on a scale of their own where all are alike."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.request import Request
    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.source import Span

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Unknown:
    """A quantity whose value is searched for. `start` None: the program's own value."""

    name: str
    span: Span
    start: float | None = None
    low: float = -np.inf
    high: float = np.inf
    is_log: bool = False

    @property
    def is_bounded(self) -> bool:
        """Whether it has both bounds."""
        return bool(np.isfinite(self.low) and np.isfinite(self.high))


def read_unknowns(asked: Request, *stops: str) -> list[Unknown]:
    """Read `k, r = 10 in [1, 100] log, x0` up to one of the words `stops`. DesireError 520."""
    found: list[Unknown] = []
    while True:
        span = asked.span
        name = asked.name("the name of a quantity to vary")
        if any(other.name == name for other in found):
            asked.fail(f"'{name}' is given twice", "give it in one place", span)
        start = asked.number() if asked.take("=") else None
        low, high = (-np.inf, np.inf)
        place = asked.span
        if asked.take("in"):
            low, high = asked.interval()
        is_log = bool(asked.take("log"))
        if is_log and np.isfinite(low) and low <= 0.0:
            asked.fail(f"a logarithmic scale has no {low:g}", f"in [{high / 1000:g}, {high:g}] log", place)
        if start is not None and not low <= start <= high:
            asked.fail(f"{name} begins at {start:g}, outside its bounds [{low:g}, {high:g}]", "", place)
        found.append(Unknown(name, span, start, low, high, is_log))
        if not asked.take(","):
            break
    if not asked.is_done and asked.peek() not in stops:
        asked.expect(",", *stops)
    return found


def start_values(subject: Subject, unknowns: Sequence[Unknown]) -> Floats:
    """Return where the search begins: what is given, else the program's own values, inside the bounds."""
    model = subject.model
    own = {**model.states, **model.parameters, **subject.settings}
    values = []
    for one in unknowns:
        value = one.start if one.start is not None else own.get(one.name)
        if value is None:
            value = 0.0  # no such quantity: the study says so
        if one.is_log and value <= 0.0:
            value = float(np.sqrt(one.low * one.high)) if one.is_bounded else 1.0
        values.append(min(max(value, one.low), one.high))
    return np.array(values)


class Scale:
    """Values of unknowns as numbers z that are all of the size of 1: bounded ones go from 0 to 1."""

    def __init__(self, unknowns: Sequence[Unknown], start: Floats) -> None:
        self._log = np.array([one.is_log for one in unknowns])
        low, high = (self._ends([getattr(one, end) for one in unknowns]) for end in ("low", "high"))
        begin = self._ends(start)
        bounded = np.isfinite(low) & np.isfinite(high)
        size = np.where(self._log, 1.0, np.where(begin != 0.0, np.abs(begin), 1.0))
        self._offset = np.where(bounded, low, begin)
        with np.errstate(invalid="ignore"):
            self._size = np.where(bounded, high - low, size)
        self.low, self.high = (low - self._offset) / self._size, (high - self._offset) / self._size
        self.start = np.clip((begin - self._offset) / self._size, self.low, self.high)

    def _ends(self, values: Sequence[float] | Floats) -> Floats:
        numbers = np.array(values, dtype=np.float64)
        with np.errstate(invalid="ignore", divide="ignore"):
            logs = np.where(numbers > 0, np.log(numbers), -np.inf)
        return np.where(self._log, logs, numbers)

    def values(self, z: Floats) -> Floats:
        """Return what rows of z stand for."""
        found = self._offset + self._size * z
        with np.errstate(over="ignore"):
            return np.where(self._log, np.exp(np.where(self._log, found, 0.0)), found)
