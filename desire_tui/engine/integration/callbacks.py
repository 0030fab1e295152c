"""CVODE's callbacks in Python, for the reference back end and for tests.

They do what `codegen.stiff`'s `model_calls` and `jacobian_fill` do natively, to the same `SolverProblem`,
with the same formulas.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Protocol

import numpy as np

from desire_tui.engine.integration.bdf.memory import Evaluate, Fill, Weigh
from desire_tui.engine.integration.memory_views import pointed_at, reals
from desire_tui.engine.integration.problem import FLOOR, Matrix
from desire_tui.engine.integration.sundials.library import libraries
from desire_tui.engine.integration.sundials.signatures import JacobianFunction, RhsFunction, WeightFunction
from desire_tui.engine.integration.system import Natives
from desire_tui.engine.integration.taylor.memory import Expand

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.system import StiffSystem

    Array = NDArray[np.float64]

DIFFERENCE = 2.0**-26
"""Square root of the machine's epsilon."""
LEAST = 1.0
"""A difference is at least as large as this part of the largest value so far would give (see `codegen`)."""

_GO_BACK, _GIVE_UP = 1, -1


class PythonModel(Protocol):
    """What the callbacks ask of a model; arrays have n elements."""

    def derivatives(self, t: float, y: Array, out: Array) -> None:
        """Write the derivatives to `out`."""

    def expand(self, t: float, y: Array) -> None:
        """Compute the Taylor coefficients at t from the states y (rule 17)."""

    def tangent(self, t: float, y: Array, direction: Array, out: Array) -> None:
        """Write J·direction to `out`."""

    def jacobian(self, t: float, y: Array) -> Array:
        """Return the JACOBIAN segment's array, flat, row after row."""
        ...


class PythonCallbacks:
    """Function objects and their addresses. A model's exception is kept in `failure`; CVODE gives up."""

    def __init__(self, model: PythonModel) -> None:
        self._model = model
        self.system: StiffSystem | None = None
        self.failure: BaseException | None = None
        self._functions = (
            RhsFunction(self._rhs), WeightFunction(self._weights), JacobianFunction(self._jacobian)
        )  # fmt: skip
        rhs, weights, jacobian = (ctypes.cast(f, ctypes.c_void_p).value or 0 for f in self._functions)
        self.natives = Natives(rhs, weights, jacobian)
        self.own = (
            Evaluate(lambda _, t, y, out: self._derive(t, self._states(y), self._states(out))),
            Weigh(lambda _, y, out: self._weigh(self._states(y), self._states(out))),
            Fill(lambda _, t, y, fy, matrix, *_spare: self._fill(
                t, self._states(y), self._states(fy), pointed_at(matrix, self._n**2)
            )),
        )  # fmt: skip
        """For `bdf` in place of CVODE."""
        self.expand = Expand(lambda _, t, y: self._expand(t, self._states(y)))
        """For `taylor`."""

    def _expand(self, t: float, y: Array) -> int:
        assert self.system is not None
        self.system.problem.derivative_calls += 1
        try:
            self._model.expand(t, y)
        except BaseException as failure:  # noqa: BLE001 - ctypes would only print it
            self.failure = failure
            return _GIVE_UP
        return 0

    def _rhs(self, t: float, y: int, ydot: int, _user: int) -> int:
        return self._derive(t, numbers(y), numbers(ydot))

    def _derive(self, t: float, y: Array, out: Array) -> int:
        if not self._evaluate(t, y, out):
            return _GIVE_UP
        finite = np.isfinite(out)
        if finite.all():
            return 0
        assert self.system is not None
        self.system.problem.suspect = int(np.argmin(finite))
        return _GO_BACK

    def _evaluate(self, t: float, y: Array, out: Array) -> bool:
        assert self.system is not None
        self.system.problem.derivative_calls += 1
        try:
            self._model.derivatives(t, y, out)
        except BaseException as failure:  # noqa: BLE001 - nothing may pass through CVODE's frames
            self.failure = failure
            return False
        return True

    def _weights(self, y: int, weights: int, _user: int) -> int:
        return self._weigh(numbers(y), numbers(weights))

    def _weigh(self, y: Array, weights: Array) -> int:
        assert self.system is not None
        system = self.system
        np.maximum(system.largest, np.abs(y), out=system.largest)
        system.problem.floor = FLOOR * float(system.largest.max(initial=0.0))
        problem = system.problem
        weights[:] = 1.0 / np.maximum(problem.tolerance * _scale(system) + problem.absolute, system.noise)
        return 0

    def _jacobian(self, t: float, y: int, fy: int, matrix: int, _user: int, *_spare: int) -> int:
        assert self.system is not None
        return self._fill(t, numbers(y), numbers(fy), self._matrix_data(self.system, matrix))

    def _fill(self, t: float, y: Array, fy: Array, data: Array) -> int:
        system = self.system
        assert system is not None
        system.problem.jacobian_calls += 1
        method = system.plan.method
        try:
            if method is Matrix.PROGRAM:
                tables = system.plan.tables
                assert tables is not None
                data[tables.places] = self._model.jacobian(t, y)[tables.sources]
            elif method is Matrix.TANGENT:
                self._fill_by_tangent(t, y, data)
            elif not self._fill_by_differences(t, y, fy, data):
                return _GIVE_UP
        except BaseException as failure:  # noqa: BLE001 - as above
            self.failure = failure
            return _GIVE_UP
        assert system.plan.tables is not None
        if not np.isfinite(data[system.plan.tables.places]).all():  # corrections of 0 are not convergence
            return _GIVE_UP if method is Matrix.PROGRAM else _GO_BACK
        return 0

    @property
    def _n(self) -> int:
        assert self.system is not None
        return self.system.n

    def _states(self, place: Reals) -> Array:
        return pointed_at(place, self._n)

    def _fill_by_tangent(self, t: float, y: Array, data: Array) -> None:
        system = self.system
        assert system is not None
        tables = system.plan.tables
        assert tables is not None
        column = np.zeros(system.n)
        for colour in range(len(tables.seed_starts) - 1):
            direction = np.zeros(system.n)
            direction[tables.seeds[slice(*tables.seed_starts[colour : colour + 2])]] = 1.0
            self._model.tangent(t, y, direction, column)
            entries = slice(*tables.entry_starts[colour : colour + 2])
            data[tables.places[entries]] = column[tables.rows[entries]]

    def _fill_by_differences(self, t: float, y: Array, fy: Array, data: Array) -> bool:
        system = self.system
        assert system is not None
        tables = system.plan.tables
        assert tables is not None
        size = np.maximum(np.abs(y), LEAST * _scale(system))
        change = (y + DIFFERENCE * size) - y
        column = np.zeros(system.n)
        for colour in range(len(tables.seed_starts) - 1):
            seeds = tables.seeds[slice(*tables.seed_starts[colour : colour + 2])]
            moved = y.copy()
            moved[seeds] = y[seeds] + change[seeds]
            if not self._evaluate(t, moved, column):
                return False
            entries = slice(*tables.entry_starts[colour : colour + 2])
            rows = tables.rows[entries]
            data[tables.places[entries]] = (column[rows] - fy[rows]) / change[tables.columns[entries]]
        return True

    @staticmethod
    def _matrix_data(system: StiffSystem, matrix: int) -> Array:
        """View a matrix' numbers; write a sparse one's pattern, which CVODE has cleared."""
        library, linear, tables = libraries().cvode, system.plan.linear, system.plan.tables
        assert tables is not None
        if linear.kind == "dense":
            return reals(library.SUNDenseMatrix_Data(matrix), system.n**2)
        if linear.kind == "band":
            return reals(library.SUNBandMatrix_Data(matrix), system.n * library.SUNBandMatrix_LDim(matrix))
        ctypes.memmove(library.SUNSparseMatrix_IndexValues(matrix), tables.row_indices.ctypes.data,
                       tables.row_indices.nbytes)  # fmt: skip
        ctypes.memmove(library.SUNSparseMatrix_IndexPointers(matrix), tables.column_starts.ctypes.data,
                       tables.column_starts.nbytes)  # fmt: skip
        return reals(library.SUNSparseMatrix_Data(matrix), linear.nonzeros)


def numbers(vector: int) -> Array:
    """View the numbers of a serial N_Vector: `{content, …}`, `{int32 length; int32 own; double* data}`."""
    content = ctypes.c_uint64.from_address(vector).value
    length = ctypes.c_int32.from_address(content).value
    return reals(ctypes.c_uint64.from_address(content + 8).value, length)


def _scale(system: StiffSystem) -> Array:
    """Return each state's largest magnitude so far, 1 for 0."""
    largest = system.largest
    return np.where(largest == 0.0, 1.0, np.maximum(largest, system.problem.floor))
