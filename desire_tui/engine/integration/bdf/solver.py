"""One solver's memory, as `sundials.solver.Solver` is of CVODE."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.integration.bdf import start, step
from desire_tui.engine.integration.bdf.memory import Arrays, Bdf
from desire_tui.engine.integration.memory_views import pointed_at
from desire_tui.engine.integration.sundials.solver import MATRIX_CONVERGENCE, Counts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.plain_types import Reals


class OwnSolver:
    """For `n` states at `states` (an address).

    Native code that is given `memory` makes the steps itself; `connect`, `restart` and `step` are for the
    reference back end, which runs the same text as Python.
    """

    vector = between = 0

    def __init__(self, n: int, states: int, problem: int, between: int = 0) -> None:
        self._between = ctypes.cast(between or states, ctypes.POINTER(ctypes.c_double))
        self._bdf = bdf = Bdf()
        self._arrays = Arrays(n)
        self._arrays.give(bdf, n)
        bdf.y = ctypes.cast(states, ctypes.POINTER(ctypes.c_double))
        bdf.problem = problem
        bdf.share = MATRIX_CONVERGENCE
        self.memory = ctypes.addressof(bdf)

    def limit(self, dt_max: float) -> None:
        """Set the largest step, 0 for none."""
        self._bdf.h_most = max(dt_max, 0.0)

    def connect(self, evaluate: Any, weigh: Any, fill: Any) -> None:
        """Set the callbacks (of the types in `memory`)."""
        self._bdf.evaluate, self._bdf.weigh, self._bdf.fill = self._kept = evaluate, weigh, fill

    def restart(self, t: float, first_step: float) -> None:
        """Begin anew from the states at `states`."""
        start.restart(self._bdf, t, first_step)

    def step(self, t_stop: float) -> tuple[int, float]:
        """Take one step, never beyond `t_stop`; return the flag (< 0: failed) and the time reached."""
        flag = step.advance(self._bdf, t_stop)
        return flag, self._bdf.t

    def interpolate(self, t: float) -> None:
        """Write the states at a time inside the last step to `between`."""
        step.put_inside(self._bdf, t, self._between)

    @property
    def last_step(self) -> float:
        """Size of the last step taken."""
        return float(self._bdf.h_last)

    def counts(self) -> Counts:
        """Return what was done since the last restart."""
        bdf = self._bdf
        return Counts(bdf.steps, bdf.failed_tests + bdf.failed_corrections, bdf.order_last)

    def worst_state(self) -> int:
        """Return the number of the state with the largest weighted correction in the last try."""
        bdf = self._bdf

        def numbers(place: Reals) -> NDArray[np.float64]:
            return pointed_at(place, bdf.n)

        sizes = np.abs(numbers(bdf.correction) * numbers(bdf.weights))
        return int(np.argmax(np.nan_to_num(sizes, nan=np.inf)))
