"""Steps of constant length (all rules but 4, 7 and 8; language.md 11)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.loop.frame import LoopFrame
    from desire_tui.engine.integration.tableaus import Tableau

TOLERANCE = 1e-9
"""Relative to DT: a step end this little before a communication point is at it."""
_CHECK_EVERY = 1024
"""Steps between two looks for inf and nan inside a communication interval."""


class FixedStep:
    """Writes a step of DT; where the rule lets the program set DT, a new DT begins a new count of steps."""

    def __init__(self, driver: LoopFrame, tableau: Tableau) -> None:
        self.driver = driver
        self.tableau = tableau

    def write(self) -> None:
        """Write everything from the saved states to the next pass."""
        driver, tableau, storage = self.driver, self.tableau, self.driver.storage
        if tableau.rule.dt_may_change:
            self._follow_step()
        else:
            driver.put("h", driver.get("dt_base"))
        dt = driver.get("h")
        whole = storage.whole_step()
        if whole:
            self._whole(whole, dt)
        for stage in range(1, tableau.stages):
            storage.advance(tableau.a[stage], dt, saves=stage == 1)
            storage.store(T, driver.counted_time(float(tableau.c[stage]), dt))
            driver.run_pass("derivative", stage + 1)
        storage.advance(tableau.b, dt, saves=tableau.stages == 1)
        if whole:
            driver.text.jump("step.taken")
            driver.text.begin("step.taken")
        storage.store(T, driver.counted_time(1.0, dt))
        driver.count("k")
        driver.count("steps")
        driver.arrived(self._reached(), check_every=_CHECK_EVERY)

    def _whole(self, function: str, dt: str) -> None:
        """Let a function take the step, if there is one."""
        driver, text = self.driver, self.driver.text
        text.branch(text.op(f"icmp eq ptr {function}, null"), "step.stages", "step.whole")
        text.begin("step.whole")
        k = text.op(f"sitofp i64 {driver.get('k')} to double")
        known = text.op(f"select i1 {driver.get('known')}, ptr %k1, ptr null")
        arguments = f"ptr %v, ptr {known}, double {driver.get('t_base')}, double {k}, double {dt}"
        text.do(f"call void {function}({arguments})")
        for _ in range(1, self.tableau.stages):
            driver.count("calls")
        text.jump("step.taken")
        text.begin("step.stages")

    def _reached(self) -> str:
        lanes = self.driver.lanes
        slack = lanes.mul(lanes.const(TOLERANCE), self.driver.get("h"))
        limit = lanes.sub(self.driver.get("t_next"), slack)
        return lanes.compare("oge", self.driver.storage.load(T), limit)

    def _follow_step(self) -> None:
        """H ← DT; a changed DT begins a new count of steps."""
        driver, text = self.driver, self.driver.text
        dt = driver.storage.load(DT)
        text.branch(driver.lanes.compare("une", dt, driver.get("dt_base")), "step.changed", "step.same")
        text.begin("step.changed")
        here = driver.storage.load(T)
        forward = driver.lanes.compare("ogt", driver.lanes.add(here, dt), here)
        text.branch(forward, "step.forward", "stalled")
        text.begin("stalled")
        driver.leave(Ended.STALLED, Phase.ENDED)
        text.begin("step.forward")
        driver.put("t_base", here)
        driver.put("k", "0")
        driver.put("dt_base", dt)
        text.jump("step.same")
        text.begin("step.same")
        driver.put("h", dt)
