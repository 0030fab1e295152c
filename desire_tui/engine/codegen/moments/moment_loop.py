"""The run loop of models with events: that of `loop.run_loop`, its steps made elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.loop.array_storage import ArrayStorage
from desire_tui.engine.codegen.loop.compiled_loops import named
from desire_tui.engine.codegen.loop.fixed_steps import TOLERANCE
from desire_tui.engine.codegen.loop.run_loop import Driver
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.integration.tableaus import Tableau

_SHARED = {"k": "k", "t_base": "t_base", "dt_base": "dt_base", "steps": "steps"}
"""Variables of the loop that a step moves, by their fields in the run's memory."""
_FAULTS = (Ended.ZENO, Ended.STALLED, Ended.DEADLOCK, Ended.CHATTERS, Ended.FULL)


class MomentDriver(Driver):
    """Calls `runtime.moments.steps.step` where others make a step."""

    def _renew_in_interval(self) -> None:
        self.storage.run_pass("step_renewal", 1)

    def _step(self, tableau: Tableau) -> None:
        text, lanes = self.text, self.lanes
        text.begin("step")
        self._call()
        limit = self.get("t_next")
        if not tableau.variable:  # variable steps end on it exactly
            limit = lanes.sub(limit, lanes.mul(lanes.const(TOLERANCE), self.get("dt_base")))
        self.arrived(lanes.compare("oge", self.storage.load(T), limit), check_every=1)

    def _next_without_rule(self) -> None:
        text = self.text
        self._renew("renew", "renewal")
        text.begin("step")
        self._call()
        self.put("reached", "1")
        stop = text.op(f"icmp ne i32 {self.memory.load('stop', volatile=True)}, 0")
        self.put("stop", stop)
        text.branch(text.op(f"or i1 {stop}, {self.hurried()}"), "attend", "point")

    def _call(self) -> None:
        text = self.text
        for name, field in _SHARED.items():
            self.memory.store(field, self.get(name))
        function, moments = self.context.load("interval"), self.context.load("problem")
        ended = text.op(f"call i32 {function}(ptr {moments}, ptr %m, double {self.get('t_next')})")
        for name, field in _SHARED.items():
            self.put(name, self.memory.load(field))
        cases = " ".join(f"i32 {int(fault)}, label %moment.{fault.name.lower()}" for fault in _FAULTS)
        text.do(f"switch i32 {ended}, label %moment.done [ {cases} ]")
        for fault in _FAULTS:
            text.begin(f"moment.{fault.name.lower()}")
            self.leave(fault, Phase.AFTER_POINT if fault is Ended.FULL else Phase.ENDED)
        text.begin("moment.done")


def moment_loop(tableau: Tableau | None) -> Piece:
    """Write the loop, the same for all models of a rule; None: there are no states."""
    text = IrText()
    MomentDriver(text, ArrayStorage(text, 1, 1, contiguous=False), tableau).write()
    return named(text)
