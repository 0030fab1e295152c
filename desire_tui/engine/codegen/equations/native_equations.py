"""A segment's right-hand side and Jacobian as native functions of t and x."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.equations.routines import equation_functions
from desire_tui.engine.codegen.jit.compiler import compile_text, module_text
from desire_tui.engine.codegen.pieces.pass_functions import PassFunctions
from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import jacobian_tables
from desire_tui.engine.integration.problem import Matrix, SolverProblem
from desire_tui.engine.lowered.jacobian_array import checked_array
from desire_tui.engine.lowered.state_ranges import state_ranges
from desire_tui.engine.passes.differentiate import differentiate
from desire_tui.engine.passes.slices import derivative_slice, jacobian_pass
from desire_tui.engine.passes.sparsity import sparsity_pattern
from desire_tui.engine.passes.state_equations import state_equations
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.runtime.run_memory import RunMemory

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.codegen.jit.background import Improver
    from desire_tui.engine.codegen.jit.cache import CodeCache
    from desire_tui.engine.integration.plan import JacobianTables
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values

    Floats = NDArray[np.float64]

_AT_PLACE = ctypes.CFUNCTYPE(
    ctypes.c_int32, ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p
)
_AT_PLACES = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_int64, *[ctypes.c_void_p] * 3)
_DENSE_MOST = 46_340
"""States of a dense matrix whose places are numbers of 32 bits: it takes 17 GB."""


class NativeEquations:
    """Implements `runtime.equations.Equations`. DesireError 491: see `passes.state_equations`."""

    def __init__(self, code: CodeCache, improver: Improver, segment: Segment, values: Values) -> None:
        equations = state_equations(segment, values.room)
        self.n = n = equations.order
        self.pattern = Pattern.of(n, *sparsity_pattern(equations))
        passes = {"derivative": derivative_slice(equations)}
        self._problem = problem = SolverProblem()
        method = Matrix.DIFFERENCES
        try:
            tangent = differentiate(equations, values.room)
        except NotDifferentiable:
            if equations.jacobian is not None:
                method, passes["jacobian"] = Matrix.PROGRAM, jacobian_pass(equations, n)
                problem.array = values.address + 8 * checked_array(equations, values)
        else:
            method, passes["tangent"] = Matrix.TANGENT, tangent.body
            problem.directions = values.address + 8 * tangent.directions
        functions = PassFunctions(code, values, n, passes, frozenset({"jacobian"}))
        self._memory = RunMemory(values=values.address, random=values.random.ctypes.data)
        problem.memory, problem.values = ctypes.addressof(self._memory), values.address
        problem.derivatives = functions.address("derivative")
        for name in passes.keys() - {"derivative"}:
            setattr(problem, name, functions.address(name))
        ranges = np.array(state_ranges(equations.states), dtype=np.int64)
        problem.n, problem.range_count, problem.ranges = n, len(ranges), ranges.ctypes.data
        room = np.zeros((5, n))
        problem.last, problem.base, problem.moved, problem.largest, problem.spare = (
            row.ctypes.data for row in room
        )
        problem.method = method
        sparse = SolverProblem.from_buffer_copy(problem)
        tables = [_give(sparse, self.pattern, np.arange(self.pattern.count), self.pattern.count, method)]
        if n <= _DENSE_MOST:
            places = self.pattern.rows.astype(np.int64) * n + self.pattern.columns
            tables.append(_give(problem, self.pattern, places, n * n, method))
        self._natives = natives = equation_functions()
        self._right_hand_side = _AT_PLACE(natives.right_hand_side)
        self._right_hand_sides = _AT_PLACES(natives.right_hand_sides)
        self._jacobian = _AT_PLACE(natives.jacobian)
        self._at, self._sparse = ctypes.addressof(problem), ctypes.addressof(sparse)
        self._x, self._derivatives = np.zeros(n), np.zeros(n)
        self._places = self._x.ctypes.data, self._derivatives.ctypes.data
        self._kept = (functions, ranges, room, sparse, tables, values)
        self._entries: tuple[int, int] | None = None
        improver.add_now(functions)  # whoever calls these calls them often

    @property
    def addresses(self) -> tuple[int, int]:
        """`int32 f(double t, const double *x, double *result, void *)`; a matrix is row after row."""
        if self._entries is None:
            natives, at = self._natives, self._at
            called = {"rhs": natives.right_hand_side, "jacobian": natives.jacobian}
            text = module_text([_entry(name, function, at) for name, function in called.items()], ())
            self._code = code = compile_text(text, level=1)
            self._entries = code.address("rhs"), code.address("jacobian")
        return self._entries

    def derivatives(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`."""
        self._x[:] = x
        self._right_hand_side(self._at, t, *self._places)
        return self._derivatives.copy()

    def many(self, times: Floats, states: Floats) -> Floats:
        """See `runtime.equations`."""
        found = np.empty_like(states)
        self._right_hand_sides(self._at, len(times), times.ctypes.data, states.ctypes.data, found.ctypes.data)
        return found

    def jacobian(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`. MemoryError: it is too large."""
        if self.n > _DENSE_MOST:
            raise MemoryError
        found = np.empty((self.n, self.n))
        self._x[:] = x
        self._jacobian(self._at, t, self._places[0], found.ctypes.data)
        return found

    def jacobians(self, times: Floats, states: Floats) -> Floats:
        """See `runtime.equations`. MemoryError: one of them is too large."""
        if self.n > _DENSE_MOST:
            raise MemoryError
        found = np.empty((len(times), self.n, self.n))
        at, x, result = self._at, states.ctypes.data, found.ctypes.data
        width, size = 8 * self.n, 8 * self.n * self.n
        for k, t in enumerate(times.tolist()):
            self._jacobian(at, t, x + k * width, result + k * size)
        return found

    def entries(self, t: float, x: Floats) -> Floats:
        """See `runtime.equations`."""
        found = np.empty(self.pattern.count)
        self._x[:] = x
        self._jacobian(self._sparse, t, self._places[0], found.ctypes.data)
        return found


def _give(
    problem: SolverProblem, pattern: Pattern, places: NDArray[np.int64], size: int, method: Matrix
) -> JacobianTables:
    """Give a problem the tables of its matrix of `size` numbers; return what keeps them alive."""
    tables = jacobian_tables(pattern, places.astype(np.int32), method)
    tables.give(problem)
    problem.nonzeros = size
    return tables


def _entry(name: str, function: int, problem: int) -> str:
    return f"""
define i32 @{name}(double %t, ptr %x, ptr %result, ptr %unused) #0 {{
  %f = inttoptr i64 {function} to ptr
  %p = inttoptr i64 {problem} to ptr
  %r = call i32 %f(ptr %p, double %t, ptr %x, ptr %result)
  ret i32 %r
}}"""
