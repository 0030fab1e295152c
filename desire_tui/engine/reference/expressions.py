"""Expressions as Python closures: over a number, or over all elements of an array at once."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from desire_tui.engine.library import func1, func2
from desire_tui.engine.lowered.expressions import (
    Const,
    Load,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.lowered.walk import operands
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.reference.numbers import ARRAYS, integer_power, scalar_function
from desire_tui.engine.reference.random import ElementDraws, Sequence, normal
from desire_tui.engine.runtime.moments.histories import look_up
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import ElementOperand, Value
    from desire_tui.engine.runtime.moments.memory import Moments
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]
    Thunk = Callable[[], Any]


class ExpressionClosures:
    """Compiles the expressions of one statement; `begin` must be called before each evaluation.

    `count` None: a number; else the number of elements that the statement assigns. An expression object that
    stands at two places is evaluated once (`engine.lowered`).
    """

    def __init__(
        self, values: Values, sequence: Sequence, count: int | None, histories: list[Moments] | None = None
    ) -> None:
        self.values = values
        self.cells, self.data = values.cells, values.data
        self.sequence = sequence
        self.element_draws = None if count is None else ElementDraws(sequence, count)
        self.count = count
        self._histories = [] if histories is None else histories
        self._uses: dict[int, int] = {}
        self._shared: dict[int, Thunk] = {}
        self._arrays: dict[int, bool] = {}
        self._caches: list[list[Any]] = []

    def begin(self) -> None:
        """Forget shared results and draw the random numbers of this evaluation."""
        self.forget()
        if self.element_draws is not None:
            self.element_draws.fill()

    def forget(self) -> None:
        """Forget shared results: what was read has changed."""
        for cache in self._caches:
            cache.clear()

    def compile(self, value: Value) -> Thunk:
        """Return a closure for the whole expression."""
        self._count_uses(value)
        return self._thunk(value)

    @property
    def is_plain(self) -> bool:
        """Whether `begin` has nothing to do."""
        return not self._caches and (self.element_draws is None or self.element_draws.width == 0)

    def _count_uses(self, value: Value) -> None:
        uses = self._uses
        key = id(value)
        uses[key] = uses.get(key, 0) + 1
        if uses[key] > 1:
            return
        for operand in operands(value):
            self._count_uses(operand)

    def _thunk(self, value: Value) -> Thunk:
        if isinstance(value, Const):
            number = value.value
            return lambda: number
        if isinstance(value, Load):
            return partial(self.cells.__getitem__, value.slot)
        known = self._shared.get(id(value))
        if known is not None:
            return known
        built = self._build(value)
        if self._uses.get(id(value), 1) > 1:
            built = self._shared[id(value)] = self._cached(built)
        return built

    def _cached(self, inner: Thunk) -> Thunk:
        cache: list[Any] = []
        self._caches.append(cache)

        def cached() -> Any:
            if not cache:
                cache.append(inner())
            return cache[0]

        return cached

    def _build(self, value: Op | Table1 | Table2 | ElementOperand) -> Thunk:
        data = self.data
        if isinstance(value, Op):
            return self._operation(value)
        if isinstance(value, Vec):
            return partial(data.__getitem__, slice(value.slot, value.slot + value.count))
        if isinstance(value, ShiftedVec):
            return partial(_shifted, data[value.slot : value.slot + value.count], value.by)
        if isinstance(value, MatVec):
            matrix = data[value.slot : value.slot + value.rows * value.cols].reshape(value.rows, value.cols)
            matrix = matrix.T if value.transposed else matrix
            return partial(matrix.dot, data[value.x_slot : value.x_slot + matrix.shape[1]])
        if isinstance(value, PatternRow):
            matrix = data[value.slot : value.slot + value.rows * value.cols].reshape(value.rows, value.cols)
            return partial(_row, matrix, self.cells)
        if isinstance(value, Outer):
            u = data[value.u_slot : value.u_slot + value.u_count]
            v = data[value.v_slot : value.v_slot + value.v_count]
            outer = np.multiply.outer if value.op == "mul" else np.minimum.outer
            return lambda: outer(u, v).ravel()
        if isinstance(value, Table1):
            return self._table1(value)
        if isinstance(value, Table2):
            return self._table2(value)
        assert_never(value)

    def _operation(self, value: Op) -> Thunk:
        name = value.name
        if name in DRAWS:
            return self._random(name)
        if name == "ipow":
            base, exponent = self._thunk(value.args[0]), value.args[1]
            assert isinstance(exponent, Const)
            n = int(exponent.value)
            if n == 2:
                square = base
                return lambda: (x := square()) * x
            return lambda: integer_power(base(), n)
        args = [self._thunk(argument) for argument in value.args]
        if name == "delayed":
            return self._delayed(value, args)
        function: Callable[..., Any] = (
            ARRAYS[name] if any(self._is_array(a) for a in value.args) else scalar_function(name)
        )
        if len(args) == 1:
            (only,) = args
            return lambda: function(only())
        if len(args) == 2:
            a, b = args
            if name == "add":
                return lambda: a() + b()
            if name == "sub":
                return lambda: a() - b()
            if name == "mul":
                return lambda: a() * b()
            return lambda: function(a(), b())
        return lambda: function(*[argument() for argument in args])

    def _delayed(self, value: Op, args: list[Thunk]) -> Thunk:
        number, histories = value.args[0], self._histories
        assert isinstance(number, Const)
        j, time = int(number.value), args[1]
        if len(args) == 2:
            return lambda: look_up(histories[0], j, time(), 0, 0.0)
        before = args[2]
        return lambda: look_up(histories[0], j, time(), 1, before())

    def _is_array(self, value: Value) -> bool:
        """Whether a value has one number for each element (random draws do, within an array statement)."""
        known = self._arrays.get(id(value))
        if known is None:
            known = self._arrays[id(value)] = self._has_elements(value)
        return known

    def _has_elements(self, value: Value) -> bool:
        match value:
            case Const() | Load():
                return False
            case Op():
                if value.name in DRAWS:
                    return self.count is not None
                return any(self._is_array(argument) for argument in value.args)
            case Table1():
                return self._is_array(value.x)
            case Table2():
                return self._is_array(value.x) or self._is_array(value.y)
            case Vec() | ShiftedVec() | MatVec() | PatternRow() | Outer():
                return True
            case _:
                assert_never(value)

    def _random(self, name: str) -> Thunk:
        uniform = self.sequence.uniform
        if self.element_draws is None:
            if name == "ran":
                return lambda: 2.0 * uniform() - 1.0
            return lambda: normal(uniform(), uniform())
        element_draws = self.element_draws
        if name == "ran":
            return partial(element_draws.uniform, element_draws.reserve(1))
        return partial(element_draws.normal, element_draws.reserve(2))

    def _table1(self, value: Table1) -> Thunk:
        x = self._thunk(value.x)
        table = self.cells[value.slot : value.slot + 2 * value.count]
        if self._is_array(value.x):
            return lambda: np.array([func1(float(one), table) for one in x()])
        return lambda: func1(x(), table)

    def _table2(self, value: Table2) -> Thunk:
        x, y = self._thunk(value.x), self._thunk(value.y)
        f = self.cells[value.f_slot : value.f_slot + value.rows * value.cols]
        xs = self.cells[value.x_slot : value.x_slot + value.rows]
        ys = self.cells[value.y_slot : value.y_slot + value.cols]
        if self._is_array(value.x) or self._is_array(value.y):
            return lambda: np.array(
                [
                    func2(float(a), float(b), f, xs, ys)
                    for a, b in zip(*np.broadcast_arrays(x(), y()), strict=True)
                ]
            )
        return lambda: func2(x(), y(), f, xs, ys)


def _shifted(x: Array, by: int) -> Array:
    result = np.zeros(len(x))
    if by >= 0:
        result[: max(len(x) - by, 0)] = x[by:]
    elif -by < len(x):
        result[-by:] = x[:by]
    return result


def _row(matrix: Array, cells: memoryview[float]) -> Array:
    row = cells[IROW]
    number = int(row - 1.0) % len(matrix) if abs(row) < 1e15 else 0
    return np.asarray(matrix[number])
