"""A relay that holds the solution on its jump, in plain Python: how finely it is followed.

Code behind `step` that switches an input back and forth begins the solver anew each time, its steps as small
as ERMAX asks of a method of order 1: tens of thousands of them, to follow a zigzag that is as high as a step
is long times the jump, far above ERMAX. Where an input has returned to what it was before very often, within
a few steps each time, the errors of steps may grow until steps are a small part of the run. The first steps
in a row without such a return end that, and ERMAX holds again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.problem import SLIDE_STEPS, SLIDE_TURNS

if TYPE_CHECKING:
    from desire_tui.engine.integration.problem import SolverProblem


def follow_slide(problem: SolverProblem, size: float) -> int:
    """Count a return where the solver begins anew behind a step of `size`; let errors grow behind many."""
    if problem.returned == 0 or problem.fresh > SLIDE_STEPS:
        end_slide(problem)
        return 0
    problem.returned = 0
    problem.turns += 1
    if problem.turns > SLIDE_TURNS and size < problem.slide_size:
        problem.relief *= 2.0
        problem.tolerance *= 2.0
        problem.absolute *= 2.0
    return 0


def end_slide(problem: SolverProblem) -> int:
    """Let ERMAX hold again."""
    problem.turns = 0
    problem.returned = 0
    problem.tolerance /= problem.relief
    problem.absolute /= problem.relief
    problem.relief = 1.0
    return 0
