"""`store`, `get`, `delay` and `tdelay` for runs in lock step: all stand at the same place of their histories.

A history is rows at `%arrays`, a number for each run. A run that ends between communication points takes its
last record alone (`mask`): then the place does not move, the others have not come there yet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.lowered.statements import DelayLine, GetHistory, StoreHistory

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.codegen.ir.work_memory import Fields
    from desire_tui.engine.codegen.lanes.lane_cells import LaneCells
    from desire_tui.engine.codegen.lanes.lane_expressions import LaneExpressions
    from desire_tui.engine.codegen.lanes.replicas import Replicas


class LaneHistories:
    """Writes the statements; `arrays` are the histories' lengths by first slots, `counters` their places."""

    def __init__(
        self, runs: Replicas, cells: LaneCells, memory: Fields, arrays: Mapping[int, int], counters: int
    ) -> None:
        self.text, self.runs, self.cells, self._memory = runs.text, runs, cells, memory
        self._counters = counters
        self._first: dict[int, int] = {}
        self.elements = 0
        """Numbers of a run in all histories."""
        for slot, count in arrays.items():
            self._first[slot] = self.elements
            self.elements += count

    def begin(self) -> None:
        """Write what comes before the first pass."""
        for counter in range(self._counters):
            self.text.alloca("i64", f"%l.place{counter}")
            self.text.do(f"store i64 0, ptr %l.place{counter}")

    def write(
        self, action: StoreHistory | GetHistory | DelayLine, values: LaneExpressions, mask: str | None
    ) -> None:
        """Write a statement."""
        place = self.text.op(f"load i64, ptr %l.place{action.counter}")
        if isinstance(action, DelayLine):
            self._delay(action, self.cells.wide(values.value(action.source)), place, mask)
        else:
            inside = self.text.op(f"icmp slt i64 {place}, {action.count}")
            kept, done = (f"{stem}{self.text.fresh()}" for stem in ("kept", "done"))
            self.text.branch(inside, kept, done)
            self.text.begin(kept)
            at = self._at(action.array_slot, place)
            if isinstance(action, StoreHistory):
                self._put(at, self.cells.wide(self.cells.load(action.slot)), mask)
            else:
                self._set(action.slot, self._get(at), mask)
            self._move(action.counter, place, mask)
            self.text.jump(done)
            self.text.begin(done)

    def _delay(self, action: DelayLine, source: str, place: str, mask: str | None) -> None:
        op, count = self.text.op, action.count
        lags = self._memory.load("lags")
        lag = op(f"load i64, ptr {op(f'getelementptr i64, ptr {lags}, i64 {action.counter}')}")
        behind = op(f"add i64 {op(f'sub i64 {place}, {lag}')}, {count}")
        old = self._get(self._at(action.buffer_slot, op(f"urem i64 {behind}, {count}")))
        now = op(f"icmp eq i64 {lag}, 0")
        kind = self.runs.kind
        self._set(action.slot, op(f"select i1 {now}, {kind} {source}, {kind} {old}"), mask)
        self._put(self._at(action.buffer_slot, op(f"urem i64 {place}, {count}")), source, mask)
        self._move(action.counter, place, mask)

    def _at(self, slot: int, place: str) -> str:
        element = self.text.op(f"add i64 {place}, {self._first[slot]}")
        return self.text.op(f"getelementptr {self.runs.kind}, ptr %arrays, i64 {element}")

    def _get(self, at: str) -> str:
        return self.text.op(f"load {self.runs.kind}, ptr {at}, align 8")

    def _put(self, at: str, value: str, mask: str | None) -> None:
        if mask is not None:
            value = self.runs.choose(mask, value, self._get(at))
        self.text.do(f"store {self.runs.kind} {value}, ptr {at}, align 8")

    def _set(self, slot: int, value: str, mask: str | None) -> None:
        """Give a scalar a value; one that all runs share gets the first one's."""
        if slot in self.cells.differing:
            self.cells.store(slot, Number(value, wide=True), mask)
        else:
            one = self.text.op(f"extractelement {self.runs.kind} {value}, i64 0")
            self.cells.store(slot, Number(one, wide=False))

    def _move(self, counter: int, place: str, mask: str | None) -> None:
        if mask is None:
            self.text.do(f"store i64 {self.text.op(f'add i64 {place}, 1')}, ptr %l.place{counter}")
