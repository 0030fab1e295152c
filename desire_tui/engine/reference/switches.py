"""Switches in the reference back end: `integration.switching` as Python, its passes as closures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.integration.memory_views import pointed_at
from desire_tui.engine.integration.switching import watch as watching
from desire_tui.engine.integration.switching.memory import Compute, Place
from desire_tui.engine.integration.switching.setup import Watcher
from desire_tui.engine.integration.taylor.roots import look_along
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.reference.statements import StatementClosures
from desire_tui.engine.runtime.moments.memory import Depart, Limit, Look, Moments, Settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.integration.taylor.memory import Taylor
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.runtime.moments.setup import Stepper
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values


class Switches:
    """What the run loops ask; `state_at` puts t and the states inside a step into the values."""

    def __init__(
        self,
        switching: Switching,
        segment: Segment,
        values: Values,
        state_at: Callable[[float], None] | None = None,
    ) -> None:
        self._closures = closures = StatementClosures(values, segment.order)
        modes, derivative = closures.compile(switching.live_pass), closures.compile(derivative_slice(segment))
        ranges = [(s.slot, s.first, s.count) for s in segment.states]
        self._watcher = watcher = Watcher(switching, values, ranges)
        self._watch = watcher.watch
        if state_at is not None:
            watcher.keep_box()
        self._order = segment.order
        self._failure: BaseException | None = None

        def place(t: float) -> None:
            if state_at is None:
                watching.place_on_step(self._watch, t)
            else:
                state_at(t)

        def slopes() -> None:
            derivative()
            self._numbers("f1")[:] = closures.derivatives

        watcher.connect(
            watching.begin,
            Compute(lambda *_: self._do(modes)),
            Compute(lambda *_: self._do(slopes)),
            Place(lambda _, t: self._do(lambda: place(t))),
            0,
        )

    def begin(self, memory: RunMemory) -> None:
        """Prepare a run."""
        self._closures.memory = memory
        with np.errstate(all="ignore"):
            self._watcher.begin(memory)
        self.check()

    def limit(self, t: float, wish: float) -> float:
        """See `watch.limit`."""
        return watching.limit(self._watch, t, wish)

    def look_back(self, t0: float, t1: float, series: Taylor | None = None) -> int:
        """See `watch.look_back`; `series`: of the step, in which the modes' arguments have some."""
        if series is not None:
            return self._checked(look_along(series, self._watch, t0, t1))
        return self._checked(watching.look_back(self._watch, t0, t1))

    def serve(self, stepper: Stepper) -> None:
        """Let the steps of models with events ask; what goes wrong meanwhile, `check` raises."""
        moments, watch = stepper.moments, self._watch
        self.remember(moments)
        self._watcher.take_step_from(*stepper.step_start)
        moments.limit = Limit(lambda _, t, wish: watching.limit(watch, t, wish))
        moments.look = Look(lambda _, t0, t1: watching.look_at_step(watch, t0, t1))
        moments.depart = Depart(lambda _: watching.depart(watch))

    def remember(self, moments: Moments) -> None:
        """Let what is computed here look up histories."""
        self._closures.histories.append(moments)
        watch = self._watch
        moments.watch = self._watcher.address
        moments.settle = Settle(lambda _, t: watching.settle(watch, t))

    def settle(self, t_next: float) -> int:
        """See `watch.settle`."""
        return self._checked(watching.settle(self._watch, t_next))

    def depart(self) -> int:
        """See `watch.depart`."""
        return self._checked(watching.depart(self._watch))

    def follow(self, t0: float, t1: float, t_next: float, x0: Any, f0: Any) -> int:
        """See `watch.follow`; `x0` and `f0` are states and derivatives at the step's start."""
        self._numbers("x0")[:] = x0
        self._numbers("f0")[:] = f0
        return self._checked(watching.follow(self._watch, t0, t1, t_next))

    def culprit(self) -> tuple[str, Where]:
        """Return the name and the place of what switched last."""
        return self._watcher.culprit()

    def _numbers(self, name: str) -> Any:
        return pointed_at(getattr(self._watch, name), self._order)

    def _do(self, action: Callable[[], object]) -> int:
        try:
            action()
        except BaseException as failure:  # noqa: BLE001 - ctypes would print it and go on
            self._failure = failure
        return 0

    def _checked(self, result: int) -> int:
        self.check()
        return result

    def check(self) -> None:
        """Raise what has gone wrong in a function that was called back."""
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise failure
