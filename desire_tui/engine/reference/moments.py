"""Segments with events in the reference back end: `runtime.moments` as it is."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.passes.assigned_states import checked_state
from desire_tui.engine.passes.moments import blocks_pass, conditions_pass, sources_pass
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.reference.model import TOLERANCE, ReferenceModel
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.reference.steps import chattering
from desire_tui.engine.runtime.moments import blocks, steps
from desire_tui.engine.runtime.moments.memory import Compute
from desire_tui.engine.runtime.moments.setup import Stepper
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Any

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.reference.statements import Run
    from desire_tui.engine.reference.switches import Switches
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values


def connect(stepper: Stepper, segment: Segment, closures: StatementClosures, derivative: Run) -> None:
    """Give a model's `Moments` its functions; `derivative` is the pass, as `closures` has compiled it."""
    found, moments = closures.derivatives, stepper.moments
    closures.histories.append(moments)
    size = 8 * len(found)

    def function(run: Run, *, writes: bool = False) -> Any:
        def compute(_memory: int, k: int) -> int:
            run()
            if writes:
                ctypes.memmove(k, found.ctypes.data, size)
            return 0

        return Compute(compute)

    compile_ = closures.compile
    moments.derivative = function(derivative, writes=True)
    moments.conditions = function(compile_(conditions_pass(segment, moments.now)))
    moments.blocks = function(compile_(blocks_pass(segment, moments.due)))
    moments.sources = function(compile_(sources_pass(segment, moments.source)))


class MomentReferenceModel(ReferenceModel):
    """A segment with events under a rule 0 … 8."""

    def __init__(
        self,
        segment: Segment,
        tableau: Tableau | None,
        values: Values,
        numbers: Sequence[int],
        vital: Iterable[int],
        switches: Switches | None = None,
    ) -> None:
        super().__init__(segment, tableau, values, numbers, vital)
        self._watching = switches
        self._stepper = stepper = Stepper(segment, tableau, values)
        self.statements.histories.append(stepper.moments)
        self._others = others = StatementClosures(values, segment.order)
        connect(stepper, segment, others, others.compile(derivative_slice(segment)))
        if switches is not None:
            switches.serve(stepper)

    def advance(self, memory: RunMemory) -> Ended:
        """Run on; see `ReferenceModel`."""
        self._others.memory = memory
        if not memory.begun:
            memory.begun = 1
            self._stepper.prepare(memory, memory.times, memory.taus)
            if self._watching is not None:
                self._watching.begin(memory)
            if blocks.begin(self._stepper.moments) > 1:
                return self._too_fast(memory)
            if self._watching is not None:
                self._watching.begin(memory)  # behind the blocks at the run's start
        return super().advance(memory)

    def _point(self, memory: RunMemory) -> Ended | None:
        if self.tableau is None and memory.point:
            ended = steps.wait(self._stepper.moments, memory, self.cells[T])
            if ended == Ended.ZENO:
                return self._too_fast(memory)
        return super()._point(memory)

    def _step(self, memory: RunMemory) -> Ended | None:
        renewal = self.step_renewal if memory.phase == Phase.IN_STEP else self.renewal
        renewal()
        memory.phase = Phase.IN_STEP
        stepper, cells = self._stepper, self.cells
        first = self.states.k[0]
        stepper.k[: len(first)] = first
        t_next = memory.t_start + memory.point * memory.comint
        checked = memory.checked
        memory.checked = checked_state(checked, self.numbers)
        while (ended := Ended(steps.step(stepper.moments, memory, t_next))) is Ended.FULL:
            stepper.grow()
        memory.checked = checked
        if self._watching is not None:
            self._watching.check()
        if ended is Ended.ZENO:
            return self._too_fast(memory)
        if ended is Ended.CHATTERS and self._watching is not None:
            return chattering(self._watching, memory)
        if ended is not Ended.RUNNING:
            memory.phase = Phase.ENDED
            if ended in {Ended.DEADLOCK, Ended.STALLED} and self.tableau is not None:
                memory.which = self.numbers[memory.which]
            return ended
        assert self.tableau is not None
        slack = 0.0 if self.tableau.variable else TOLERANCE * memory.dt_base
        if cells[T] >= t_next - slack:
            memory.phase = Phase.AT_POINT
        return None

    def _too_fast(self, memory: RunMemory) -> Ended:
        memory.which, memory.phase = self._stepper.moments.last_fired, Phase.ENDED
        return Ended.ZENO
