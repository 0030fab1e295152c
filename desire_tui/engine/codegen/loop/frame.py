"""What every part of the run loop works with: the loop's own variables, the run's memory, the way out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.work_memory import context_fields, memory_fields

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.loop.storage import Storage
    from desire_tui.engine.runtime.run_memory import Ended, Phase

_VARIABLES = {
    "k": "i64", "steps": "i64", "calls": "i64", "t_base": "double", "dt_base": "double", "t_next": "double",
    "t_here": "double", "h": "double", "phase": "i32", "ended": "i32", "last": "i1", "reached": "i1", "stop":
    "i1", "lands": "i1", "cut": "i1", "t_stop": "double", "looks": "i1",
    "known": "i1", "boxed": "i1", "clear": "i1",
}  # fmt: skip
"""`known`: the first stage was computed at a communication point, before the code behind OUT."""

_KEPT = {
    "k": "k", "t_base": "t_base", "dt_base": "dt_base", "phase": "phase", "steps": "steps", "calls":
    "derivative_calls",
}  # fmt: skip
"""Variables of the loop that live on in the run's memory, by their fields there."""


class LoopFrame:
    """Variables of the loop (stack cells), fields of `RunMemory` and of the context, and the exit."""

    watched = False
    """Whether something may switch inside a step (rules 4, 7, 8)."""

    def __init__(self, text: IrText, storage: Storage) -> None:
        self.text = text
        self.storage = storage
        self.lanes = Lanes(text)
        self.memory = memory_fields(text)
        self.context = context_fields(text)

    def enter(self) -> None:
        """Begin the function: variables as the call before left them."""
        for name, kind in _VARIABLES.items():
            self.text.alloca(kind, f"%{name}")
        self.storage.enter()
        for name, field in _KEPT.items():
            self.put(name, self.memory.load(field))

    def put(self, name: str, value: str) -> None:
        """Set a variable of the loop."""
        self.text.do(f"store {_VARIABLES[name]} {value}, ptr %{name}")

    def get(self, name: str) -> str:
        """Read a variable of the loop."""
        return self.text.op(f"load {_VARIABLES[name]}, ptr %{name}")

    def count(self, name: str) -> None:
        """Add one."""
        self.put(name, self.text.op(f"add i64 {self.get(name)}, 1"))

    def leave(self, ended: Ended, phase: Phase | None = None) -> None:
        """Go to the function's end."""
        self.put("ended", str(int(ended)))
        if phase is not None:
            self.put("phase", str(int(phase)))
        self.text.jump("exit")

    def exit(self) -> None:
        """Write the one way out: everything back to memory."""
        text = self.text
        text.begin("exit")
        self.storage.leave()
        for name, field in _KEPT.items():
            self.memory.store(field, self.get(name))
        text.do(f"ret i32 {self.get('ended')}")

    def run_pass(self, kind: str, stage: int) -> None:
        """Write a pass and count it."""
        self.storage.run_pass(kind, stage)
        self.count("calls")

    def hurried(self) -> str:
        """Return an i1: the call is to come back at the next step, faster code is there."""
        return self.text.op(f"icmp ne i64 {self.context.load('hurry', volatile=True)}, 0")

    def arrived(self, reached: str, *, check_every: int) -> None:
        """End a step; `reached`: it ended on a communication point. `check_every`: steps, a power of 2."""
        text = self.text
        self.put("reached", reached)
        since = text.op(f"and i64 {self.get('steps')}, {check_every - 1}")
        due = text.op(f"icmp eq i64 {since}, 0")
        stop = text.op(f"icmp ne i32 {self.memory.load('stop', volatile=True)}, 0")
        self.put("stop", stop)
        looked = text.op(f"or i1 {due}, {stop}")
        asked = text.op(f"or i1 {looked}, {self.hurried()}")
        text.branch(text.op(f"or i1 {asked}, {reached}"), "attend", "again")

    def counted_time(self, c: float, dt: str) -> str:
        """Return t_base + (k + c)·dt."""
        lanes = self.lanes
        k = self.text.op(f"sitofp i64 {self.get('k')} to double")
        return lanes.add(self.get("t_base"), lanes.mul(lanes.add(k, lanes.const(c)), dt))
