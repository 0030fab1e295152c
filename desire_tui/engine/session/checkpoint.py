"""Everything that a run begins from, to begin there again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.defaults import Wishes
    from desire_tui.engine.runtime.history import RunHistory
    from desire_tui.engine.runtime.simulator import Simulator
    from desire_tui.engine.values import Saved, Values

NUMBERS_MOST = 1 << 20
"""Of larger models no start is kept at each drun: that would take longer than a short run."""


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """Quantities, random numbers, positions of histories, and which settings are defaults."""

    saved: Saved
    history: RunHistory
    defaults: Wishes

    @classmethod
    def now(cls, values: Values, simulator: Simulator) -> Checkpoint:
        """Return the present situation."""
        return cls(values.saved(), simulator.history.copy(), simulator.defaults.saved())

    def put_back(self, values: Values, simulator: Simulator) -> None:
        """Make it the present situation again."""
        values.restore(self.saved)
        simulator.history = self.history.copy()
        simulator.defaults.restore(self.defaults)
