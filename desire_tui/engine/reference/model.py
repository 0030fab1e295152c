"""The run loop of language.md 8.2, written down plainly.

Each turn is at a communication point (`_point`) or at a step's start inside a communication interval
(`_inside`); both end with a step of the rule. `memory` says where to go on, so a run can be left and taken
up at any return.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.passes.final_sample import holds_term
from desire_tui.engine.passes.renewal import renewals
from desire_tui.engine.passes.slices import derivative_slice, final_sample_pass, full_pass, step_slice
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.reference.states import make_states
from desire_tui.engine.reference.steps import chattering, fixed_step, renew_in_interval, variable_step
from desire_tui.engine.runtime.run_memory import Ended, Phase
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.reference.statements import Run
    from desire_tui.engine.reference.switches import Switches
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

TOLERANCE = 1e-9
"""Relative to DT: a step that ends this little before a communication point has reached it."""
_CHECK_EVERY = 1024  # steps between two looks for inf and nan inside a communication interval


class ReferenceModel:
    """A segment under rule 0 (`tableau` None) or an explicit rule."""

    def __init__(
        self,
        segment: Segment,
        tableau: Tableau | None,
        values: Values,
        numbers: Sequence[int],
        vital: Iterable[int],
        switches: Switches | None = None,
    ) -> None:
        self.switches = switches
        self.cells = values.cells
        self.numbers = numbers
        """What the states' numbers were before those that the segment assigns were taken out."""
        self.tableau = tableau
        self.nodes = [] if tableau is None else [(i, float(c)) for i, c in enumerate(tableau.c) if i]
        """Stages behind the first, and where in the step they stand."""
        self.columns = [column.slot for column in segment.columns]
        self.vital = frozenset(vital)
        """Numbers of the columns that states depend on."""
        self.statements = StatementClosures(values, segment.order)
        self.states = make_states(segment, tableau, values, self.statements.derivatives)
        compile_ = self.statements.compile
        self.full = compile_(full_pass(segment))
        self.step = compile_(step_slice(segment))
        self.tail = compile_(final_sample_pass(segment) if holds_term(segment.body) else ())  # as native code
        variable = tableau is not None and tableau.variable
        anew = renewals(segment) if variable else ((), ())
        self.renewal, self.step_renewal = map(compile_, anew)
        self.renews = bool(anew[1])
        # each stage's pass writes its own k; k1 is written by the full and the step pass
        stage = derivative_slice(segment)
        self.restage: Run | None = None if switches is None else compile_(stage)
        self.stages: list[Run] = []
        for k in self.states.k[1:]:
            self.statements.derivatives = k
            self.stages.append(compile_(stage))

    def advance(self, memory: RunMemory) -> Ended:
        """Run on until the rows are full, `stop` is set, the run ends or a fault shows."""
        self.statements.memory = memory
        if self.switches is not None and memory.phase == Phase.AT_POINT and memory.point == 0:
            self.switches.begin(memory)
        with np.errstate(all="ignore"):
            if memory.row >= memory.row_limit:
                return Ended.RUNNING
            if memory.phase == Phase.ENDED:
                return Ended.TMAX
            ended = self._depart(memory) if memory.phase == Phase.AFTER_POINT else None
            while ended is None:
                at_point = memory.phase == Phase.AT_POINT
                ended = self._point(memory) if at_point else self._inside(memory)
                if ended is None and self.tableau is not None:
                    ended = self._depart(memory) if at_point else self._step(memory)
            return ended

    def _depart(self, memory: RunMemory) -> Ended | None:
        """Make the first step behind a communication point, where something may switch."""
        if self.switches is not None:
            bits = self.switches.depart()
            if bits >= CHATTERS:
                return chattering(self.switches, memory)
            if bits and self.restage is not None:
                self._pass(self.restage, memory)
        return self._step(memory)

    def _point(self, memory: RunMemory) -> Ended | None:
        """Make `pass(COMM, STEP)`, sample, and see whether the run is over."""
        if memory.stop:
            return Ended.STOPPED
        cells = self.cells
        if memory.point and self._not_finite(memory):
            return Ended.NOT_FINITE  # before the pass: defined variables keep their last finite values
        self._pass(self.full, memory)
        fired = self.statements.fired
        if self.tableau is None:
            over = memory.point >= memory.nn - 1
        else:
            over = cells[T] >= memory.t_start + memory.t_max - TOLERANCE * cells[DT]
        last = over or fired is not None
        if (last or memory.point % memory.every == 0) and not self._sample(memory):
            return Ended.NOT_FINITE
        memory.point += 1
        if last:
            memory.phase = Phase.ENDED
            memory.which = fired or 0
            return Ended.TMAX if fired is None else Ended.TERM
        if self.tableau is None:
            cells[T] = memory.t_start + memory.point * memory.comint
        if memory.row >= memory.row_limit:
            if self.tableau is not None:
                memory.phase = Phase.AFTER_POINT
            return Ended.RUNNING
        return None

    def _inside(self, memory: RunMemory) -> Ended | None:
        """Make `pass(-, STEP)` at a step's start inside a communication interval."""
        if memory.stop:
            return Ended.STOPPED
        assert self.tableau is not None
        if (self.tableau.variable or memory.steps % _CHECK_EVERY == 0) and self._not_finite(memory):
            return Ended.NOT_FINITE
        self._pass(self.step, memory)
        fired = self.statements.fired
        if fired is None:
            return None
        self.tail()
        memory.phase = Phase.ENDED
        if self._not_finite(memory) or not self._sample(memory):
            return Ended.NOT_FINITE
        memory.which = fired
        return Ended.TERM

    def _step(self, memory: RunMemory) -> Ended | None:
        assert self.tableau is not None
        self.renew(memory)
        memory.phase = Phase.IN_STEP
        step = variable_step if self.tableau.variable else fixed_step
        return step(self, self.tableau, memory)

    def renew(self, memory: RunMemory) -> None:
        """Make k1 anew behind a point or a step's start where the pass has changed what it depends on."""
        if memory.phase != Phase.IN_STEP:
            self.renewal()
        elif self.renews:
            renew_in_interval(self, memory)

    def _pass(self, statements: Run, memory: RunMemory) -> None:
        self.statements.fired = None
        statements()
        memory.derivative_calls += 1

    def run_stage(self, stage: int, memory: RunMemory) -> None:
        """Make a pass with both flags off; its derivatives are k[stage]."""
        self._pass(self.stages[stage - 1], memory)

    def _sample(self, memory: RunMemory) -> bool:
        """Write a row; False if a requested variable that states depend on is inf or nan."""
        cells = self.cells
        width = 1 + len(self.columns)
        row = (ctypes.c_double * width).from_address(memory.rows + memory.row * width * 8)
        row[0] = cells[T]
        for number, slot in enumerate(self.columns):
            value = cells[slot]
            if value - value != 0.0:
                if number in self.vital:
                    memory.which = -1 - number
                    memory.phase = Phase.ENDED
                    return False
                memory.gap = memory.gap or memory.row + 1
            row[1 + number] = value
        memory.row += 1
        return True

    def _not_finite(self, memory: RunMemory) -> bool:
        """Whether a state is inf or nan; `which` is the first."""
        finite = np.isfinite(self.states.fetch())
        if finite.all():
            return False
        memory.which = self.numbers[int(np.argmin(finite))]
        memory.phase = Phase.ENDED
        return True
