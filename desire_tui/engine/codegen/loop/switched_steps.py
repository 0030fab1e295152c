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
        if stage == 1 and self.watched.modes:
            self.storage.run_pass("watch_stage", stage + 1)
            self.driver.put("looks", self.storage.switched("watch_stage"))

    def _end(self, lands: str) -> None:
        """Call for help where something may have switched; everything has to be in memory for that."""
        text, driver, storage = self.text, self.driver, self.storage
        context = driver.context
        short = self.lanes.compare("olt", driver.get("t_stop"), driver.get("t_next"))
        looked = text.op(f"and i1 {lands}, {short}")
        if self.watched.modes:
            storage.run_pass("watch_end", 2)
            inside = text.op(f"or i1 {driver.get('looks')}, {storage.switched('watch_end')}")
            looked = text.op(f"or i1 {looked}, {inside}")
        text.branch(looked, "look", "followed")
        text.begin("look")
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
