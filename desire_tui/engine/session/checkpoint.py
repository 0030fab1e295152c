"""Everything that a run begins from, to begin there again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.engine.runtime.defaults import SavedDefaults
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
    defaults: SavedDefaults

    @classmethod
    def taken(cls, values: Values, simulator: Simulator) -> Checkpoint:
        """Return everything as it is now."""
        return cls(values.saved(), simulator.history.copy(), simulator.defaults.saved())

    def restore(self, values: Values, simulator: Simulator) -> None:
        """Make everything as it was then."""
        values.restore(self.saved)
        simulator.history = self.history.copy()
        simulator.defaults.restore(self.defaults)
