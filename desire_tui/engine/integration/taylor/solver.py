"""The solver's memory as an object, as `bdf.solver` is of that solver's."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from desire_tui.engine.integration.sundials.solver import Counts
from desire_tui.engine.integration.taylor import step
from desire_tui.engine.integration.taylor.memory import (
    Arrays,
    Taylor,
    argument_error_for,
    log_part_for,
    order_for,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_REALS, _INTS = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64)


class Layout(Protocol):
    """Where coefficients stand: `pieces` as `memory.Taylor` wants them, `room` numbers in all."""

    room: int

    @property
    def pieces(self) -> Sequence[tuple[int, int, int, int]]:
        """(first state, count, place, distance)."""
        ...

    @property
    def arguments(self) -> Sequence[tuple[int, int]]:
        """(place, distance) of each argument of modes and events, (-1, 0) of one that does not move."""
        ...

    @property
    def roots(self) -> Sequence[tuple[int, int, int]]:
        """(place, distance, count) of square roots."""
        ...

    @property
    def mode_count(self) -> int:
        """So many of these are modes'."""
        ...


class TaylorSolver:
    """For `n` states at `states` (an address).

    Native
    code that is given `memory` makes the steps itself; `connect`, `restart` and `step` are for the reference
    back end, which runs the same text as Python.
    """

    vector = between = 0

    def __init__(self, n: int, states: int, problem: int, between: int, layout: Layout) -> None:
        pieces, room = layout.pieces, layout.room
        self._between = ctypes.cast(between, _REALS)
        self.taylor = taylor = Taylor()
        self._arrays = arrays = Arrays(n, room)
        self._pieces = np.array(pieces, dtype=np.int64).reshape(-1)
        taylor.problem, taylor.n = problem, n
        taylor.y = ctypes.cast(states, _REALS)
        for name, row in zip(("rest", "base", "base_rest", "largest"), arrays.reals, strict=True):
            setattr(taylor, name, ctypes.cast(row.ctypes.data, _REALS))
        taylor.coefficients = ctypes.cast(arrays.coefficients.ctypes.data, _REALS)
        taylor.pieces, taylor.piece_count = ctypes.cast(self._pieces.ctypes.data, _INTS), len(pieces)
        self._arguments = np.array([*layout.arguments, (-1, 0)], dtype=np.int64).reshape(-1)
        taylor.arguments = ctypes.cast(self._arguments.ctypes.data, _INTS)
        taylor.argument_count, taylor.argument_total = layout.mode_count, len(layout.arguments)
        self._roots = np.array([*layout.roots, (0, 0, 0)], dtype=np.int64).reshape(-1)
        taylor.roots, taylor.root_count = ctypes.cast(self._roots.ctypes.data, _INTS), len(layout.roots)
        for name, row in zip(("work", "part", "turned"), arrays.polynomials, strict=True):
            setattr(taylor, name, ctypes.cast(row.ctypes.data, _REALS))
        taylor.halves = ctypes.cast(arrays.halves.ctypes.data, _INTS)
        taylor.block_count = arrays.block_count
        taylor.found = ctypes.cast(arrays.found.ctypes.data, _REALS)
        taylor.found_states = ctypes.cast(arrays.found_states.ctypes.data, _INTS)
        self.memory = taylor.itself = ctypes.addressof(taylor)

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """All coefficients of the last step, as `pieces` say."""
        return self._arrays.coefficients

    def begin(self, tolerance: float, absolute: float, largest: float) -> None:
        """Prepare a run: relative tolerance, absolute one, the largest step (0: none)."""
        taylor = self.taylor
        taylor.order = order_for(tolerance)
        taylor.per_order, taylor.per_order_before = 1.0 / taylor.order, 1.0 / (taylor.order - 1)
        taylor.argument_error = argument_error_for(tolerance)
        taylor.log_part = log_part_for(tolerance, taylor.order)
        taylor.absolute = absolute / tolerance if tolerance > 0.0 else 0.0
        taylor.h_most = max(largest, 0.0)
        taylor.steps = 0
        taylor.most = 0.0
        self._arrays.reals[:] = 0.0

    def connect(self, expand: Any) -> None:
        """Set the callback (`memory.Expand`)."""
        self.taylor.expand = self._kept = expand

    def restart(self, t: float, first_step: float) -> None:  # noqa: ARG002 - it needs no guess
        """Begin anew from the states at `states`."""
        step.restart(self.taylor, t)

    def step(self, t_stop: float) -> tuple[int, float]:
        """Take one step, never beyond `t_stop`; return the flag (< 0: failed) and the time reached."""
        flag = step.advance(self.taylor, t_stop)
        return flag, self.taylor.t

    def interpolate(self, t: float) -> None:
        """Write the states at a time inside the last step to `between`."""
        step.put_inside(self.taylor, t, self._between)

    @property
    def last_step(self) -> float:
        """Size of the last step taken."""
        return float(self.taylor.h_last)

    def counts(self) -> Counts:
        """Return what was done since the run began."""
        return Counts(self.taylor.steps, 0, self.taylor.order)

    def worst_state(self) -> int:
        """Return the number of the state that a failure is about."""
        return int(self.taylor.worst)
