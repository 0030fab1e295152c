"""`every T, t0` for runs in lock step: all have the same times, and split a step at the same places.

What `runtime.moments.steps` does for one run, written for many.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.codegen.lanes.lane_steps import LaneSteps
from desire_tui.engine.runtime.moments.steps import SLACK
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_points import LanePoints
    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables
    from desire_tui.engine.integration.tableaus import Tableau


class ClockSlots(NamedTuple):
    """How many clocks there are; the pass `blocks` looks at slot `due` + number of each."""

    clocks: int
    due: int


class LaneClocks:
    """Writes what clocks do. At `side` are (clocks, 4): period, start, ticks so far, next time."""

    def __init__(self, loop: LaneVariables, slots: ClockSlots) -> None:
        self.loop, self.text, self.one = loop, loop.text, loop.one
        self._count, self._due = slots

    def begin(self) -> None:
        """Write what comes before a run's first pass: what is due at its start."""
        text = self.text
        clocks = self.loop.memory.load("side")
        for number in range(self._count):
            for place, name in enumerate(("period", "start", "ticks", "next")):
                text.alloca("double", f"%l.{name}.{number}")
                at = text.op(f"getelementptr double, ptr {clocks}, i64 {4 * number + place}")
                self.loop.put("double", f"{name}.{number}", text.op(f"load double, ptr {at}"))
            self.loop.cells.store(self._due + number, Number(self.one.const(0.0), wide=False))
        text.alloca("i1", "%l.came")
        self.arrive(self.one.const(0.0))

    def next_time(self) -> str:
        """Return when the next of them is due."""
        found = self._get("next", 0)
        for number in range(1, self._count):
            other = self._get("next", number)
            found = self.one.choose(self.one.compare("olt", other, found), other, found)
        return found

    def arrive(self, slack: str) -> None:
        """Write the blocks of those that are due at t, or `slack` later."""
        text, one, loop = self.text, self.one, self.loop
        limit = one.add(loop.t(), slack)
        loop.put("i1", "came", "false")
        for number in range(self._count):
            look, tick, on = (f"{stem}{text.fresh()}" for stem in ("clock", "tick", "on"))
            text.jump(look)
            text.begin(look)
            text.branch(one.compare("ole", self._get("next", number), limit), tick, on)
            text.begin(tick)
            loop.put("i1", "came", "true")
            loop.cells.store(self._due + number, Number(one.const(1.0), wide=False))
            ticks = one.add(self._get("ticks", number), one.const(1.0))
            loop.put("double", f"ticks.{number}", ticks)
            following = one.add(self._get("start", number), one.mul(ticks, self._get("period", number)))
            loop.put("double", f"next.{number}", following)
            text.jump(look)
            text.begin(on)
        some, none = (f"{stem}{text.fresh()}" for stem in ("due", "none"))
        text.branch(loop.get("i1", "came"), some, none)
        text.begin(some)
        loop.run_pass("blocks", 1)
        for number in range(self._count):
            loop.cells.store(self._due + number, Number(one.const(0.0), wide=False))
        text.jump(none)
        text.begin(none)

    def _get(self, name: str, number: int) -> str:
        return self.loop.get("double", f"{name}.{number}")


class ClockedSteps(LaneSteps):
    """Steps that are made in parts where a clock is due in them."""

    def __init__(
        self,
        loop: LaneVariables,
        points: LanePoints,
        tableau: Tableau,
        states: Sequence[int],
        clocks: LaneClocks,
    ) -> None:
        super().__init__(loop, points, tableau, states)
        self.clocks = clocks

    def _step(self) -> None:
        text, loop, one = self.text, self.loop, self.one
        for name in ("here", "end"):
            text.alloca("double", f"%l.{name}")
        text.alloca("i1", "%l.whole")
        text.begin("step")
        dt = self.memory.load("dt")
        slack = one.mul(one.const(SLACK), dt)
        loop.put("double", "here", loop.t())
        loop.put("double", "end", self._counted_time(1.0, dt))
        loop.put("i1", "whole", "true")
        text.jump("part")
        text.begin("part")
        here, end, soon = loop.get("double", "here"), loop.get("double", "end"), self.clocks.next_time()
        early = one.compare("olt", soon, one.sub(end, slack))
        later = one.choose(one.compare("ogt", here, soon), here, soon)
        stop = one.choose(early, later, end)
        whole = text.op(f"and i1 {loop.get('i1', 'whole')}, {text.op(f'xor i1 {early}, true')}")
        loop.put("i1", "whole", whole)
        self._part(here, one.choose(whole, dt, one.sub(stop, here)))
        self.cells.store(T, Number(stop, wide=False))
        self.clocks.arrive(slack)
        text.branch(one.compare("oge", stop, end), "step.done", "part.on")
        text.begin("part.on")
        loop.run_pass("derivative", 1)
        loop.put("double", "here", stop)
        text.jump("part")
        text.begin("step.done")
        self._arrive(dt, 1)
