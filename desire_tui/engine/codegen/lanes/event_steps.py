"""Steps of runs in lock step that may have an event in them: tried by all, made again alone by some."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.codegen.lanes.lane_steps import LaneSteps
from desire_tui.engine.runtime.moments.steps import SLACK
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_events import LaneEvents
    from desire_tui.engine.codegen.lanes.lane_points import LanePoints
    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables
    from desire_tui.engine.integration.tableaus import Tableau


class EventSteps(LaneSteps):
    """Writes them."""

    def __init__(
        self,
        loop: LaneVariables,
        points: LanePoints,
        tableau: Tableau,
        states: Sequence[int],
        events: LaneEvents,
    ) -> None:
        super().__init__(loop, points, tableau, states)
        self.events = events

    def _step(self) -> None:
        text, loop, one, events = self.text, self.loop, self.one, self.events
        for name in ("here", "end"):
            text.alloca("double", f"%l.{name}")
        text.begin("step")
        dt = self.memory.load("dt")
        here, end = loop.t(), self._counted_time(1.0, dt)
        loop.put("double", "here", here)
        loop.put("double", "end", end)
        events.note_known(one.add(end, one.mul(one.const(SLACK), dt)))
        events.record()
        events.save()
        loop.statements.values.is_inside = True
        self._part(here, dt)
        loop.statements.values.is_inside = False
        self.cells.store(T, Number(end, wide=False))
        text.branch(events.look(), "alone", "noted")
        text.begin("alone")
        events.step_alone(loop.get("double", "here"), loop.get("i64", "k"))
        self.cells.store(T, Number(loop.get("double", "end"), wide=False))
        text.jump("noted")
        text.begin("noted")
        events.note()
        self._arrive(dt, 1)
