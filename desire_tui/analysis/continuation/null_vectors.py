"""Null vectors of large matrices that are nearly singular, or exactly, from bordered equations.

W. Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (2000), chapter 3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class NullVectors(NamedTuple):
    """Right and left null vectors, and the number that is 0 where the matrix is singular."""

    right: Floats
    left: Floats
    value: float


def null_vectors(matrix: Any, column: Floats, row: Floats) -> NullVectors:
    """Solve the equations of a square sparse matrix that a column and a row border.

    The row times the right vector is 1, the left vector times the column too. LinAlgError: both borders
    leave it singular.
    """
    from scipy.sparse import csc_array, hstack, vstack
    from scipy.sparse.linalg import splu

    upper = hstack([matrix, csc_array(column[:, None])])
    whole = vstack([upper, csc_array(np.append(row, 0.0)[None, :])])
    try:
        factors = splu(csc_array(whole))
    except RuntimeError as reason:  # SuperLU: the factor is exactly singular
        raise np.linalg.LinAlgError(str(reason)) from None
    last = np.zeros(len(column) + 1)
    last[-1] = 1.0
    ahead, back = factors.solve(last), factors.solve(last, trans="T")
    return NullVectors(ahead[:-1], back[:-1], float(ahead[-1]))
