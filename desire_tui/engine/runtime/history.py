"""What outlives a run: positions of stored histories, and the start to go back to (language.md 8.2)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values


@dataclass
class Positions:
    """Where a segment's store, get, delay and SAMPLE stand; `end` is where its last run ended, or nan."""

    counters: NDArray[np.int64]
    points: int = 0
    end: float = float("nan")

    def copy(self) -> Positions:
        """Return a copy that later runs leave alone."""
        return Positions(self.counters.copy(), self.points, self.end)


@dataclass
class Start:
    """t, DT and all states as they were when the last run began, and its segment's positions."""

    t: float
    dt: float
    dt_defined: int
    states: list[tuple[int, NDArray[np.float64]]]
    segment: str | None
    positions: Positions


@dataclass
class RunHistory:
    """Positions by segment, and the start of the last run."""

    values: Values
    generation: int = -1
    positions: dict[str | None, Positions] = field(default_factory=dict)
    start: Start | None = None
    _ranges: list[tuple[int, int]] = field(default_factory=list)
    _names: int = -1
    _begun: dict[str | None, Segment] = field(default_factory=dict)

    def copy(self) -> RunHistory:
        """Return a copy that later runs leave alone."""
        positions = {label: known.copy() for label, known in self.positions.items()}
        return replace(self, positions=positions)

    def begin(self, segment: Segment) -> Positions:
        """Save the start of a run; return the segment's positions, to be moved by the run."""
        self._forget_old()
        values, key = self.values, segment.label
        known = self.positions.get(key)
        if known is None or len(known.counters) < segment.counters:
            known = self.positions[key] = Positions(np.zeros(max(segment.counters, 1), dtype=np.int64))
        if self._begun.get(key) is not segment:  # its states may be arrays that were none before
            self._begun = {**self._begun, key: segment}
            self._names = -1
        states = [(slot, values.data[slot : slot + count].copy()) for slot, count in self._state_ranges()]
        cells = values.cells
        self.start = Start(cells[T], cells[DT], values.defined[DT], states, key, known.copy())
        return known

    def reset(self) -> None:
        """Go back to the start of the last run; nothing happens before the first."""
        self._forget_old()
        start, values = self.start, self.values
        if start is None:
            return
        values.assign(T, start.t)
        values.cells[DT] = start.dt
        values.defined[DT] = start.dt_defined
        for slot, numbers in start.states:
            values.data[slot : slot + len(numbers)] = numbers
        self.positions[start.segment] = start.positions.copy()

    def _forget_old(self) -> None:
        if self.generation != self.values.generation:
            self.generation = self.values.generation
            self.positions.clear()
            self.start = None
            self._names = -1

    def _state_ranges(self) -> list[tuple[int, int]]:
        """Return slots and lengths of all states, neighbours joined."""
        if self._names != len(self.values.names):
            self._names = len(self.values.names)
            merged: list[tuple[int, int]] = []
            for slot, count in sorted((q.slot, q.slots) for q in self.values if q.is_state):
                if merged and slot <= merged[-1][0] + merged[-1][1]:
                    first, length = merged[-1]
                    merged[-1] = (first, max(length, slot + count - first))
                else:
                    merged.append((slot, count))
            self._ranges = merged
        return self._ranges
