"""The run loop of rules 9 … 16: language.md 8.2 as `loop.run_loop` writes it, a step a whole interval."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.loop.array_storage import ArrayStorage
from desire_tui.engine.codegen.loop.compiled_loops import named
from desire_tui.engine.codegen.loop.run_loop import Driver
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.runtime.run_memory import Ended, Phase

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.integration.tableaus import Tableau


_FAULTS = (Ended.SOLVER, Ended.CHATTERS, Ended.ZENO, Ended.FULL)


class StiffDriver(Driver):
    """Calls `the interval` where others make a step; it also makes the step passes inside the interval."""

    def _step(self, tableau: Tableau) -> None:  # noqa: ARG002 - CVODE has its own coefficients
        text = self.text
        text.begin("step")
        call = f"call i32 {self.context.load('interval')}("
        ended = text.op(f"{call}ptr {self.context.load('problem')}, ptr %m, double {self.get('t_next')})")
        self.put("steps", self.memory.load("steps"))  # counted where they are made
        others = (Ended.STOPPED, Ended.TERM, *_FAULTS)
        cases = " ".join(f"i32 {int(e)}, label %interval.{e.name.lower()}" for e in others)
        text.do(f"switch i32 {ended}, label %interval.done [ {cases} ]")
        for name, reached, stop in (("done", 1, 0), ("stopped", 0, 1)):
            text.begin(f"interval.{name}")
            self.put("reached", str(reached))
            self.put("stop", str(stop))
            text.jump("attend")
        text.begin("interval.term")
        self.context.store("term", self.memory.load("which"))
        text.jump("tail")
        for fault in _FAULTS:
            text.begin(f"interval.{fault.name.lower()}")
            self.leave(fault, Phase.AFTER_POINT if fault is Ended.FULL else Phase.ENDED)


def stiff_loop() -> Piece:
    """Write the loop; it is the same for all models and all eight rules."""
    text = IrText()
    storage = ArrayStorage(text, 1, 1, contiguous=False)
    # one stage: what the loop wants to know is only that there are steps without error control
    StiffDriver(text, storage, EULER).write()
    return named(text)
