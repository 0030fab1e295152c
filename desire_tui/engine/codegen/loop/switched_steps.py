"""Variable steps of a model that switches: they end where it does (`integration.switching`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.loop.variable_steps import VariableStep
from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.loop.frame import LoopFrame
    from desire_tui.engine.integration.tableaus import Tableau


class Watched(NamedTuple):
    """What may switch inside a step: something that depends on t alone, modes."""

    clocks: bool
    modes: bool


NOTHING = Watched(clocks=False, modes=False)


def write_departure(driver: LoopFrame) -> None:
    """Write what comes between a communication point and its first step: a switch of t may be just there."""
    text = driver.text
    text.begin("depart")
    driver.storage.leave()
    bits = text.op(f"call i32 {driver.context.load('depart')}(ptr {driver.context.load('watch')})")
    driver.storage.refresh()
    text.branch(text.op(f"icmp eq i32 {bits}, 0"), "renew", "departed")
    text.begin("departed")
    driver.run_pass("derivative", 1)
    text.branch(text.op(f"icmp sge i32 {bits}, {CHATTERS}"), "chatters", "step")
    text.begin("chatters")
    driver.leave(Ended.CHATTERS, Phase.ENDED)


class SwitchedStep(VariableStep):
    """Writes a step that ends on the next switch of t, and is cut where a mode switches."""

    def __init__(self, driver: LoopFrame, tableau: Tableau, watched: Watched) -> None:
        super().__init__(driver, tableau)
        self.watched = watched

    def _stop(self, here: str) -> str:
        context, text = self.driver.context, self.text
        if not self.watched.clocks:
            self.driver.put("t_stop", self.driver.get("t_next"))
            return self.driver.get("t_stop")
        self.storage.leave()
        t_next = self.driver.get("t_next")
        arguments = f"ptr {context.load('watch')}, double {here}, double {t_next}"
        self.driver.put("t_stop", text.op(f"call double {context.load('limit')}({arguments})"))
        return self.driver.get("t_stop")

    def _landing(self) -> str:
        return self.driver.get("t_stop")

    def _stage_time(self, c: float, t: str) -> str:
        """No stage may see what is behind the switch."""
        if c != 1.0:
            return t
        return self.lanes.choose(self.driver.get("lands"), self.driver.get("t_stop"), t)

    def _stage_done(self, stage: int) -> None:
        """See what the modes are where the tangents of the step's ends meet."""
        if stage != 1 or not self.watched.modes:
            return
        text, driver = self.text, self.driver
        if self.storage.has_box:
            text.branch(driver.get("boxed"), "stage.boxed", "stage.look")
            text.begin("stage.boxed")
            driver.put("clear", self.storage.is_in_box(at_end=False))
            text.jump("stage.seen")
            text.begin("stage.look")
        self.storage.run_pass("watch_stage", stage + 1)
        driver.put("looks", self.storage.switched("watch_stage"))
        if self.storage.has_box:
            text.jump("stage.seen")
            text.begin("stage.seen")

    def _end(self, lands: str) -> None:
        """Call for help where something may have switched; everything has to be in memory for that."""
        text, driver, storage = self.text, self.driver, self.storage
        context = driver.context
        short = self.lanes.compare("olt", driver.get("t_stop"), driver.get("t_next"))
        looked = text.op(f"and i1 {lands}, {short}")
        if self.watched.modes:
            looked = text.op(f"or i1 {looked}, {self._may_have_switched()}")
        text.branch(looked, "look", "followed")
        text.begin("look")
        driver.put("boxed", "0")
        storage.leave()
        storage.keep_start()
        storage.keep_first_stage()
        here, there, t_next = driver.get("t_here"), storage.load(T), driver.get("t_next")
        arguments = f"ptr {context.load('watch')}, double {here}, double {there}, double {t_next}"
        bits = text.op(f"call i32 {context.load('follow')}({arguments})")
        at_point = text.op(f"and i1 {lands}, {self.lanes.compare('oeq', driver.get('t_stop'), t_next)}")
        driver.put("lands", at_point)
        text.branch(text.op(f"icmp slt i32 {bits}, 0"), "followed", "switched")
        text.begin("switched")
        storage.refresh()
        driver.put("lands", self.lanes.compare("oge", storage.load(T), t_next))
        text.branch(text.op(f"icmp sge i32 {bits}, {CHATTERS}"), "chatters", "followed")
        text.begin("followed")
        driver.arrived(driver.get("lands"), check_every=1)

    def _may_have_switched(self) -> str:
        """Return an i1: some mode may have.

        A step that begins in the box where no mode switches, with all three corners of its parabola's
        triangle (`passes.watch_passes`), has stayed there; one that leaves it is looked at with care. Steps
        outside are looked at by their modes, and once in a while with care, for a new box.
        """
        text, driver, storage = self.text, self.driver, self.storage
        if not storage.has_box:
            storage.run_pass("watch_end", 2)
            return text.op(f"or i1 {driver.get('looks')}, {storage.switched('watch_end')}")
        inside = storage.is_in_box(at_end=True)
        text.branch(driver.get("boxed"), "end.boxed", "end.look")
        text.begin("end.boxed")
        stays = text.op(f"and i1 {driver.get('clear')}, {inside}")
        driver.put("looks", text.op(f"xor i1 {stays}, 1"))
        text.jump("end.seen")
        text.begin("end.look")
        storage.run_pass("watch_end", 2)
        found = text.op(f"or i1 {driver.get('looks')}, {storage.switched('watch_end')}")
        wait = text.op("load i64, ptr %box_wait")
        text.do(f"store i64 {text.op(f'add i64 {wait}, -1')}, ptr %box_wait")
        due = text.op(f"icmp sle i64 {wait}, 1")
        outside = text.op(f"xor i1 {inside}, 1")
        found = text.op(f"or i1 {found}, {text.op(f'and i1 {due}, {outside}')}")
        driver.put("boxed", inside)
        driver.put("looks", found)
        text.jump("end.seen")
        text.begin("end.seen")
        return driver.get("looks")
