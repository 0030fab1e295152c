"""What the solver knows between two steps: one C structure and the arrays it points at."""

from __future__ import annotations

import ctypes
from math import ceil, log

import numpy as np

EPSILON = 2.220446049250313e-16
ORDER_LEAST, ORDER_MOST = 3, 20
"""20 is what Jorba and Zou's rule gives at the machine's precision."""
NO_COEFFICIENTS = -10
"""Flag: a coefficient is not finite (CVODE's: derivatives were not finite)."""
GAVE_UP = -8
"""Flag: the callback gave up."""

HALVES_MOST = 30
"""Roots are looked for in parts of a step down to 2^-30 of it."""

STATES_OF_A_BLOCK = 1 << 12
"""Where threads share the loops over the states (`shared_steps`)."""
FOUND = 8
"""Numbers that each block leaves, in a cache line of its own."""

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double
_REALS, _INTS = ctypes.POINTER(_REAL), ctypes.POINTER(_INT)

Expand = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REAL, _REALS)
"""f(problem, t, y): compute all coefficients at t from the states y. 0 done, < 0 give up."""


Share = ctypes.CFUNCTYPE(None, _ADDRESS, _ADDRESS, _ADDRESS, _ADDRESS, _INT, _INT)
"""f(body, values, derivatives, context, count, block): `body` for all blocks, by all threads."""


class Taylor(ctypes.Structure):
    """State of the solver for n states.

    `pieces` holds quadruples (first state, count, place of coefficient 0 of the first, distance of a state's
    coefficients) into `coefficients`. The solution at t is `y` + `rest`, of which `rest` is what `y` was
    rounded by.
    """

    _fields_ = (
        ("problem", _ADDRESS), ("expand", Expand),
        ("at_start", _ADDRESS), ("recurrences", _ADDRESS),  # native: functions of the model
        ("values", _ADDRESS),
        ("memory", _ADDRESS),  # of the run, for `at_start`
        ("n", _INT),
        ("piece_count", _INT), ("pieces", _INTS),
        ("coefficients", _REALS),
        ("order", _INT),
        ("per_order", _REAL), ("per_order_before", _REAL),  # one over the order, and over the one before
        ("log_part", _REAL),  # logarithm of the part of the radius of convergence that a step is
        ("y", _REALS), ("rest", _REALS),
        ("base", _REALS), ("base_rest", _REALS),  # the same at the last step's start
        ("largest", _REALS),  # magnitudes of states so far
        ("most", _REAL),  # the largest of them
        ("absolute", _REAL),  # what a state's scale is at least
        ("t", _REAL), ("t_base", _REAL),
        ("h_last", _REAL),
        ("h_most", _REAL),  # 0: no bound
        ("steps", _INT),
        ("worst", _INT),  # state whose coefficient was not finite
        # arguments of modes, `argument_count` of them, and of events: pairs (place of coefficient 0,
        # distance), -1 for one that does not move (`roots`, `isolation`)
        ("argument_count", _INT), ("argument_total", _INT), ("arguments", _INTS),
        ("argument_error", _REAL),  # relative error that these may have at a step's end
        ("work", _REALS), ("part", _REALS), ("turned", _REALS), ("halves", _INTS),
        ("left", _REAL), ("right", _REAL),
        # square roots: triples (place of coefficient 0 of the first, distance, count) (`square_roots`)
        ("root_count", _INT), ("roots", _INTS),
        # loops over many states (`shared_steps`); `share` 0: there are few
        ("itself", _ADDRESS), ("share", _ADDRESS), ("scan_block", _ADDRESS), ("move_block", _ADDRESS),
        ("block_count", _INT), ("found", _REALS), ("found_states", _INTS),
        ("floor", _REAL),  # what a state's magnitude counts as at least
        ("h_now", _REAL),
        # a walk along a step (`isolation`)
        ("walk_h", _REAL), ("walk_low", _REAL), ("walk_width", _REAL), ("walk_level", _INT),
    )  # fmt: skip


class Arrays:
    """The memory behind a `Taylor`, kept alive here."""

    def __init__(self, n: int, room: int) -> None:
        self.reals = np.zeros((4, max(n, 1)))
        self.polynomials = np.zeros((3, ORDER_MOST + 1))
        self.halves = np.zeros(HALVES_MOST + 1, dtype=np.int64)
        self.block_count = max(-(-n // STATES_OF_A_BLOCK), 1)
        places = FOUND * self.block_count
        self.found, self.found_states = np.zeros(places), np.zeros(places, dtype=np.int64)
        flat = np.zeros(room + 8)
        self.coefficients = flat[-(flat.ctypes.data // 8) % 8 :]
        """From the start of a cache line."""


_SAFETY = 0.7
_ORDER_PART = 0.7
"""Jorba and Zou's 1/2 is best where a step's time grows with the square of the order. Most of ours grows with
the order itself: small models wait for one coefficient after the other, what surrounds them is always the
same. At equal errors from 1e-5 to 1e-10 0.7 takes 0.8 of the time on Lorenz' equations, 0.9 on Kepler's orbit
and the Pleiades, as long on the Brusselator."""


def order_for(tolerance: float) -> int:
    """Return the order for a relative tolerance ε: -0.7·ln(ε) + 1, rounded up."""
    wanted = ceil(-log(max(tolerance, EPSILON)) * _ORDER_PART) + 1 if tolerance < 1.0 else ORDER_LEAST
    return min(max(wanted, ORDER_LEAST), ORDER_MOST)


def argument_error_for(tolerance: float) -> float:
    """Return the relative error that arguments of modes and events may have for a relative tolerance."""
    return max(tolerance, min(1e3 * tolerance, 1e-6))


def log_part_for(tolerance: float, order: int) -> float:
    """Return the logarithm of the part of the radius of convergence at which the last term is the tolerance.

    At most e^-2 of the radius where it is not above the machine's precision: all terms left out together are
    then a thousandth of what numbers resolve. A little less than that for safety (Jorba and Zou).
    """
    part = -2.0 if tolerance <= EPSILON else max(log(min(tolerance, 0.5)) / order, -2.0)
    return part - _SAFETY / (order - 1)
