"""Where a run stood at the start of its last block, so that a failure in it can be looked at again."""

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


@dataclass(frozen=True)
class BlockStart:
    """A copy of all that a run's next steps depend on, but for what a solver remembers."""

    memory: RunMemory
    content: bytes
    counters: NDArray[np.int64]
    counted: NDArray[np.int64]
    values: Saved

    @classmethod
    def taken(cls, memory: RunMemory, counters: NDArray[np.int64], values: Values) -> BlockStart | None:
        """Return a copy of the present, None of a large model."""
        if values.numbers_used > NUMBERS_MOST:
            return None
        return cls(memory, bytes(memory), counters, counters.copy(), values.saved())

    def put_back(self, values: Values) -> None:
        """Go back to it."""
        ctypes.memmove(ctypes.addressof(self.memory), self.content, len(self.content))
        self.counters[:] = self.counted
        values.restore(self.values)
