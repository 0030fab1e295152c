"""CVODE's callbacks, in plain Python: right-hand side, error weights, Jacobian; results as CVODE wants them.

An N_Vector is `{content, ops, context}`, a serial one's content
`{int32 length; int32 own_data; double* data}`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.jacobian_fill import fill
from desire_tui.engine.codegen.stiff.model_calls import evaluate, weigh

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Address, Addresses, Int32, Int32s, Reals
    from desire_tui.engine.integration.problem import SolverProblem


def rhs(t: float, y: Address, ydot: Address, problem: SolverProblem) -> Int32:
    """CVRhsFn."""
    return evaluate(problem, t, numbers(y), numbers(ydot))


def weights(y: Address, w: Address, problem: SolverProblem) -> Int32:
    """CVEwtFn."""
    return weigh(problem, numbers(y), numbers(w))


def jacobian(
    t: float,
    y: Address,
    fy: Address,
    matrix: Address,
    problem: SolverProblem,
    spare: Address,
    spare2: Address,
    _: Address,
) -> Int32:
    """CVLsJacFn; CVODE has cleared the matrix."""
    data: Reals = problem.data_of(matrix)
    if problem.nonzeros != 0:
        write_pattern(problem, matrix)
    return fill(problem, t, numbers(y), numbers(fy), data, numbers(spare), numbers(spare2))


def numbers(vector: Address) -> Reals:
    """Return a serial N_Vector's numbers."""
    parts: Addresses = vector
    content: Addresses = parts[0]
    data: Reals = content[1]
    return data


def write_pattern(problem: SolverProblem, matrix: Address) -> None:
    """Give a sparse matrix its rows and column starts, which SUNMatZero cleared."""
    rows: Int32s = problem.indices_of(matrix)
    row_indices: Int32s = problem.row_indices
    copy(rows, 0, row_indices, 0, problem.nonzeros)
    starts: Int32s = problem.starts_of(matrix)
    column_starts: Int32s = problem.column_starts
    copy(starts, 0, column_starts, 0, problem.n + 1)
