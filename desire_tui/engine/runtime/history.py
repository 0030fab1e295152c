"""What outlives a run: positions of stored histories, and the start to go back to (language.md 8.2)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass, field, replace
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.moments.setup import Remembered, Stepper
    from desire_tui.engine.values import Values


@dataclass
class Positions:
    """Where store, get, delay and SAMPLE stand through runs that continue one another.

    `end` is where the last of them ended with a sample, or nan; `runs` counts them.
    """

    counters: NDArray[np.int64]
    stepper: Stepper | Remembered | None = None
    """What holds the histories of `delay(x, tau)`."""
    points: int = 0
    end: float = float("nan")
    runs: int = 0

    def copy(self) -> Positions:
        """Return a copy that later runs leave alone."""
        stepper = None if self.stepper is None else self.stepper.remembered()
        return replace(self, counters=self.counters.copy(), stepper=stepper)


@dataclass
class Start:
    """t, DT and all states as they were when the last run began."""

    t: float
    dt: float
    dt_defined: int
    states: list[tuple[int, NDArray[np.float64]]]


@dataclass
class RunHistory:
    """What a further run continues, and the start of the last run.

    Runs without a label that follow one another, with no `reset` between, continue one another. All others
    begin anew; those of a labelled segment, and the first run after one, are compiled anew too.
    """

    values: Values
    generation: int = -1
    positions: Positions | None = None
    label: str | None = None
    start: Start | None = None
    _ranges: list[tuple[int, int]] = field(default_factory=list)
    _names: int = -1
    _begun: dict[str | None, Segment] = field(default_factory=dict)

    def copy(self) -> RunHistory:
        """Return a copy that later runs leave alone."""
        return replace(self, positions=None if self.positions is None else self.positions.copy())

    def is_compiled_anew(self, label: str | None) -> bool:
        """Whether a run of this segment takes subscripts and the like as they are now."""
        self._forget_old()
        return label is not None or self.label is not None

    def begin(self, segment: Segment) -> Positions:
        """Save the start of a run; return its positions, to be moved by the run."""
        self._forget_old()
        values, key = self.values, segment.label
        known = self.positions
        if known is None or key is not None or len(known.counters) < segment.counters:
            known = Positions(np.zeros(max(segment.counters, 1), dtype=np.int64))
        known.runs += 1
        self.positions = known if key is None else None
        self.label = key
        if self._begun.get(key) is not segment:  # its states may be arrays that were none before
            self._begun = {**self._begun, key: segment}
            self._names = -1
        states = [(slot, values.data[slot : slot + count].copy()) for slot, count in self._state_ranges()]
        cells = values.cells
        self.start = Start(cells[T], cells[DT], values.defined[DT], states)
        return known

    def reset(self) -> None:
        """Go back to the start of the last run, if there was one; the next begins anew."""
        self._forget_old()
        start, values = self.start, self.values
        self.positions = None
        if start is None:
            return
        values.assign(T, start.t)
        values.cells[DT] = start.dt
        values.defined[DT] = start.dt_defined
        for slot, numbers in start.states:
            values.data[slot : slot + len(numbers)] = numbers

    def _forget_old(self) -> None:
        if self.generation != self.values.generation:
            self.generation = self.values.generation
            self.positions = self.label = self.start = None
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
