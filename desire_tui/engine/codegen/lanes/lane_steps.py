"""Steps of runs in lock step under a rule with fixed steps: stages, new states, t."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.codegen.lanes.lane_stages import advance, save
from desire_tui.engine.codegen.loop.fixed_steps import TOLERANCE
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_points import LanePoints
    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables
    from desire_tui.engine.integration.tableaus import Tableau

_CHECK_EVERY = 1024
"""Steps between two looks for inf and nan inside a communication interval, as in `loop.fixed_steps`."""


class LaneSteps:
    """Writes the blocks `again` … `attend`. `states` are their slots."""

    def __init__(
        self, loop: LaneVariables, points: LanePoints, tableau: Tableau, states: Sequence[int]
    ) -> None:
        self.loop, self.text, self.runs = loop, loop.text, loop.runs
        self.one, self.cells, self.memory = loop.one, loop.cells, loop.memory
        self.points, self.tableau, self.states = points, tableau, states

    def write(self) -> None:
        """Write everything from a step's start to the next one or to a communication point."""
        self._again()
        self._step()
        self._attend()

    def _again(self) -> None:
        text = self.text
        text.begin("again")
        self.loop.clear_fired()
        self.loop.run_pass("step", 1)
        if not self.loop.may_end:
            text.jump("step")
            return
        fired = self.runs.both(self.loop.flags("fired"), self.loop.flags("alive"))
        text.branch(self.runs.any(fired), "tail", "step")
        text.begin("tail")
        self.loop.run_pass("tail", 1, fired)
        self.points.sample(fired)
        self.loop.freeze(fired)
        text.branch(self.runs.any(self.loop.flags("alive")), "step", "exit")

    def _step(self) -> None:
        text, cells, tableau = self.text, self.cells, self.tableau
        text.begin("step")
        save(cells, self.states)
        dt = self.memory.load("dt")
        for stage in range(1, tableau.stages):
            advance(cells, self.states, tableau.a[stage], dt)
            cells.store(T, Number(self._counted_time(float(tableau.c[stage]), dt), wide=False))
            self.loop.run_pass("derivative", stage + 1)
        advance(cells, self.states, tableau.b, dt)
        cells.store(T, Number(self._counted_time(1.0, dt), wide=False))
        self._arrive(dt, _CHECK_EVERY)

    def _part(self, here: str, dt: str) -> None:
        """Write a step from `here` as `runtime.moments.stages` makes it; t is left to the caller."""
        cells, tableau, one = self.cells, self.tableau, self.one
        save(cells, self.states)
        for stage in range(1, tableau.stages):
            advance(cells, self.states, tableau.a[stage], dt, from_zero=True)
            t = one.add(here, one.mul(one.const(float(tableau.c[stage])), dt))
            cells.store(T, Number(t, wide=False))
            self.loop.run_pass("derivative", stage + 1)
        advance(cells, self.states, tableau.b, dt, from_zero=True)

    def _arrive(self, dt: str, check_every: int) -> None:
        """Write the end of a step."""
        text = self.text
        for name in ("k", "steps"):
            self.loop.put("i64", name, text.op(f"add i64 {self.loop.get('i64', name)}, 1"))
        slack = self.one.mul(self.one.const(TOLERANCE), dt)
        reached = self.one.compare(
            "oge", self.loop.t(), self.one.sub(self.loop.get("double", "t_next"), slack)
        )
        since = text.op(f"and i64 {self.loop.get('i64', 'steps')}, {check_every - 1}")
        due = text.op(f"icmp eq i64 {since}, 0")
        self.loop.put("i1", "reached", reached)
        text.branch(text.op(f"or i1 {due}, {reached}"), "attend", "again")

    def _counted_time(self, c: float, dt: str) -> str:
        k = self.text.op(f"sitofp i64 {self.loop.get('i64', 'k')} to double")
        return self.one.add(self.memory.load("t_start"), self.one.mul(self.one.add(k, self.one.const(c)), dt))

    def _attend(self) -> None:
        text = self.text
        text.begin("attend")
        self.loop.flag(self.loop.wild(self.states))
        stop = text.op(f"icmp ne i64 {self.memory.load('stop', volatile=True)}, 0")
        none = text.op(f"xor i1 {self.runs.any(self.loop.flags('alive'))}, true")
        text.branch(text.op(f"or i1 {stop}, {none}"), "exit", "attend.on")
        text.begin("attend.on")
        text.branch(self.loop.get("i1", "reached"), "point", "again")
