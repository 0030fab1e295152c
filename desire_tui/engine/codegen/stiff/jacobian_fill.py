"""The Jacobian's entries, in plain Python: exact, by differences, or those of the program's JACOBIAN."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.model_calls import GO_BACK, scale, scatter
from desire_tui.engine.integration.problem import Matrix
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Int32s, Reals
    from desire_tui.engine.integration.problem import SolverProblem

GIVE_UP = -1
"""A callback's result for: no step will do."""

_DIFFERENCE = 1.4901161193847656e-08  # square root of the machine's epsilon
_LEAST = 1.0
"""A difference is never smaller than this part of the largest value so far would give: with smaller ones
rounding breaks conservation laws, which long steps (Robertson's 1e10) do not forgive."""


def fill(
    problem: SolverProblem, t: float, y: Reals, fy: Reals, data: Reals, spare: Reals, spare2: Reals
) -> Int32:
    """Write all entries to a matrix that has been cleared."""
    problem.jacobian_calls += 1
    values: Reals = problem.values
    values[T] = t
    scatter(problem, y)
    if problem.method == Matrix.TANGENT:
        fill_by_tangent(problem, data, spare)
    elif problem.method == Matrix.DIFFERENCES:
        fill_by_differences(problem, data, y, fy, spare, spare2)
    elif problem.method == Matrix.PROGRAM:
        fill_by_program(problem, data)
    if is_finite(problem, data):
        return 0
    return GIVE_UP if problem.method == Matrix.PROGRAM else GO_BACK


def is_finite(problem: SolverProblem, data: Reals) -> int:
    """Whether all entries are: an infinite one makes corrections 0, which would pass for convergence."""
    places: Int32s = problem.places
    starts: Int32s = problem.entry_starts
    total = 0.0
    for i in range(starts[problem.colours]):
        total += data[places[i]] * 0.0
    return total == 0.0


def fill_by_tangent(problem: SolverProblem, data: Reals, column: Reals) -> None:
    """Take the derivative in the direction of each colour's states."""
    seeds: Int32s = problem.seeds
    seed_starts: Int32s = problem.seed_starts
    entry_starts: Int32s = problem.entry_starts
    rows: Int32s = problem.rows
    places: Int32s = problem.places
    directions: Reals = problem.directions
    for colour in range(problem.colours):
        for i in range(seed_starts[colour], seed_starts[colour + 1]):
            directions[seeds[i]] = 1.0
        problem.tangent(problem.memory, column)
        for i in range(seed_starts[colour], seed_starts[colour + 1]):
            directions[seeds[i]] = 0.0
        for i in range(entry_starts[colour], entry_starts[colour + 1]):
            data[places[i]] = column[rows[i]]


def fill_by_differences(
    problem: SolverProblem, data: Reals, y: Reals, fy: Reals, column: Reals, moved: Reals
) -> None:
    """Curtis, Powell and Reid (1974): states that share no row are moved together."""
    seeds: Int32s = problem.seeds
    seed_starts: Int32s = problem.seed_starts
    entry_starts: Int32s = problem.entry_starts
    rows: Int32s = problem.rows
    columns: Int32s = problem.columns
    places: Int32s = problem.places
    change: Reals = problem.spare
    copy(moved, 0, y, 0, problem.n)
    for colour in range(problem.colours):
        for i in range(seed_starts[colour], seed_starts[colour + 1]):
            state = seeds[i]
            size = max(scale(problem, state) * _LEAST, abs(y[state]))
            to = y[state] + size * _DIFFERENCE
            change[state] = to - y[state]
            moved[state] = to
        scatter(problem, moved)
        problem.derivative_calls += 1
        problem.derivatives(problem.memory, column)
        for i in range(seed_starts[colour], seed_starts[colour + 1]):
            moved[seeds[i]] = y[seeds[i]]
        for i in range(entry_starts[colour], entry_starts[colour + 1]):
            rise = column[rows[i]] - fy[rows[i]]
            data[places[i]] = rise / change[columns[i]]


def fill_by_program(problem: SolverProblem, data: Reals) -> None:
    """Run the JACOBIAN segment and take the entries from its array."""
    problem.jacobian(problem.memory, data)
    array: Reals = problem.array
    sources: Int32s = problem.sources
    places: Int32s = problem.places
    starts: Int32s = problem.entry_starts
    for i in range(starts[0], starts[1]):
        data[places[i]] = array[sources[i]]
