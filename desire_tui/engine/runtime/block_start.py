"""Where a run stood at the start of a block, so that a failure behind it can be looked at again.

A run that is short enough is looked at from its start: that is exact, whereas the derivatives that a step
in the middle began with are gone, and where a block begins depends on the clock.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Saved, Values

NUMBERS_MOST = 20_000
"""Of larger models no copy is kept: it would take a noticeable part of the 20 ms of a block."""
SAMPLES_MOST = 10_000
"""From there to the failure: each is perhaps looked at."""
WORK_MOST = 20_000_000
"""Steps from there to the failure, times numbers of the model: some tenths of a second."""


@dataclass(frozen=True)
class BlockStart:
    """A copy of all that a run's next steps depend on, but for what a solver remembers."""

    memory: RunMemory
    row: int
    steps: int
    content: bytes
    counters: NDArray[np.int64]
    counted: NDArray[np.int64]
    values: Saved

    @classmethod
    def taken(cls, memory: RunMemory, counters: NDArray[np.int64], values: Values) -> BlockStart | None:
        """Return a copy of the present, None of a large model."""
        if values.numbers_used > NUMBERS_MOST:
            return None
        return cls.here(memory, counters, values)

    @classmethod
    def here(cls, memory: RunMemory, counters: NDArray[np.int64], values: Values) -> BlockStart:
        """Return a copy of the present."""
        row, steps = int(memory.row), int(memory.steps)
        return cls(memory, row, steps, bytes(memory), counters, counters.copy(), values.saved())

    def is_far(self, memory: RunMemory, values: Values) -> bool:
        """Whether a run has gone so far from here that looking at it again would take too long."""
        work = (memory.steps - self.steps) * values.numbers_used
        return int(memory.row) - self.row > SAMPLES_MOST or int(work) > WORK_MOST

    def put_back(self, values: Values) -> None:
        """Go back to it."""
        ctypes.memmove(ctypes.addressof(self.memory), self.content, len(self.content))
        self.counters[:] = self.counted
        values.restore(self.values)
