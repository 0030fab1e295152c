"""The linear algebra under an implicit step: which solver, and how it is attached to CVODE."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.sundials.library import superlu
from desire_tui.engine.integration.sundials.signatures import CSC, SUCCESS, address

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.sundials.library import Libraries

_OPERATIONS = 14
"""Pointers in SUNDIALS 7's table of a linear solver's operations, at least."""

Kind = Literal["fixed-point", "dense", "band", "sparse", "diagonal"]


@dataclass(frozen=True)
class Linear:
    """How the corrector's equations are solved.

    `fixed-point`: functional iteration, no matrix. `diagonal`: CVDiag, a diagonal approximation by
    differences. `dense`, `band` (`lower` and `upper` diagonals), `sparse` (`nonzeros` entries, SuperLU_MT):
    Newton's iteration; `jacobian` is the address of a CVLsJacFn, 0 lets CVODE difference the right-hand
    side (dense and band only). `factorise`: the address of a setup operation that a dense solver gets in
    place of its own; 0: it keeps its own.
    """

    kind: Kind
    jacobian: int = 0
    factorise: int = 0
    lower: int = 0
    upper: int = 0
    nonzeros: int = 0


class Attached:
    """The solver objects that belong to one CVODE memory; `free` gives them back."""

    def __init__(
        self, libraries: Libraries, context: ctypes.c_void_p, memory: int, vector: int, n: int, linear: Linear
    ) -> None:
        self._libraries = libraries
        self._iteration = self._matrix = self._solver = 0
        self._sparse = linear.kind == "sparse"
        library = libraries.cvode
        if linear.kind == "fixed-point":
            self._iteration = _made(library.SUNNonlinSol_FixedPoint(vector, 0, context))
            _check(library.CVodeSetNonlinearSolver(memory, self._iteration))
            return
        if linear.kind == "diagonal":
            _check(library.CVDiag(memory))
            return
        if linear.kind == "dense":
            self._matrix = _made(library.SUNDenseMatrix(n, n, context))
            self._solver = _made(library.SUNLinSol_Dense(vector, self._matrix, context))
            if linear.factorise:
                _replace(self._solver, address(library, "SUNLinSolSetup_Dense"), linear.factorise)
        elif linear.kind == "band":
            self._matrix = _made(library.SUNBandMatrix(n, linear.upper, linear.lower, context))
            self._solver = _made(library.SUNLinSol_Band(vector, self._matrix, context))
        else:
            sparse = superlu()
            if sparse is None:
                raise DesireError(Diagnostic("solver-missing", facts={"reason": "it has no sparse solver"}))
            self._matrix = _made(library.SUNSparseMatrix(n, n, linear.nonzeros, CSC, context))
            self._solver = _made(sparse.SUNLinSol_SuperLUMT(vector, self._matrix, 1, context))
            _check(sparse.SUNLinSolInitialize_SuperLUMT(self._solver))
            # done once: CVODE calls it at each restart, when it would forget, and never free, its factors
            _replace(self._solver, address(sparse, "SUNLinSolInitialize_SuperLUMT"), 0)
        _check(library.CVodeSetLinearSolver(memory, self._solver, self._matrix))
        if linear.jacobian:
            _check(library.CVodeSetJacFn(memory, linear.jacobian))

    def _may_be_freed(self) -> bool:
        """Whether freeing the solver is safe: SuperLU_MT crashes without its factors (SUNDIALS 7.9)."""
        return not self._sparse or not _first_factorisation_due(self._solver)

    def free(self) -> None:
        """Give back solver, matrix and iteration; after CVodeFree."""
        core = self._libraries.core
        if self._solver and self._may_be_freed():
            core.SUNLinSolFree(self._solver)
        if self._matrix:
            core.SUNMatDestroy(self._matrix)
        if self._iteration:
            core.SUNNonlinSolFree(self._iteration)
        self._solver = self._matrix = self._iteration = 0


def _replace(solver: int, operation: int, other: int) -> None:
    """Put another function (0: none, where the solver may lack it) in an operation's place."""
    operations = ctypes.c_uint64.from_address(solver + 16).value  # {content, python, operations, context}
    table = (ctypes.c_uint64 * _OPERATIONS).from_address(operations)
    for place in range(_OPERATIONS):
        if table[place] == operation:
            table[place] = other
            return


def _first_factorisation_due(solver: int) -> bool:
    """Look into SuperLU_MT's content, `{int last_flag; int first_factorize; …}`."""
    content = ctypes.c_uint64.from_address(solver).value
    return ctypes.c_int32.from_address(content + 4).value != 0


def positions(
    linear: Linear, n: int, rows: NDArray[np.int32], columns: NDArray[np.int32]
) -> NDArray[np.int32]:
    """Flat place of each entry (row, column) in the data of the matrix that `Attached` makes.

    Dense: entry (i, k) at k·n + i. Band: column after column, each from its topmost stored diagonal down.
    Sparse: as they come; they must be sorted by column, then row. A dense matrix of more than 46,340 states
    has places beyond 32 bits, and 17 GB: MemoryError.
    """
    if linear.kind == "dense":
        if n * n > np.iinfo(np.int32).max:
            raise MemoryError
        return (columns.astype(np.int64) * n + rows).astype(np.int32)
    if linear.kind == "band":
        stored = min(n - 1, linear.upper + linear.lower)  # room for the fill of the LU factors
        stride = stored + linear.lower + 1
        return (columns.astype(np.int64) * stride + stored + rows - columns).astype(np.int32)
    return np.arange(len(rows), dtype=np.int32)


def _made(handle: int | None) -> int:
    if not handle:
        raise MemoryError("SUNDIALS could not make an object")
    return handle


def _check(flag: int) -> None:
    assert flag == SUCCESS, f"SUNDIALS refused a setting: {flag}"
