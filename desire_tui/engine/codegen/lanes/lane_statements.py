"""Statements of a pass for runs in lock step: a condition that differs becomes a mask over what it guards."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    GetHistory,
    Guard,
    Set,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.lanes.lane_cells import LaneCells
    from desire_tui.engine.codegen.lanes.lane_expressions import LaneExpressions
    from desire_tui.engine.codegen.lanes.lane_histories import LaneHistories
    from desire_tui.engine.codegen.lanes.replicas import Replicas
    from desire_tui.engine.lowered.statements import Action


class LaneStatements:
    """Writes statements; `faults` are the numbers of those `term` that end a run with an error.

    Cells the text must provide: `%l.fired`, `%l.flagged` (flags), `%l.point`, `%l.random`.
    """

    def __init__(
        self,
        runs: Replicas,
        cells: LaneCells,
        faults: frozenset[int],
        histories: LaneHistories,
        values: LaneExpressions,
    ) -> None:
        self.text, self.runs, self.cells = runs.text, runs, cells
        self.values = values
        self._faults = faults
        self.histories = histories

    def write(self, actions: Iterable[Action], mask: str | None = None) -> None:
        """Write statements in order, for those runs that have their flag set."""
        for action in actions:
            self.values.forget()
            self.values.mask = mask
            self._statement(action, mask)

    def _statement(self, action: Action, mask: str | None) -> None:
        match action:
            case Set():
                self.cells.store(action.slot, self.values.value(action.value), mask)
            case Deriv():
                self.cells.keep(f"k{self.cells.stage}", action.state, self.values.value(action.value))
            case Guard():
                self._guard(action, mask)
            case Terminate():
                self._terminate(action, mask)
            case UpdateTrackHold():
                self._track(action, mask)
            case StoreHistory() | GetHistory() | DelayLine():
                self.histories.write(action, self.values, mask)
            case _:
                raise TypeError(f"{type(action).__name__} in runs in lock step")

    def _guard(self, guard: Guard, mask: str | None) -> None:
        if guard.kind == "sample":
            self._branch(self._sampled(guard.every), guard.body, (), mask)
        elif guard.kind in ("out", "step"):
            self.write(guard.body, mask)
        else:
            assert guard.condition is not None
            condition = self.values.value(guard.condition)
            if not condition.wide:
                zero = self.values.one.const(0.0)
                positive = self.values.one.compare("ogt", condition.name, zero)
                self._branch(positive, guard.body, guard.orelse, mask)
                return
            holds = self.runs.compare("ogt", condition.name, self.runs.const(0.0))
            yes = holds if mask is None else self.runs.both(mask, holds)
            no = self.runs.but(self._all() if mask is None else mask, holds)
            self._masked(guard.body, yes)
            self._masked(guard.orelse, no)

    def _all(self) -> str:
        return "splat (i1 true)"

    def _branch(
        self, condition: str, body: Iterable[Action], orelse: Iterable[Action], mask: str | None
    ) -> None:
        """Write statements that all runs carry out, or none."""
        yes, no, done = (f"{stem}{self.text.fresh()}" for stem in ("yes", "no", "done"))
        self.text.branch(condition, yes, no)
        for label, actions in ((yes, body), (no, orelse)):
            self.text.begin(label)
            self.write(actions, mask)
            self.text.jump(done)
        self.text.begin(done)

    def _masked(self, actions: tuple[Action, ...], mask: str) -> None:
        """Write statements for the runs that have their flag set; where none has, they are jumped over."""
        if not actions:
            return
        some, done = (f"{stem}{self.text.fresh()}" for stem in ("some", "done"))
        self.text.branch(self.runs.any(mask), some, done)
        self.text.begin(some)
        self.write(actions, mask)
        self.text.jump(done)
        self.text.begin(done)

    def _sampled(self, every: int) -> str:
        """Whether this communication point's number is a multiple."""
        number = self.text.op(f"add i64 {self.text.op('load i64, ptr %l.point')}, 1")
        return self.text.op(f"icmp eq i64 {self.text.op(f'srem i64 {number}, {every}')}, 0")

    def _terminate(self, action: Terminate, mask: str | None) -> None:
        runs, cells, zero = self.runs, self.cells, self.runs.const(0.0)
        value = self.values.value(action.value)
        wide, level = cells.wide(value), zero
        if action.level is not None:
            before = cells.load(action.level)
            level = cells.wide(before)
            lanes = runs if before.wide else self.values.one
            own, own_level, nothing = (
                (wide, level, zero) if before.wide else (value.name, before.name, lanes.const(0.0))
            )
            positive, set_before = (
                lanes.compare("ogt", own, nothing),
                lanes.compare("oge", own_level, nothing),
            )
            above = self.text.op(f"and {lanes.flags} {positive}, {set_before}")
            cells.store(action.level, Number(lanes.choose(above, own, nothing), before.wide), mask)
        fires = runs.compare("ogt", wide, level)
        if mask is not None:
            fires = runs.both(mask, fires)
        cell = "%l.flagged" if action.number in self._faults else "%l.fired"
        known = self.text.op(f"load {runs.flags}, ptr {cell}")
        self.text.do(f"store {runs.flags} {runs.either(known, fires)}, ptr {cell}")

    def _track(self, action: UpdateTrackHold, mask: str | None) -> None:
        control, value = self.values.value(action.control), self.values.value(action.value)
        held, tracked = self.cells.load(action.held_slot), self.cells.load(action.tracked_slot)
        if not held.wide and not tracked.wide:
            one = self.values.one
            holds = one.compare("ogt", control.name, one.const(0.0))
            moved = one.choose(holds, tracked.name, held.name), one.choose(holds, value.name, tracked.name)
            self.cells.store(action.held_slot, Number(moved[0], wide=False))
            self.cells.store(action.tracked_slot, Number(moved[1], wide=False))
            return
        wide = self.cells.wide(control)
        holds = self.runs.compare("ogt", wide, self.runs.const(0.0))
        if mask is not None:
            holds = self.runs.both(mask, holds)
        self.cells.store(action.held_slot, tracked, holds)
        self.cells.store(action.tracked_slot, value, holds)
