"""Right-hand side and Jacobian of a model as functions of t and x, in plain Python.

Of a `SolverProblem` they use what says where states, derivatives and Jacobian tables are: `last`, `base` and
`moved` are room for n numbers each, `nonzeros` is how many numbers the matrix has. Each returns 0, or 1 if a
result is not finite.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.jacobian_fill import fill
from desire_tui.engine.codegen.stiff.model_calls import has_finite_sum, scatter
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Reals
    from desire_tui.engine.integration.problem import SolverProblem


def right_hand_side(problem: SolverProblem, t: float, x: Reals, derivatives: Reals) -> Int32:
    """Write dx/dt."""
    values: Reals = problem.values
    values[T] = t
    scatter(problem, x)
    problem.derivatives(problem.memory, derivatives)
    return 0 if has_finite_sum(derivatives, problem.n) else 1


def right_hand_sides(
    problem: SolverProblem, count: int, times: Reals, states: Reals, derivatives: Reals
) -> Int32:
    """Write dx/dt at `count` places: n numbers of each stand in a row."""
    n = problem.n
    x: Reals = problem.last
    found: Reals = problem.base
    wild = 0
    for k in range(count):
        copy(x, 0, states, k * n, n)
        if right_hand_side(problem, times[k], x, found):
            wild = 1
        copy(derivatives, k * n, found, 0, n)
    return wild


def jacobian(problem: SolverProblem, t: float, x: Reals, matrix: Reals) -> Int32:
    """Write ∂(dx/dt)/∂x to the places that the tables give each entry; the other numbers become 0."""
    for i in range(problem.nonzeros):
        matrix[i] = 0.0
    here: Reals = problem.last
    column: Reals = problem.base
    moved: Reals = problem.moved
    right_hand_side(problem, t, x, here)
    return 1 if fill(problem, t, x, here, matrix, column, moved) else 0
