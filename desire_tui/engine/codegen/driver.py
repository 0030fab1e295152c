"""The run loop of language.md 8.2 as one function; what depends on rule or storage is asked from parts.

The loop, in blocks:

    point  ── full pass, sample, end? ──► step          (`again`, `point`: the phases a call may begin with)
    again  ── step pass; `term`? ──► step
    step   ── the rule: stages, new states, t ──► attend where something is to be looked at, else again
    attend ── stop flag, inf and nan ──► point or again

Times are t_base + k·dt_base while DT does not change. A fixed step that ends at t ≥ t_start + point·COMINT -
1e-9·DT has reached the next point.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.context import context_fields, memory_fields
from desire_tui.engine.codegen.lanes import Lanes
from desire_tui.engine.codegen.variable import VariableStep
from desire_tui.engine.runtime.memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.storage import Storage
    from desire_tui.engine.codegen.text import Text
    from desire_tui.engine.integration.tableaus import Tableau

TOLERANCE = 1e-9
"""Relative to DT: a step end this little before a communication point is at it."""
_CHECK_EVERY = 1024  # steps between two looks for inf and nan inside a communication interval


_VARIABLES = {
    "k": "i64", "steps": "i64", "calls": "i64", "t_base": "double", "dt_base": "double", "t_next": "double",
    "t_here": "double", "h": "double", "phase": "i32", "ended": "i32", "last": "i1", "reached": "i1", "stop":
    "i1", "lands": "i1", "cut": "i1",
}  # fmt: skip


_KEPT = {
    "k": "k", "t_base": "t_base", "dt_base": "dt_base", "phase": "phase", "steps": "steps", "calls":
    "derivative_calls",
}  # fmt: skip
"""Variables of the loop that live on in the run's memory, by their fields there."""


class Driver:
    """Writes the function `i32 @run(ptr memory, ptr context)`."""

    def __init__(self, text: Text, storage: Storage, tableau: Tableau | None) -> None:
        self.text = text
        self.storage = storage
        self.tableau = tableau
        self.lanes = Lanes(text)
        self.memory = memory_fields(text)
        self.context = context_fields(text)

    def write(self) -> None:
        """Write the whole body."""
        text, storage = self.text, self.storage
        for name, kind in _VARIABLES.items():
            text.alloca(kind, f"%{name}")
        storage.enter()
        for name, field in _KEPT.items():
            self.put(name, self.memory.load(field))
        self._next_point()
        text.branch(self._rows_full(), "full", "enter")
        text.begin("enter")
        text.do(
            f"switch i32 {self.get('phase')}, label %over [ i32 {int(Phase.AT_POINT)}, label %point"
            f" i32 {int(Phase.IN_STEP)}, label %again i32 {int(Phase.AFTER_POINT)}, label %recall ]"
        )
        text.begin("full")
        self.leave(Ended.RUNNING)
        text.begin("over")
        self.leave(Ended.TMAX)
        text.begin("recall")
        storage.recall_first_stage()
        text.jump("step")
        self._point()
        if self.tableau is None:
            text.begin("again")
            text.jump("point")
            self._next_without_rule()
        else:
            self._again()
            self._step(self.tableau)
        self._attend()
        self._exit()

    # ------------------------------------------------------------------ small things

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

    def _exit(self) -> None:
        """Write the one way out: everything back to memory."""
        text = self.text
        text.begin("exit")
        self.storage.leave()
        for name, field in _KEPT.items():
            self.memory.store(field, self.get(name))
        text.do(f"ret i32 {self.get('ended')}")

    def _next_point(self) -> None:
        """t_next ← t_start + point·COMINT."""
        index = self.text.op(f"sitofp i64 {self.memory.load('point')} to double")
        span = self.lanes.mul(index, self.memory.load("comint"))
        self.put("t_next", self.lanes.add(self.memory.load("t_start"), span))

    def _rows_full(self) -> str:
        return self.text.op(f"icmp sge i64 {self.memory.load('row')}, {self.memory.load('row_limit')}")

    def run_pass(self, kind: str, stage: int) -> None:
        """Write a pass and count it."""
        self.storage.run_pass(kind, stage)
        self.count("calls")

    def _clear_term(self) -> None:
        self.context.store("term", "-1")

    def _fired(self) -> str:
        return self.text.op(f"icmp sge i64 {self.context.load('term')}, 0")

    # ------------------------------------------------------------------ a communication point

    def _point(self) -> None:
        text = self.text
        text.begin("point")
        self._clear_term()
        self.run_pass("full", 1)
        index = self.memory.load("point")
        self.memory.store("point", text.op(f"add i64 {index}, 1"))
        last = text.op(f"or i1 {self._fired()}, {self._at_end(index)}")
        self.put("last", last)
        beyond = text.op(f"srem i64 {index}, {self.memory.load('every')}")
        due = text.op(f"icmp eq i64 {beyond}, 0")
        text.branch(text.op(f"or i1 {last}, {due}"), "sample", "sampled")
        self._sample()
        text.begin("sampled")
        self._next_point()
        if self.tableau is None:  # rule 0 goes on to the next point even after the last sample
            self.storage.store(T, self.get("t_next"))
        text.branch(self.get("last"), "finish", "onward")
        text.begin("finish")
        fired = self._fired()
        self.memory.store("which", self.context.load("term"))
        self.put("ended", text.op(f"select i1 {fired}, i32 {int(Ended.TERM)}, i32 {int(Ended.TMAX)}"))
        self.put("phase", str(int(Phase.ENDED)))
        text.jump("exit")
        text.begin("onward")
        text.branch(self._rows_full(), "point.full", "step")
        text.begin("point.full")  # come back now: the caller sees the values as they were sampled
        self.storage.keep_first_stage()
        self.leave(Ended.RUNNING, Phase.AFTER_POINT)

    def _at_end(self, index: str) -> str:
        """Whether point `index` is the run's last one."""
        if self.tableau is None:
            following = self.text.op(f"add i64 {index}, 1")
            return self.text.op(f"icmp sge i64 {following}, {self.memory.load('nn')}")
        lanes = self.lanes
        slack = lanes.mul(lanes.const(TOLERANCE), self.storage.load(DT))
        end = lanes.add(self.memory.load("t_start"), self.memory.load("t_max"))
        return lanes.compare("oge", self.storage.load(T), lanes.sub(end, slack))

    def _sample(self) -> None:
        """Write a row; inf or nan in it ends the run without it."""
        text = self.text
        text.begin("sample")
        row = self.memory.load("row")
        start = text.op(f"mul i64 {row}, {self.storage.width()}")
        at = text.op(f"getelementptr double, ptr {self.memory.load('rows')}, i64 {start}")
        bad = self.storage.row(at, self.storage.load(T))
        text.branch(bad, "wild", "sample.kept")
        text.begin("sample.kept")
        self.memory.store("row", text.op(f"add i64 {row}, 1"))
        text.jump("sampled")

    def _next_without_rule(self) -> None:
        text = self.text
        text.begin("step")
        self.put("reached", "1")
        stop = text.op(f"icmp ne i32 {self.memory.load('stop', volatile=True)}, 0")
        self.put("stop", stop)
        text.branch(text.op(f"or i1 {stop}, {self._hurry()}"), "attend", "point")

    # ------------------------------------------------------------------ steps

    def _again(self) -> None:
        text = self.text
        text.begin("again")
        self._clear_term()
        self.run_pass("step", 1)
        text.branch(self._fired(), "tail", "step")
        text.begin("tail")
        self.storage.run_pass("tail", 1)
        self.put("last", "1")
        text.jump("sample")

    def _step(self, tableau: Tableau) -> None:
        text, storage = self.text, self.storage
        text.begin("step")
        storage.save()
        if tableau.variable:
            VariableStep(self, tableau).write()
            return
        if tableau.dt_may_change:
            self._follow_step()
        else:
            self.put("h", self.get("dt_base"))
        dt = self.get("h")
        for stage in range(1, tableau.stages):
            storage.advance(tableau.a[stage], dt, last=False)
            storage.store(T, self._counted_time(float(tableau.c[stage]), dt))
            self.run_pass("derivative", stage + 1)
        storage.advance(tableau.b, dt, last=True)
        storage.store(T, self._counted_time(1.0, dt))
        self.count("k")
        self.count("steps")
        self._arrive()

    def _arrive(self) -> None:
        lanes = self.lanes
        slack = lanes.mul(lanes.const(TOLERANCE), self.get("h"))
        limit = lanes.sub(self.get("t_next"), slack)
        self.arrived(lanes.compare("oge", self.storage.load(T), limit))

    def arrived(self, reached: str) -> None:
        """End a step; `reached`: it ended on a communication point."""
        text = self.text
        self.put("reached", reached)
        mask = 0 if self.tableau is not None and self.tableau.variable else _CHECK_EVERY - 1
        since = text.op(f"and i64 {self.get('steps')}, {mask}")
        due = text.op(f"icmp eq i64 {since}, 0")
        stop = text.op(f"icmp ne i32 {self.memory.load('stop', volatile=True)}, 0")
        self.put("stop", stop)
        looked = text.op(f"or i1 {due}, {stop}")
        asked = text.op(f"or i1 {looked}, {self._hurry()}")
        text.branch(text.op(f"or i1 {asked}, {reached}"), "attend", "again")

    def _hurry(self) -> str:
        return self.text.op(f"icmp ne i64 {self.context.load('hurry', volatile=True)}, 0")

    def _attend(self) -> None:
        """Write what happens where a step has ended and something is to be looked at."""
        text = self.text
        text.begin("attend")
        text.branch(self.storage.wild(), "wild", "attend.finite")
        text.begin("wild")
        self.leave(Ended.NOT_FINITE, Phase.ENDED)
        text.begin("attend.finite")
        phases = f"i32 {int(Phase.AT_POINT)}, i32 {int(Phase.IN_STEP)}"
        reached = self.get("reached")
        self.put("phase", text.op(f"select i1 {reached}, {phases}"))
        stop = self.get("stop")
        self.put("ended", text.op(f"select i1 {stop}, i32 {int(Ended.STOPPED)}, i32 {int(Ended.RUNNING)}"))
        text.branch(text.op(f"or i1 {stop}, {self._hurry()}"), "exit", "attend.on")
        text.begin("attend.on")
        self.storage.leave()  # others watch the values while the run goes on
        self.memory.store("steps", self.get("steps"))
        text.branch(reached, "point", "again")

    def _counted_time(self, c: float, dt: str) -> str:
        """Return t_base + (k + c)·dt."""
        lanes = self.lanes
        k = self.text.op(f"sitofp i64 {self.get('k')} to double")
        return lanes.add(self.get("t_base"), lanes.mul(lanes.add(k, lanes.const(c)), dt))

    def _follow_step(self) -> None:
        """H ← DT; a changed DT begins a new count of steps."""
        text = self.text
        dt = self.storage.load(DT)
        text.branch(self.lanes.compare("une", dt, self.get("dt_base")), "step.changed", "step.same")
        text.begin("step.changed")
        self.put("t_base", self.storage.load(T))
        self.put("k", "0")
        self.put("dt_base", dt)
        text.jump("step.same")
        text.begin("step.same")
        self.put("h", dt)
