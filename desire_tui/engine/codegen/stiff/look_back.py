"""What is looked for in the last step, in plain Python; rule 17 has ways of its own (`taylor_steps`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32
    from desire_tui.engine.integration.problem import SolverProblem


def look(problem: SolverProblem, t0: float, t1: float) -> Int32:
    """Find the first switching in the last step (`switching.watch.look_back`)."""
    found: int = problem.look(problem.watch, t0, t1)
    return found


def look_for_moments(problem: SolverProblem, t0: float, t1: float) -> int:
    """Find the first event in the last step (`runtime.moments.locate.look_inside`)."""
    found: int = problem.look_inside(problem.moments, t0, t1)
    return found
