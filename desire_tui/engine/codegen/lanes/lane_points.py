"""Communication points of runs in lock step: samples, and the end of runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.loop.fixed_steps import TOLERANCE
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.lanes.lane_folds import LaneFolds
    from desire_tui.engine.codegen.lanes.lane_variables import LaneVariables


class LanePoints:
    """Writes the blocks `point` … `onward`, and samples elsewhere.

    `columns` are the slots sampled beside t, `vital` those that states depend on; `steps`: there is a rule.
    Where there are `folds`, they take the samples up, and none is stored.
    """

    def __init__(
        self,
        loop: LaneVariables,
        columns: Sequence[int],
        vital: Sequence[int],
        folds: LaneFolds | None,
        *,
        steps: bool,
    ) -> None:
        self.loop, self.text, self.runs = loop, loop.text, loop.runs
        self.one, self.cells, self.memory = loop.one, loop.cells, loop.memory
        self.columns, self.vital, self._folds, self._steps = columns, vital, folds, steps

    def write(self) -> None:
        """Write a point: the full pass, samples if they are due, and whether it was the last."""
        text, memory = self.text, self.memory
        text.begin("point")
        self.loop.clear_fired()
        self.loop.run_pass("full", 1)
        index = self.loop.get("i64", "point")
        self.loop.put("i64", "point", text.op(f"add i64 {index}, 1"))
        last = self._at_end(index)
        beyond = text.op(f"srem i64 {index}, {memory.load('every')}")
        take = text.op(f"or i1 {last}, {text.op(f'icmp eq i64 {beyond}, 0')}")
        if self.loop.may_end:
            fired = self.runs.both(self.loop.flags("fired"), self.loop.flags("alive"))
            wanted = self.runs.both(
                self.loop.flags("alive"), self.runs.either(fired, self.runs.splat_flag(take))
            )
            text.branch(self.runs.any(wanted), "sample", "sampled")
            text.begin("sample")
            self.sample(wanted)
            text.jump("sampled")
            text.begin("sampled")
            self.loop.freeze(fired)
        else:
            text.branch(take, "sample", "sampled")
            text.begin("sample")
            self.sample(self.loop.flags("alive"))
            text.jump("sampled")
            text.begin("sampled")
        grown = text.op(f"zext i1 {take} to i64")
        self.loop.put("i64", "row", text.op(f"add i64 {self.loop.get('i64', 'row')}, {grown}"))
        self.loop.next_point()
        text.branch(last, "exit", "onward")
        text.begin("onward")
        text.branch(self.runs.any(self.loop.flags("alive")), "step", "exit")

    def _at_end(self, index: str) -> str:
        """Whether communication point `index` is the last one of all runs."""
        if not self._steps:
            following = self.text.op(f"add i64 {index}, 1")
            return self.text.op(f"icmp sge i64 {following}, {self.memory.load('nn')}")
        slack = self.one.mul(self.one.const(TOLERANCE), self.cells.load(DT).name)
        end = self.one.add(self.memory.load("t_start"), self.memory.load("t_max"))
        return self.one.compare("oge", self.loop.t(), self.one.sub(end, slack))

    def sample(self, mask: str) -> None:
        """Write a row for the runs that have their flag set; inf or nan in vital columns is noted."""
        text, runs = self.text, self.runs
        row = self.loop.get("i64", "row")
        if self._folds is not None:
            self._folds.sample(mask)
        else:
            self._store(row, mask)
        count = text.op(f"add i64 {row}, 1")
        one = text.op(f"insertelement {runs.integers} poison, i64 {count}, i64 0")
        zeros = f"<{runs.width} x i32> zeroinitializer"
        counts = text.op(f"shufflevector {runs.integers} {one}, {runs.integers} poison, {zeros}")
        before = self.loop.get(runs.integers, "taken")
        taken = text.op(f"select {runs.flags} {mask}, {runs.integers} {counts}, {runs.integers} {before}")
        self.loop.put(runs.integers, "taken", taken)
        if self.vital:
            self.loop.flag(runs.both(mask, self.loop.wild(self.vital)))

    def _store(self, row: str, mask: str) -> None:
        """Write t and the columns to a row."""
        text, runs, width = self.text, self.runs, 1 + len(self.columns)
        first, count = text.op(f"mul i64 {row}, {width}"), self.memory.load("runs")
        for number, slot in enumerate((T, *self.columns)):
            line = text.op(f"mul i64 {text.op(f'add i64 {first}, {number}')}, {count}")
            place = text.op(f"getelementptr double, ptr %rows, i64 {line}")
            value = self.cells.wide(self.cells.load(slot))
            if self.loop.may_end:
                value = runs.choose(mask, value, text.op(f"load {runs.kind}, ptr {place}, align 8"))
            text.do(f"store {runs.kind} {value}, ptr {place}, align 8")
