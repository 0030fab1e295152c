"""The run loop of `loop.run_loop` for runs in lock step under a rule with fixed steps.

All runs have the same times, so there is one t, one count of steps, one way through the loop. A run that has
ended is frozen: its samples are no longer written. One in which something irregular shows (an inf or nan in a
state, a fault) is flagged: whoever called makes that run again alone, for its message.

    point  ── full pass, sample ──► step                   (a communication point)
    again  ── step pass; `term`? tail pass, sample ──► step
    step   ── the rule: stages, new states, t ──► attend where something is to be looked at, else again
    attend ── stop flag, inf and nan ──► point or again
"""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.symbols import sine_and_cosine
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.ir.work_memory import Fields
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.lanes.lane_cells import LaneCells, Number
from desire_tui.engine.codegen.lanes.lane_frame import LaneMemory, lane_frame
from desire_tui.engine.codegen.lanes.lane_histories import LaneHistories
from desire_tui.engine.codegen.lanes.lane_statements import LaneStatements
from desire_tui.engine.codegen.lanes.replicas import Replicas
from desire_tui.engine.codegen.loop.fixed_steps import TOLERANCE
from desire_tui.engine.codegen.loop.stage_sums import scaled, weighted
from desire_tui.engine.codegen.scalar.slot_usage import survey
from desire_tui.engine.lowered.effects import expressions
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.passes.final_sample import holds_term
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from desire_tui.engine.integration.tableaus import Row, Tableau
    from desire_tui.engine.lowered.statements import Action

_CHECK_EVERY = 1024
"""Steps between two looks for inf and nan inside a communication interval, as in `loop.fixed_steps`."""


class LaneLoop:
    """Writes the function `i32 NAME(ptr LaneMemory)`; `tableau` None: rule 0, no steps.

    `given` are the slots with a start for each run.
    """

    def __init__(
        self,
        passes: Mapping[str, tuple[Action, ...]],
        tableau: Tableau | None,
        states: Sequence[int],
        columns: Sequence[int],
        vital: Sequence[int],
        given: Sequence[int],
        differing: frozenset[int],
        faults: frozenset[int],
        arrays: Mapping[int, int],
        counters: int,
        width: int,
        piece: int,
    ) -> None:
        self.text = IrText()
        together = sine_and_cosine() is not None and _takes_both(passes["derivative"])
        self.one, self.runs = Lanes(self.text), Replicas(self.text, width, piece, together=together)
        usage = survey(passes.values())
        stages = tableau.stages if tableau is not None else 0
        slots = usage.read | usage.written | {T, DT, *states, *columns, *vital}
        self.cells = LaneCells(self.text, self.runs, slots, differing, states, stages)
        self.memory = Fields(self.text, LaneMemory, "%a")
        self.histories = LaneHistories(self.runs, self.cells, self.memory, arrays, counters)
        self.statements = LaneStatements(self.runs, self.cells, faults, self.histories)
        self.passes, self.tableau = passes, tableau
        self.states, self.columns, self.vital, self.given = states, columns, vital, given
        self.may_end = holds_term(passes["step"]) or holds_term(passes["full"])

    def piece(self) -> Piece:
        """Return the code, named by its content."""
        self._write()
        width = self.runs.width
        body = self.text.body()
        whole = "\n".join((body, *sorted(self.text.declarations)))  # what it calls depends on `piece`
        name = "l" + blake2b(whole.encode(), digest_size=10).hexdigest()
        frame = lane_frame(
            name,
            width=width,
            given=len(self.given),
            columns=len(self.columns),
            elements=self.histories.elements,
        )
        group = (
            f"define internal i32 @{name}.group(ptr %a, ptr noalias %v, ptr noalias %in, ptr noalias %seeds,"
            f" ptr noalias %rows, ptr noalias %arrays, ptr noalias %counts, ptr noalias %flags) #0"
            f" {{\n{body}\n}}"
        )
        return Piece(name, f"{group}\n{frame}", frozenset(self.text.declarations))

    # ------------------------------------------------------------------ small things

    def _get(self, kind: str, name: str) -> str:
        return self.text.op(f"load {kind}, ptr %l.{name}")

    def _put(self, kind: str, name: str, value: str) -> None:
        self.text.do(f"store {kind} {value}, ptr %l.{name}")

    def _flags(self, name: str) -> str:
        return self._get(self.runs.flags, name)

    def _put_flags(self, name: str, value: str) -> None:
        self._put(self.runs.flags, name, value)

    def _run_pass(self, kind: str, stage: int, mask: str | None = None) -> None:
        self.cells.stage = stage
        self.statements.write(self.passes[kind], mask)

    def _t(self) -> str:
        return self.cells.load(T).name

    def _clear_fired(self) -> None:
        if self.may_end:
            self._put_flags("fired", "zeroinitializer")

    def _next_point(self) -> None:
        index = self.text.op(f"sitofp i64 {self._get('i64', 'point')} to double")
        span = self.one.mul(index, self.memory.load("comint"))
        self._put("double", "t_next", self.one.add(self.memory.load("t_start"), span))

    def _freeze(self, which: str) -> None:
        self._put_flags("alive", self.runs.but(self._flags("alive"), which))

    def _flag(self, bad: str) -> None:
        bad = self.runs.both(bad, self._flags("alive"))
        self._put_flags("flagged", self.runs.either(self._flags("flagged"), bad))
        self._freeze(bad)

    def _wild(self, slots: Sequence[int]) -> str:
        """X - x is 0 for every finite x, and not a number else; so is the sum."""
        total = self.runs.const(0.0)
        for slot in slots:
            value = self.cells.wide(self.cells.load(slot))
            total = self.runs.add(total, self.runs.sub(value, value))
        return self.runs.compare("uno", total, total)

    # ------------------------------------------------------------------ the loop

    def _write(self) -> None:
        text, runs = self.text, self.runs
        for name, kind in (
            ("k", "i64"),
            ("steps", "i64"),
            ("point", "i64"),
            ("row", "i64"),
            ("t_next", "double"),
        ):
            text.alloca(kind, f"%l.{name}")
        for name in ("alive", "fired", "flagged"):
            text.alloca(runs.flags, f"%l.{name}")
        for name in ("random", "taken"):
            text.alloca(runs.integers, f"%l.{name}")
        for name in ("k", "steps", "point", "row"):
            self._put("i64", name, "0")
        self._put_flags("alive", "splat (i1 true)")
        self._put_flags("fired", "zeroinitializer")
        self._put_flags("flagged", "zeroinitializer")
        self._put(runs.integers, "taken", "zeroinitializer")
        self._put(runs.integers, "random", text.op(f"load {runs.integers}, ptr %seeds, align 8"))
        self.cells.fetch(self.given)
        self.histories.begin()
        self._next_point()
        text.jump("point")
        self._point()
        if self.tableau is None:
            self._next_without_rule()
        else:
            self._again()
            self._step(self.tableau)
            self._attend()
        self._exit()

    def _point(self) -> None:
        text, memory = self.text, self.memory
        text.begin("point")
        self._clear_fired()
        self._run_pass("full", 1)
        index = self._get("i64", "point")
        self._put("i64", "point", text.op(f"add i64 {index}, 1"))
        last = self._at_end(index)
        beyond = text.op(f"srem i64 {index}, {memory.load('every')}")
        take = text.op(f"or i1 {last}, {text.op(f'icmp eq i64 {beyond}, 0')}")
        if self.may_end:
            fired = self.runs.both(self._flags("fired"), self._flags("alive"))
            wanted = self.runs.both(self._flags("alive"), self.runs.either(fired, self.runs.splat_flag(take)))
            text.branch(self.runs.any(wanted), "sample", "sampled")
            text.begin("sample")
            self._sample(wanted)
            text.jump("sampled")
            text.begin("sampled")
            self._freeze(fired)
        else:
            text.branch(take, "sample", "sampled")
            text.begin("sample")
            self._sample(self._flags("alive"))
            text.jump("sampled")
            text.begin("sampled")
        grown = text.op(f"zext i1 {take} to i64")
        self._put("i64", "row", text.op(f"add i64 {self._get('i64', 'row')}, {grown}"))
        self._next_point()
        text.branch(last, "exit", "onward")
        text.begin("onward")
        text.branch(self.runs.any(self._flags("alive")), "step", "exit")

    def _at_end(self, index: str) -> str:
        """Whether communication point `index` is the last one of all runs."""
        if self.tableau is None:
            following = self.text.op(f"add i64 {index}, 1")
            return self.text.op(f"icmp sge i64 {following}, {self.memory.load('nn')}")
        slack = self.one.mul(self.one.const(TOLERANCE), self.cells.load(DT).name)
        end = self.one.add(self.memory.load("t_start"), self.memory.load("t_max"))
        return self.one.compare("oge", self._t(), self.one.sub(end, slack))

    def _next_without_rule(self) -> None:
        self.text.begin("step")
        self.cells.store(T, Number(self._get("double", "t_next"), wide=False))
        stop = self.text.op(f"icmp ne i64 {self.memory.load('stop', volatile=True)}, 0")
        self.text.branch(stop, "exit", "point")

    def _sample(self, mask: str) -> None:
        """Write a row for the runs that have their flag set; inf or nan in vital columns is noted."""
        text, runs = self.text, self.runs
        row, width = self._get("i64", "row"), 1 + len(self.columns)
        at = text.op(
            f"getelementptr double, ptr %rows, i64 {text.op(f'mul i64 {row}, {width * runs.width}')}"
        )
        for number, slot in enumerate((T, *self.columns)):
            place = text.op(f"getelementptr double, ptr {at}, i64 {number * runs.width}")
            value = self.cells.wide(self.cells.load(slot))
            if self.may_end:
                value = runs.choose(mask, value, text.op(f"load {runs.kind}, ptr {place}, align 8"))
            text.do(f"store {runs.kind} {value}, ptr {place}, align 8")
        count = text.op(f"add i64 {row}, 1")
        one = text.op(f"insertelement {runs.integers} poison, i64 {count}, i64 0")
        zeros = f"<{runs.width} x i32> zeroinitializer"
        counts = text.op(f"shufflevector {runs.integers} {one}, {runs.integers} poison, {zeros}")
        before = self._get(runs.integers, "taken")
        taken = text.op(f"select {runs.flags} {mask}, {runs.integers} {counts}, {runs.integers} {before}")
        self._put(runs.integers, "taken", taken)
        if self.vital:
            self._flag(runs.both(mask, self._wild(self.vital)))

    def _again(self) -> None:
        text = self.text
        text.begin("again")
        self._clear_fired()
        self._run_pass("step", 1)
        if not self.may_end:
            text.jump("step")
            return
        fired = self.runs.both(self._flags("fired"), self._flags("alive"))
        text.branch(self.runs.any(fired), "tail", "step")
        text.begin("tail")
        self._run_pass("tail", 1, fired)
        self._sample(fired)
        self._freeze(fired)
        text.branch(self.runs.any(self._flags("alive")), "step", "exit")

    def _step(self, tableau: Tableau) -> None:
        text, cells = self.text, self.cells
        text.begin("step")
        for number, slot in enumerate(self.states):
            cells.keep("x0", number, cells.load(slot))
        dt = self.memory.load("dt")
        for stage in range(1, tableau.stages):
            self._advance(tableau.a[stage], dt)
            cells.store(T, Number(self._counted_time(float(tableau.c[stage]), dt), wide=False))
            self._run_pass("derivative", stage + 1)
        self._advance(tableau.b, dt)
        cells.store(T, Number(self._counted_time(1.0, dt), wide=False))
        for name in ("k", "steps"):
            self._put("i64", name, text.op(f"add i64 {self._get('i64', name)}, 1"))
        slack = self.one.mul(self.one.const(TOLERANCE), dt)
        reached = self.one.compare("oge", self._t(), self.one.sub(self._get("double", "t_next"), slack))
        since = text.op(f"and i64 {self._get('i64', 'steps')}, {_CHECK_EVERY - 1}")
        due = text.op(f"icmp eq i64 {since}, 0")
        text.alloca("i1", "%l.reached")
        self._put("i1", "reached", reached)
        text.branch(text.op(f"or i1 {due}, {reached}"), "attend", "again")

    def _counted_time(self, c: float, dt: str) -> str:
        k = self.text.op(f"sitofp i64 {self._get('i64', 'k')} to double")
        return self.one.add(self.memory.load("t_start"), self.one.mul(self.one.add(k, self.one.const(c)), dt))

    def _advance(self, row: Row, dt: str) -> None:
        """States ← saved states + dt·Σ row·k."""
        factor = scaled(self.one, row, dt)
        for number, slot in enumerate(self.states):
            wide = slot in self.cells.differing
            lanes = self.runs if wide else self.one
            total = weighted(lanes, row, lambda stage, n=number: self.cells.kept(f"k{stage}", n).name)  # type: ignore[misc]  # n=: bound now
            by = self.runs.splat(factor) if wide else factor
            moved = lanes.add(self.cells.kept("x0", number).name, lanes.mul(by, total))
            self.cells.store(slot, Number(moved, wide))

    def _attend(self) -> None:
        text = self.text
        text.begin("attend")
        self._flag(self._wild(self.states))
        stop = text.op(f"icmp ne i64 {self.memory.load('stop', volatile=True)}, 0")
        none = text.op(f"xor i1 {self.runs.any(self._flags('alive'))}, true")
        text.branch(text.op(f"or i1 {stop}, {none}"), "exit", "attend.on")
        text.begin("attend.on")
        text.branch(self._get("i1", "reached"), "point", "again")

    def _exit(self) -> None:
        text, runs = self.text, self.runs
        text.begin("exit")
        text.do(f"store {runs.integers} {self._get(runs.integers, 'taken')}, ptr %counts, align 8")
        flags = text.op(f"zext {runs.flags} {self._flags('flagged')} to {runs.integers}")
        text.do(f"store {runs.integers} {flags}, ptr %flags, align 8")
        text.do("ret i32 0")


def _takes_both(actions: Iterable[Action]) -> bool:
    """Whether statements take sine and cosine of the same expression."""
    taken: dict[str, set[str]] = {"sin": set(), "cos": set()}
    for action in walk_actions(actions):
        for node in walk_values(*expressions(action)):
            if isinstance(node, Op) and node.name in taken:
                taken[node.name].add(repr(node.args))
    return not taken["sin"].isdisjoint(taken["cos"])
