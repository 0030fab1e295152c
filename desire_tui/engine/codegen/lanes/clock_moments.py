"""What runs in lock step need for `every T, t0` besides code: times that all runs share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.lanes.lane_clocks import ClockSlots
from desire_tui.engine.passes.moments import blocks_pass
from desire_tui.engine.runtime.event_times import event_times
from desire_tui.engine.runtime.moments.setup import first_tick

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.codegen.lanes.lane_events import EventSlots
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.values import Values

    Passes = Mapping[str, tuple[Action, ...]]


class NoMoments:
    """Nothing happens at moments. What else there is, is a subclass.

    `passes` are computed besides those of every segment. `address`: what compiled code finds at `side`.
    """

    address = 0

    def __init__(self) -> None:
        self.passes: dict[str, tuple[Action, ...]] = {}

    def changed(self, passes: Passes) -> Iterable[int]:
        """Return slots that differ between runs whatever varies; `passes` are all that there are."""
        del passes
        return ()

    def slots(self, passes: Passes) -> ClockSlots | EventSlots | None:
        """Return what the code has to know."""
        del passes
        return None

    def connect(
        self,
        code: CodeCache,
        improver: Improver,
        derivative: tuple[Action, ...],
        own: Sequence[int],
        varies: Container[int],
    ) -> None:
        """Compile what single runs need.

        `own` are the slots of what differs, in the order of the code, `varies` all slots that do.
        """

    def prepare(self, plan: RunPlan, starts: NDArray[np.float64], given: Sequence[int]) -> NDArray[np.bool_]:
        """Make ready for runs with these `starts`, (runs, given slots), all groups complete.

        Return which runs cannot begin. DesireError: none can.
        """
        del plan, given
        return np.zeros(len(starts), dtype=np.bool_)


class ClockMoments(NoMoments):
    """Clocks whose times all runs share."""

    def __init__(self, segment: Segment, values: Values) -> None:
        self._segment, self._values, self._count = segment, values, len(segment.events)
        self._due = values.room(self._count)
        self.passes = {"blocks": blocks_pass(segment, self._due)}
        self._times = np.zeros((self._count, 4))
        self.address = int(self._times.ctypes.data)

    def slots(self, passes: Passes) -> ClockSlots:
        """Return what the code has to know."""
        del passes
        return ClockSlots(self._count, self._due)

    def prepare(self, plan: RunPlan, starts: NDArray[np.float64], given: Sequence[int]) -> NDArray[np.bool_]:
        """Find period, start, ticks so far and next time of each clock. DesireError 487."""
        for row, (period, start) in zip(self._times, event_times(self._segment, self._values), strict=True):
            ticks = first_tick(period, start, plan.t0)
            row[:] = period, start, ticks, start + ticks * period
        return super().prepare(plan, starts, given)
