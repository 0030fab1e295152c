"""What the solver knows between two steps: one C structure and the arrays it points at."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.bdf.memory import Evaluate
from desire_tui.engine.integration.tableaus import whole_multiples

if TYPE_CHECKING:
    from desire_tui.engine.integration.tableaus import Tableau

STAGES_MOST = 4
ROW = 1 + STAGES_MOST
"""Numbers of a row: its denominator, and a whole multiple for each stage."""
DEADLOCK, NOT_FINITE, GAVE_UP = -101, -102, -8
"""Flags. Half of a step would be below DTMIN; a state is inf or nan; the callback gave up (CVODE's)."""

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double
_REALS = ctypes.POINTER(_REAL)


class Explicit(ctypes.Structure):
    """State of the solver for n states.

    `rows` holds ROW numbers for each stage from the second on, at ROW times its number from 0; then those of
    the new states, then those of the test difference. `k` holds n derivatives for each stage and, behind
    them, those at the step's end.
    """

    _fields_ = (
        ("problem", _ADDRESS), ("evaluate", Evaluate),
        ("n", _INT),
        ("stages", _INT), ("nodes", _REALS), ("rows", _REALS),
        ("y", _REALS),  # states; others may put them back to where something happened in the step
        ("base", _REALS), ("end", _REALS),  # those at both ends of the last step
        ("k", _REALS),
        ("rate", _REALS),  # n numbers
        ("t", _REAL), ("t_base", _REAL),
        ("h_last", _REAL),
        ("dt", _REAL),  # the step to be tried next; 0: none has been
        ("dt_least", _REAL), ("dt_most", _REAL),
        ("dt_anew", _REAL),  # no step is longer behind a place where something has happened
        ("error_least", _REAL), ("error_most", _REAL),
        ("error_one", _REAL),  # what is added to abs(x)
        ("checked", _INT),  # CHECKN
        ("difference", _REAL),  # the last test difference …
        ("worst", _INT),  # … and its state
        ("is_known", _INT),  # 1: the derivatives at t are the last row of `k`
        ("is_cubic", _INT),  # 1: these are finite
        ("rejected", _INT),
    )  # fmt: skip


class Arrays:
    """The memory behind an `Explicit`, kept alive here."""

    def __init__(self, tableau: Tableau, n: int) -> None:
        assert tableau.test is not None
        self.nodes = np.array([float(c) for c in tableau.c])
        self.rows = np.zeros((tableau.stages + 2, ROW))
        for to, row in zip(self.rows, (*tableau.a, tableau.b, tableau.test), strict=True):
            to[0], multiples = whole_multiples(row) if row else (1, ())
            to[1 : 1 + len(multiples)] = multiples
        self.base, self.end, self.rate = np.zeros((3, max(n, 1)))
        self.k = np.zeros((tableau.stages + 1, max(n, 1)))

    def give(self, solver: Explicit) -> None:
        """Write the arrays' addresses into the structure."""
        for name in ("nodes", "rows", "base", "end", "rate", "k"):
            setattr(solver, name, ctypes.cast(getattr(self, name).ctypes.data, _REALS))
