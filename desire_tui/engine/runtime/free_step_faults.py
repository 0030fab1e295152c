"""What a flag of `integration.explicit` means: rules 4, 7 and 8 end as they do where steps end on points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.explicit.memory import DEADLOCK, NOT_FINITE
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.values import DT, ERRMAX

if TYPE_CHECKING:
    from desire_tui.engine.integration.explicit.solver import ExplicitSolver
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values


def leave_step(solver: ExplicitSolver, memory: RunMemory, values: Values, ended: Ended) -> Ended:
    """Return why a run has ended of which the solver says SOLVER; `which` is then the state's number.

    DT is left as the step to be tried next, ERRMAX as a difference that could not be reduced.
    """
    if ended in {Ended.RUNNING, Ended.STOPPED}:
        return ended
    explicit = solver.explicit
    if explicit.dt > 0.0:
        values.cells[DT] = explicit.dt
    if ended is not Ended.SOLVER:
        return ended
    flag, memory.which = memory.which, solver.worst_state()
    if flag == DEADLOCK:
        values.cells[ERRMAX] = explicit.difference
        return Ended.DEADLOCK
    return Ended.NOT_FINITE if flag == NOT_FINITE else Ended.STALLED
