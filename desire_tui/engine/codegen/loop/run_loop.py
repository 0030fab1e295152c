"""The run loop of language.md 8.2 as one function; what depends on rule or storage is asked from parts.

The loop, in blocks:

    point  ── full pass, sample, end? ──► renew         (`again`, `point`: the phases a call may begin with)
    again  ── step pass; `term`? ──► renew.step
    renew  ── rules 4, 7, 8: derivatives anew where the pass has changed what they read ──► step
    step   ── the rule: stages, new states, t ──► attend where something is to be looked at, else again
    attend ── stop flag, inf and nan ──► point or again

Times are t_base + k·dt_base while DT does not change. A fixed step that ends at t ≥ t_start + point·COMINT -
1e-9·DT has reached the next point.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.loop.fixed_steps import TOLERANCE, FixedStep
from desire_tui.engine.codegen.loop.frame import LoopFrame
from desire_tui.engine.codegen.loop.switched_steps import NOTHING, SwitchedStep, Watched, write_departure
from desire_tui.engine.codegen.loop.variable_steps import VariableStep, write_renewal_in_interval
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.loop.storage import Storage
    from desire_tui.engine.integration.tableaus import Tableau


class Driver(LoopFrame):
    """Writes the function `i32 @run(ptr memory, ptr context)`; `tableau` None: rule 0, no steps.

    `watched`: what may switch inside a step (`loop.switched_steps`).
    """

    def __init__(
        self, text: IrText, storage: Storage, tableau: Tableau | None, *, watched: Watched = NOTHING
    ) -> None:
        super().__init__(text, storage)
        self.tableau = tableau
        self.watches = watched
        self.watched = any(watched)

    def write(self) -> None:
        """Write the whole body."""
        text = self.text
        self.enter()
        self.put("boxed", "0")
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
        self.put("known", "1")
        self.storage.recall_first_stage()
        text.jump("depart" if self.watched else "renew")
        self._point()
        if self.tableau is None:
            text.begin("again")
            text.jump("point")
            self._next_without_rule()
        else:
            self._again()
            self._step(self.tableau)
        self._attend()
        self.exit()

    # ------------------------------------------------------------------ small things

    def _next_point(self) -> None:
        """t_next ← t_start + point·COMINT."""
        index = self.text.op(f"sitofp i64 {self.memory.load('point')} to double")
        span = self.lanes.mul(index, self.memory.load("comint"))
        self.put("t_next", self.lanes.add(self.memory.load("t_start"), span))

    def _rows_full(self) -> str:
        return self.text.op(f"icmp sge i64 {self.memory.load('row')}, {self.memory.load('row_limit')}")

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
        self.put("known", "1")
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
        text.branch(self.get("last"), "finish", "onward")
        text.begin("finish")
        fired = self._fired()
        self.memory.store("which", self.context.load("term"))
        self.put("ended", text.op(f"select i1 {fired}, i32 {int(Ended.TERM)}, i32 {int(Ended.TMAX)}"))
        self.put("phase", str(int(Phase.ENDED)))
        text.jump("exit")
        text.begin("onward")
        if self.tableau is None:  # after the last sample t stays where it was taken
            self.storage.store(T, self.get("t_next"))
        text.branch(self._rows_full(), "point.full", "depart" if self.watched else "renew")
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
        """Write a row; inf or nan in what states depend on ends the run without it."""
        text = self.text
        text.begin("sample")
        row = self.memory.load("row")
        start = text.op(f"mul i64 {row}, {self.storage.width()}")
        at = text.op(f"getelementptr double, ptr {self.memory.load('rows')}, i64 {start}")
        bad = self.storage.row(at, self.storage.load(T))
        text.branch(bad, "sample.wild", "sample.kept")
        text.begin("sample.wild")
        text.branch(self.storage.vital_wild(), "wild", "sample.gap")
        text.begin("sample.gap")
        gap = self.memory.load("gap")
        first = text.op(f"icmp eq i64 {gap}, 0")
        self.memory.store("gap", text.op(f"select i1 {first}, i64 {text.op(f'add i64 {row}, 1')}, i64 {gap}"))
        text.jump("sample.kept")
        text.begin("sample.kept")
        self.memory.store("row", text.op(f"add i64 {row}, 1"))
        text.jump("sampled")

    def _next_without_rule(self) -> None:
        text = self.text
        self._renew("renew", "renewal")
        text.begin("step")
        self.put("reached", "1")
        stop = text.op(f"icmp ne i32 {self.memory.load('stop', volatile=True)}, 0")
        self.put("stop", stop)
        text.branch(text.op(f"or i1 {stop}, {self.hurried()}"), "attend", "point")

    # ------------------------------------------------------------------ steps

    def _again(self) -> None:
        text = self.text
        text.begin("again")
        self._clear_term()
        self.run_pass("step", 1)
        self.put("known", "0")
        text.branch(self._fired(), "tail", "renew.step")
        self._renew("renew", "renewal")
        text.begin("renew.step")
        self._renew_in_interval()
        text.jump("step")
        text.begin("tail")
        self.storage.run_pass("tail", 1)
        self.put("last", "1")
        text.jump("sample")

    def _renew_in_interval(self) -> None:
        if self.tableau is not None and self.tableau.variable:
            write_renewal_in_interval(self)

    def _renew(self, block: str, kind: str) -> None:
        """Write where a rule that tests its steps computes k1 anew (`passes.renewal`)."""
        self.text.begin(block)
        if self.tableau is not None and self.tableau.variable:
            self.storage.run_pass(kind, 1)
        self.text.jump("step")

    def _step(self, tableau: Tableau) -> None:
        if self.watched:
            write_departure(self)
        self.text.begin("step")
        if not self.watched and not tableau.variable:
            FixedStep(self, tableau).write()
            return
        self.storage.save()
        if self.watched:
            SwitchedStep(self, tableau, self.watches).write()
        else:
            VariableStep(self, tableau).write()

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
        text.branch(text.op(f"or i1 {stop}, {self.hurried()}"), "exit", "attend.on")
        text.begin("attend.on")
        self.storage.leave()  # others watch the values while the run goes on
        self.memory.store("steps", self.get("steps"))
        text.branch(reached, "point", "again")
