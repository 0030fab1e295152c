"""Variable steps, rules 4, 7 and 8 (language.md 11): try, judge, halve or double."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.tableaus import CHANGE, LATE_HOLD, LATE_PARTS, STILL_MOST
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, ERRMAX, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.loop.frame import LoopFrame
    from desire_tui.engine.integration.tableaus import Tableau

_TOLERANCE = 1e-9
"""A step that would end this near to a communication point (relative to what is left) ends on it."""


def write_renewal_in_interval(driver: LoopFrame) -> None:
    """Write what makes k1 anew behind a step's start; DT is less where code there has changed it by much."""
    text, lanes, storage, memory = driver.text, driver.lanes, driver.storage, driver.memory
    text.branch(storage.has_pass("step_renewal"), "renew.anew", "step")
    text.begin("renew.anew")
    storage.save()
    storage.keep_change()
    storage.run_pass("step_renewal", 1)
    dt, most = storage.load(DT), memory.load("error_max")
    change, _ = storage.difference(CHANGE, dt)
    length = lanes.div(lanes.intrinsic("fabs", memory.load("t_max")), lanes.const(float(LATE_PARTS)))
    least = lanes.choose(lanes.compare("olt", length, dt), length, dt)
    wanted = lanes.mul(dt, lanes.div(most, change))
    wanted = lanes.choose(lanes.compare("olt", wanted, least), least, wanted)
    late = lanes.compare("ogt", change, most)
    storage.store(DT, lanes.choose(late, wanted, dt))
    before, hold = memory.load("late_dt"), memory.load("late_hold")
    larger = lanes.choose(lanes.compare("ogt", dt, before), dt, before)
    memory.store("late_dt", lanes.choose(late, larger, before))
    memory.store("late_hold", text.op(f"select i1 {late}, i64 {LATE_HOLD}, i64 {hold}"))


class VariableStep:
    """Writes the step of a rule that controls it.

    A step ends on every communication point. A test difference above ERMAX halves the step and repeats it
    from the same states and the same k1; half a step below DTMIN is a deadlock. A difference below ERMIN
    doubles DT up to DTMAX, unless the step was shortened for a communication point.
    """

    def __init__(self, driver: LoopFrame, tableau: Tableau) -> None:
        self.driver = driver
        self.tableau = tableau
        self.text = driver.text
        self.lanes = driver.lanes
        self.storage = driver.storage

    def write(self) -> None:
        """Write everything from the chosen step to the next pass."""
        self._choose()
        self.text.jump("try")
        self.text.begin("try")
        self._stages()
        self._judge()

    def _choose(self) -> None:
        """H ← DT, or what is left to the next communication point."""
        lanes = self.lanes
        here, dt = self.storage.load(T), self.storage.load(DT)
        self.driver.put("t_here", here)
        left = lanes.sub(self._stop(here), here)
        lands = lanes.compare("oge", dt, lanes.mul(left, lanes.const(1.0 - _TOLERANCE)))
        cut = lanes.compare("ogt", dt, lanes.mul(left, lanes.const(1.0 + _TOLERANCE)))
        self.driver.put("lands", lands)
        self.driver.put("cut", cut)
        self.driver.put("h", lanes.choose(lands, left, dt))

    def _stop(self, here: str) -> str:  # noqa: ARG002 - others may have to stop earlier
        """Return where the step must end at the latest."""
        return self.driver.get("t_next")

    def _stages(self) -> None:
        lanes, driver, tableau = self.lanes, self.driver, self.tableau
        dt = driver.get("h")
        for stage in range(1, tableau.stages):
            self.storage.advance(tableau.a[stage], dt)
            c = float(tableau.c[stage])
            part = dt if c == 1.0 else lanes.mul(lanes.const(c), dt)
            self.storage.store(T, self._stage_time(c, lanes.add(driver.get("t_here"), part)))
            driver.run_pass("derivative", stage + 1)
            self._stage_done(stage)

    def _stage_done(self, stage: int) -> None:
        """Go on behind a stage's pass, from 1."""

    def _stage_time(self, c: float, t: str) -> str:  # noqa: ARG002
        """Return a stage's time, `t` but for rounding; `c`: its place in the step."""
        return t

    def _judge(self) -> None:
        text, lanes, driver = self.text, self.lanes, self.driver
        assert self.tableau.test is not None
        dt = driver.get("h")
        difference, state = self.storage.difference(self.tableau.test, dt)
        too_large = lanes.compare("ogt", difference, driver.memory.load("error_max"))
        text.branch(too_large, "reject", "accept")
        self._reject(difference, state, dt)
        self._accept(difference, state, dt)

    def _reject(self, difference: str, state: str, dt: str) -> None:
        text, lanes, driver = self.text, self.lanes, self.driver
        text.begin("reject")
        half = lanes.mul(lanes.const(0.5), dt)
        stuck = lanes.compare("olt", half, driver.memory.load("dt_min"))
        text.branch(stuck, "deadlock", "halve")
        text.begin("deadlock")
        self.storage.restore()
        self.storage.store(T, driver.get("t_here"))
        self.storage.store(ERRMAX, difference)
        driver.memory.store("which", state)
        driver.leave(Ended.DEADLOCK, Phase.ENDED)
        text.begin("halve")
        driver.memory.store("rejected", text.op(f"add i64 {driver.memory.load('rejected')}, 1"))
        self.storage.store(DT, half)
        driver.put("h", half)
        driver.put("lands", "0")
        driver.put("cut", "0")
        text.jump("try")

    def _accept(self, difference: str, state: str, dt: str) -> None:
        text, lanes, driver, storage = self.text, self.lanes, self.driver, self.storage
        text.begin("accept")
        lands, here = driver.get("lands"), driver.get("t_here")
        there = lanes.add(here, dt)
        self._stall(lands, lanes.compare("ogt", there, here), dt)
        storage.restore()
        storage.store(T, here)
        driver.memory.store("which", state)
        driver.leave(Ended.STALLED, Phase.ENDED)
        text.begin("forward")
        storage.advance(self.tableau.b, dt)
        driver.count("steps")
        storage.store(T, lanes.choose(lands, self._landing(), there))
        self._note_extremes(dt)
        small = lanes.compare("olt", difference, driver.memory.load("error_min"))
        whole = text.op(f"xor i1 {driver.get('cut')}, 1")
        grows = text.op(f"and i1 {small}, {whole}")
        now = storage.load(DT)
        doubled = lanes.mul(lanes.const(2.0), now)
        if storage.may_come_late:
            grows = self._grows_again(grows, doubled)
        most = driver.memory.load("dt_max")
        wider = lanes.choose(lanes.compare("olt", doubled, most), doubled, most)
        storage.store(DT, lanes.choose(grows, wider, now))
        self._end(lands)

    def _grows_again(self, grows: str, doubled: str) -> str:
        """Hold DT for a while where code behind `step` has made it small."""
        text, memory = self.text, self.driver.memory
        hold, before = memory.load("late_hold"), memory.load("late_dt")
        is_free = text.op(f"icmp sle i64 {hold}, 0")
        grows = text.op(f"and i1 {grows}, {is_free}")
        less = text.op(f"select i1 {is_free}, i64 0, i64 {text.op(f'add i64 {hold}, -1')}")
        below = self.lanes.compare("olt", doubled, before)
        again = text.op(f"and i1 {grows}, {below}")
        memory.store("late_hold", text.op(f"select i1 {again}, i64 {LATE_HOLD}, i64 {less}"))
        over = text.op(f"and i1 {grows}, {text.op(f'xor i1 {below}, 1')}")
        memory.store("late_dt", self.lanes.choose(over, self.lanes.const(0.0), before))
        return grows

    def _landing(self) -> str:
        """Return where a step ends that was made to fit."""
        return self.driver.get("t_next")

    def _end(self, lands: str) -> None:
        """Go on behind the step."""
        self.driver.arrived(lands, check_every=1)

    def _stall(self, lands: str, moves: str, dt: str) -> None:
        """End the run if DT is not above 0, or if t has stood still for too long; `k` counts such steps.

        For some steps it may: before a state becomes infinite, DT falls below what t can resolve.
        """
        text, driver = self.text, self.driver
        moves = text.op(f"or i1 {lands}, {moves}")
        still = text.op(f"add i64 {driver.get('k')}, 1")
        driver.put("k", text.op(f"select i1 {moves}, i64 0, i64 {still}"))
        short = text.op(f"icmp slt i64 {driver.get('k')}, {STILL_MOST}")
        positive = text.op(f"or i1 {lands}, {self.lanes.compare('ogt', dt, self.lanes.const(0.0))}")
        text.branch(text.op(f"and i1 {short}, {positive}"), "forward", "stalled")
        text.begin("stalled")

    def _note_extremes(self, dt: str) -> None:
        """Smallest and largest step so far; 0 means none yet."""
        lanes, memory, op = self.lanes, self.driver.memory, self.text.op
        least, most = memory.load("dt_least"), memory.load("dt_most")
        none = lanes.compare("oeq", least, lanes.const(0.0))
        less = op(f"or i1 {none}, {lanes.compare('olt', dt, least)}")
        memory.store("dt_least", lanes.choose(less, dt, least))
        memory.store("dt_most", lanes.choose(lanes.compare("ogt", dt, most), dt, most))
