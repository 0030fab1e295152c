"""The events and delays of a segment under a rule 9 … 17: memory and native functions for `interval`."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.moments.moment_routines import moment_functions
from desire_tui.engine.integration.tableaus import EULER
from desire_tui.engine.passes.moments import blocks_pass, conditions_pass, sources_pass
from desire_tui.engine.runtime.moments.inside import PLACES
from desire_tui.engine.runtime.moments.memory import Compute, Place, Settle
from desire_tui.engine.runtime.moments.setup import Stepper
from desire_tui.engine.runtime.run_memory import Ended, Phase

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.integration.switching.setup import Watcher
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

_BEGIN = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)


class StiffMoments:
    """`passes` are to be compiled among the segment's own, then `take` gets their functions."""

    def __init__(self, segment: Segment, values: Values) -> None:
        self._stepper = stepper = Stepper(segment, EULER, values)  # one stage: derivatives at a place
        self._natives = moment_functions()
        self._begin = _BEGIN(self._natives.begin)
        self.passes: dict[str, tuple[Action, ...]] = {
            "conditions": conditions_pass(segment, stepper.moments.now),
            "blocks": blocks_pass(segment, stepper.moments.due),
            "sources": sources_pass(segment, stepper.moments.source),
        }

    def take(self, functions: PassFunctions) -> None:
        """Connect the model's functions: those of `passes`, and its derivatives."""
        for name in ("derivative", *self.passes):
            setattr(self._stepper.moments, name, ctypes.cast(functions.address(name), Compute))

    def connect(self, problem: SolverProblem, state_at: int) -> None:
        """Let a solver's steps ask; `state_at` puts t and the states inside a step into the values."""
        moments, natives = self._stepper.moments, self._natives
        moments.places, moments.place = PLACES, ctypes.cast(state_at, Place)
        moments.owner = ctypes.addressof(problem)
        problem.moments = self._stepper.address
        problem.limit_step, problem.look_inside = natives.limit_step, natives.look_inside
        problem.look_along_series = natives.look_along_series
        problem.cut_short = natives.cut_short
        problem.remember_step, problem.happen = natives.remember_step, natives.happen

    def follow_series(self, conditions: Sequence[int]) -> None:
        """Rule 17: which of the solver's series are those of the events' conditions."""
        self._stepper.follow_series(conditions)

    def watch(self, watcher: Watcher, settle: int) -> None:
        """Let blocks take up what they make switch."""
        self._stepper.moments.watch = watcher.address
        self._stepper.moments.settle = ctypes.cast(settle, Settle)

    def remember(self, memory: RunMemory) -> None:
        """Let what a run computes look up histories."""
        memory.histories, memory.look_up = self._stepper.address, self._natives.look_up

    def begin(self, memory: RunMemory, watcher: Watcher | None) -> Ended | None:
        """Prepare a run, and carry out what is due at its start; ZENO: far too much is.

        Conditions may read what switches: `watcher` begins before, and again behind the blocks.
        """
        memory.begun = 1
        self._stepper.prepare(memory, memory.times, memory.taus)
        if watcher is not None:
            watcher.begin(memory)
        if self._begin(self._stepper.address) > 1:
            memory.phase = Phase.ENDED
            return self.too_fast(memory)
        return None

    def too_fast(self, memory: RunMemory) -> Ended:
        """Name the event that comes too fast."""
        memory.which = self._stepper.moments.last_fired
        return Ended.ZENO

    def grow(self) -> None:
        """Make the room for histories twice as large."""
        self._stepper.grow()
