"""Which linear algebra a model gets under a rule, and the tables by which its Jacobian is filled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.integration.problem import Matrix
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.integration.sundials.library import is_there, superlu
from desire_tui.engine.integration.sundials.linear import Linear, positions

if TYPE_CHECKING:
    from desire_tui.engine.integration.pattern import Numbers, Pattern
    from desire_tui.engine.integration.problem import SolverProblem

DENSE_MOST = 30
"""Up to so many states a dense matrix is always best (measured: docs/rules.md)."""


@dataclass(frozen=True)
class JacobianTables:
    """The tables of `problem.SolverProblem`, kept alive here."""

    seed_starts: Numbers
    seeds: Numbers
    entry_starts: Numbers
    rows: Numbers
    columns: Numbers
    places: Numbers
    sources: Numbers
    row_indices: Numbers
    column_starts: Numbers

    def give(self, problem: SolverProblem) -> None:
        """Write the tables' addresses into the structure."""
        for name in self.__dataclass_fields__:
            setattr(problem, name, getattr(self, name).ctypes.data)
        problem.colours = len(self.seed_starts) - 1


@dataclass(frozen=True)
class SolverPlan:
    """How a model's corrector equations are solved: `linear` is without the Jacobian's address."""

    linear: Linear
    method: Matrix
    tables: JacobianTables | None


def is_own(rule: int, n: int, plan: SolverPlan) -> bool:
    """Whether `bdf` does it in CVODE's place: Newton's iteration for BDF with a dense matrix.

    For few states, where it is faster; for any number where there is no CVODE.
    """
    if not rule_numbered(rule).has_own_solver or plan.tables is None or plan.linear.kind != "dense":
        return False
    return n <= DENSE_MOST or not is_there()


def plan(rule: int, pattern: Pattern, *, program: bool = False, tangent: bool = True) -> SolverPlan:
    """Decide for a multistep rule.

    `pattern` is where the Jacobian is not zero. `program`: a JACOBIAN segment fills it. `tangent`: else exact
    derivatives are at hand; without them a rule with a Jacobian differences too (the reference back end).
    """
    corrector = rule_numbered(rule).corrector
    if corrector in (None, "fixed-point"):  # without one no equations are solved
        return SolverPlan(Linear("fixed-point"), Matrix.NONE, None)
    if corrector == "diagonal":
        return SolverPlan(Linear("diagonal"), Matrix.NONE, None)
    linear = _linear(pattern)
    method = Matrix.DIFFERENCES
    if corrector == "jacobian":
        method = Matrix.PROGRAM if program else Matrix.TANGENT if tangent else Matrix.DIFFERENCES
    places = positions(linear, pattern.n, pattern.rows, pattern.columns)
    return SolverPlan(linear, method, jacobian_tables(pattern, places, method))


def _linear(pattern: Pattern) -> Linear:
    """Compare the operations of one factorisation: n³/3 dense, 2·n·l·(l + u) band."""
    n = pattern.n
    if n <= DENSE_MOST or not is_there():
        return Linear("dense")
    lower, upper = pattern.lower, pattern.upper
    band_work = 2.0 * n * (lower + 1) * (lower + upper + 1)
    dense_work = n**3 / 3.0
    sparse_work = 4000.0 * n + 40.0 * pattern.count * (pattern.count / n) if superlu_pays(pattern) else np.inf
    best = min((dense_work, 0, "dense"), (band_work, 1, "band"), (sparse_work, 2, "sparse"))[2]
    if best == "band":
        return Linear("band", lower=lower, upper=upper)
    if best == "sparse":
        return Linear("sparse", nonzeros=pattern.count)
    return Linear("dense")


def superlu_pays(pattern: Pattern) -> bool:
    """Whether there is a sparse solver and the matrix is large and empty enough to load it."""
    return pattern.n > 200 and pattern.count < 0.1 * pattern.n**2 and superlu() is not None


def jacobian_tables(pattern: Pattern, places: Numbers, method: Matrix) -> JacobianTables:
    """Return the tables that fill a matrix whose entries have these flat places, in the pattern's order."""
    n = pattern.n
    colours = np.zeros(n, dtype=np.int32) if method is Matrix.PROGRAM else pattern.colours
    number = int(colours.max(initial=-1)) + 1
    seeds = np.argsort(colours, kind="stable").astype(np.int32)
    entry_colours = colours[pattern.columns]
    order = np.argsort(entry_colours, kind="stable")
    edges = np.arange(number + 1)
    return JacobianTables(
        seed_starts=np.searchsorted(colours[seeds], edges).astype(np.int32),
        seeds=seeds,
        entry_starts=np.searchsorted(entry_colours[order], edges).astype(np.int32),
        rows=pattern.rows[order],
        columns=pattern.columns[order],
        places=places[order],
        sources=(pattern.rows.astype(np.int64) * n + pattern.columns).astype(np.int32)[order],
        row_indices=pattern.rows,
        column_starts=pattern.starts,
    )
