"""Dense LU factors: those of SUNDIALS, pivots and all, on any number of threads."""

from __future__ import annotations

import ctypes
import platform

import numpy as np
import pytest

from desire_tui.engine.codegen.stiff.dense_factors import LEAST, factorise_address
from desire_tui.engine.codegen.threads.pool import thread_pool
from desire_tui.engine.integration.sundials.library import is_there, libraries
from desire_tui.engine.integration.sundials.signatures import address
from desire_tui.engine.thread_count import thread_count

pytestmark = pytest.mark.skipif(not is_there(), reason="there is no SUNDIALS")
SETUP = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p)


class Dense:
    """A matrix and its solver, SUNDIALS' own."""

    def __init__(self, n: int) -> None:
        self.n, library, core = n, libraries().cvode, libraries().core
        context = ctypes.c_void_p()
        assert core.SUNContext_Create(0, ctypes.byref(context)) == 0
        self._numbers = np.zeros(n)
        vector = library.N_VMake_Serial(n, self._numbers.ctypes.data, context)
        self.matrix = library.SUNDenseMatrix(n, n, context)
        self.solver = library.SUNLinSol_Dense(vector, self.matrix, context)
        data = (ctypes.c_double * (n * n)).from_address(library.SUNDenseMatrix_Data(self.matrix))
        self.columns = np.ctypeslib.as_array(data).reshape(n, n)

    def factors(self, a: np.ndarray, setup: int) -> tuple[bool, np.ndarray, list[int]]:
        """Say whether a matrix is singular, and return its factors and pivots."""
        self.columns[:] = a.T
        singular = SETUP(setup)(self.solver, self.matrix) != 0
        content = ctypes.c_uint64.from_address(self.solver).value
        pivots = (ctypes.c_int32 * self.n).from_address(ctypes.c_uint64.from_address(content + 8).value)
        flag = ctypes.c_int32.from_address(content + 16).value
        return singular, self.columns.copy(), [*pivots, flag]


def matrices(n: int) -> list[np.ndarray]:
    """Full, with zeros among the factors, with exchanges that come back, without a pivot in its middle."""
    random = np.random.default_rng(n)
    full = random.standard_normal((n, n))
    sparse = np.where(random.random((n, n)) < 0.05, full, 0.0) + np.eye(n)
    singular = full.copy()
    singular[:, n // 2] = 0.0
    return [full, sparse, np.flipud(np.eye(n)) + np.tril(sparse, -3), singular]


@pytest.mark.parametrize("n", [LEAST, 71, 300])
def test_factors_are_those_of_sundials(n):
    dense, own = Dense(n), address(libraries().cvode, "SUNLinSolSetup_Dense")
    try:
        for a in matrices(n):
            wanted = dense.factors(a, own)
            for members in (1, 3):
                thread_pool().resize(members)
                found = dense.factors(a, factorise_address(n))
                assert (found[0], found[2][-1]) == (wanted[0], wanted[2][-1])
                if found[0]:
                    continue  # what is behind the column without a pivot is of no use
                assert found[2] == wanted[2]
                if platform.machine() == "x86_64":  # elsewhere its compiler may have fused products and sums
                    assert found[1].tobytes() == wanted[1].tobytes()
                np.testing.assert_allclose(found[1], wanted[1], rtol=1e-9, atol=1e-12)
    finally:
        thread_pool().resize(thread_count())


def test_small_matrices_are_left_to_sundials():
    assert factorise_address(LEAST - 1) == 0
