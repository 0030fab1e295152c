"""What the solver knows between two steps: one C structure and the arrays it points at."""

from __future__ import annotations

import ctypes

import numpy as np

ORDER_MOST = 5
"""BDF of order 6 is unstable for nearly every stiff problem."""
ROWS = ORDER_MOST + 1
TOO_ACCURATE, TEST_FAILED, NOT_CONVERGED, SETUP_FAILED, GAVE_UP, NO_DERIVATIVES = -2, -3, -4, -6, -8, -10
"""CVODE's flags. More accuracy is wished for than doubles have; the error test, the corrector failed too
often; the Jacobian cannot be had; a callback gave up; derivatives were not finite."""
EPSILON = 2.220446049250313e-16

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double
_REALS, _INTS = ctypes.POINTER(_REAL), ctypes.POINTER(_INT)

Evaluate = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REAL, _REALS, _REALS)
"""f(problem, t, y, out): derivatives. 0 done, > 0 try a smaller step, < 0 give up."""
Weigh = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REALS, _REALS)
"""f(problem, y, out): one over the error allowed to each state."""
Fill = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REAL, *[_REALS] * 5)
"""f(problem, t, y, derivatives, matrix, spare, spare): the Jacobian by columns; results as above."""


class Bdf(ctypes.Structure):
    """State of the solver for n states. Names in brackets are CVODE's, whose algorithm this is.

    `z` holds the Nordsieck array, row j of n numbers at j·n: hʲ/j! times the j-th derivative. Row
    ORDER_MOST serves as a store for the last correction while the order is below (CVODE's `indx_acor`).
    """

    _fields_ = (
        ("problem", _ADDRESS), ("evaluate", Evaluate), ("weigh", Weigh), ("fill", Fill),
        ("n", _INT),
        ("z", _REALS),  # [zn]
        ("correction", _REALS),  # [acor]: what the corrector added to the prediction
        ("y", _REALS),  # the corrector's iterate; after a step the solution
        ("derivatives", _REALS),  # [ftemp] at `y`
        ("weights", _REALS),  # [ewt]
        ("change", _REALS), ("spare", _REALS), ("spare2", _REALS),  # [delta, tempv]
        ("jacobian", _REALS),  # [savedJ]
        ("factors", _REALS),  # LU factors of I − gamma·J, column after column
        ("swaps", _INTS),
        ("t", _REAL),  # [tn]
        ("h", _REAL), ("h_next", _REAL), ("h_scale", _REAL), ("h_last", _REAL),  # [hprime, hscale, hu]
        ("h_first", _REAL),  # 0: the solver looks for one
        ("h_most", _REAL),  # 0: no bound
        ("ratio", _REAL), ("ratio_most", _REAL), ("ratio_here", _REAL),  # [eta, etamax, etaq]
        ("order", _INT), ("order_next", _INT), ("order_last", _INT),  # [q, qprime, qu]
        ("wait", _INT),  # [qwait]: steps until another order is considered
        ("tau", _REAL * (ROWS + 1)),  # the last steps' sizes
        ("l", _REAL * (ROWS + 1)),  # coefficients of the corrector
        ("l_order", _INT), ("l_h", _REAL),  # what `l` was made for: so many equal steps of this size
        ("tq", _REAL * 6),  # constants of the error tests
        ("tq5_kept", _REAL),  # [saved_tq5]
        ("gamma", _REAL), ("gamma_factored", _REAL),  # [gamma, gammap]
        ("rate", _REAL),  # [crate]: of the corrector's convergence
        ("share", _REAL),  # [nlscoef]: part of the error test left to the corrector
        ("norm", _REAL),  # [acnrm]: of the correction
        ("steps", _INT), ("factored_at", _INT), ("jacobian_at", _INT),  # [nst, nstlp, nstlj]
        ("failed_tests", _INT), ("failed_corrections", _INT),  # since the restart
        ("doubt", _INT),  # what failures of the corrector have left behind (`integration.problem`)
    )  # fmt: skip


_ARRAYS = (
    "z", "correction", "y", "derivatives", "weights", "change", "spare", "spare2", "jacobian", "factors"
)  # fmt: skip


class Arrays:
    """The memory behind a `Bdf`, kept alive here."""

    def __init__(self, n: int) -> None:
        self._reals = np.zeros((ROWS + 1) * n + 7 * n + 2 * n * n)
        self._swaps = np.zeros(max(n, 1), dtype=np.int64)

    def give(self, bdf: Bdf, n: int) -> None:
        """Write the arrays' addresses into the structure."""
        bdf.n = n
        place = self._reals.ctypes.data
        sizes = {"z": (ROWS + 1) * n, "jacobian": n * n, "factors": n * n}
        for name in _ARRAYS:
            setattr(bdf, name, ctypes.cast(place, _REALS))
            place += 8 * sizes.get(name, n)
        bdf.swaps = ctypes.cast(self._swaps.ctypes.data, _INTS)
