"""The solver's memory as an object, as `bdf.solver` is of that solver's."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Protocol

from desire_tui.engine.integration.explicit import step
from desire_tui.engine.integration.explicit.memory import Arrays, Explicit
from desire_tui.engine.integration.sundials.solver import Counts

if TYPE_CHECKING:
    from desire_tui.engine.integration.tableaus import Tableau

_REALS = ctypes.POINTER(ctypes.c_double)


class StepBounds(Protocol):
    """What is wanted of `runtime.run_memory.RunMemory`."""

    dt_min: float
    dt_max: float
    comint: float
    error_min: float
    error_max: float
    error_one: float


class ExplicitSolver:
    """For `n` states at `states` (an address), by a rule that tests its steps.

    Native code that is given `memory` makes the steps itself; `connect`, `restart` and `step` are for the
    reference back end, which runs the same text as Python.
    """

    vector = between = 0

    def __init__(self, tableau: Tableau, n: int, states: int, problem: int, between: int) -> None:
        self._between = ctypes.cast(between, _REALS)
        self.explicit = explicit = Explicit(problem=problem, n=n, stages=tableau.stages)
        self._arrays = Arrays(tableau, n)
        self._arrays.give(explicit)
        explicit.y = ctypes.cast(states, _REALS)
        self.memory = ctypes.addressof(explicit)

    def begin(self, bounds: StepBounds, checked: int) -> None:
        """Prepare a run; `checked`: the only state whose error counts, from 1 (0: all do)."""
        explicit = self.explicit
        explicit.dt_least, explicit.dt_most = bounds.dt_min, bounds.dt_max
        explicit.dt_anew = bounds.comint
        explicit.error_least, explicit.error_most = bounds.error_min, bounds.error_max
        explicit.error_one, explicit.checked = bounds.error_one, checked
        explicit.dt = 0.0
        explicit.is_known = explicit.rejected = 0

    def connect(self, evaluate: Any) -> None:
        """Set the callback (of the type in `bdf.memory`)."""
        self.explicit.evaluate = self._kept = evaluate

    def restart(self, t: float, first_step: float) -> None:
        """Begin anew from the states at `states`."""
        step.restart(self.explicit, t, first_step)

    def step(self, t_stop: float) -> tuple[int, float]:
        """Take one step, never beyond `t_stop`; return the flag (< 0: failed) and the time reached."""
        flag = step.advance(self.explicit, t_stop)
        return flag, self.explicit.t

    def interpolate(self, t: float) -> None:
        """Write the states at a time inside the last step to `between`."""
        step.put_inside(self.explicit, t, self._between)

    @property
    def last_step(self) -> float:
        """Size of the last step taken."""
        return float(self.explicit.h_last)

    def counts(self) -> Counts:
        """Return the tries that failed since the run began; its order is always the same."""
        return Counts(0, self.explicit.rejected, 0)

    def worst_state(self) -> int:
        """Return the number of the state with the largest test difference in the last try."""
        return int(self.explicit.worst)
