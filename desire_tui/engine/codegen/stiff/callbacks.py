"""CVODE's callbacks as native functions: right-hand side, error weights, Jacobian.

They know the model only through `integration.problem.SolverProblem`, which CVODE passes as user data. An
N_Vector is `{content, ops, context}`, a serial one's content `{int32 length; int32 own_data; double* data}`.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from llvmlite import ir

from desire_tui.engine.codegen.stiff.ir_builder import INT, INT32, POINTER, REAL, VOID, FixedFunction
from desire_tui.engine.integration.problem import FLOOR, Matrix
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Iterator

GO_BACK = 1
"""A callback's result for: try a smaller step."""
GIVE_UP = -1
"""… and for: no step will do."""

_LANES = 8
_DIFFERENCE = 1.4901161193847656e-08  # square root of the machine's epsilon
_LEAST = 1.0
"""A difference is never smaller than this part of the largest value so far would give: with smaller ones
rounding breaks conservation laws, which long steps (Robertson's 1e10) do not forgive."""


def add_callbacks(module: Any) -> None:
    """Add `desire_rhs`, `desire_weights` and `desire_jacobian` for CVODE to a module, and what they call.

    int32 desire_evaluate(Problem*, double t, double* y, double* derivatives)
    int32 desire_weigh(Problem*, double* y, double* weights)
    int32 desire_fill(Problem*, double t, double* y, double* derivatives, double* matrix, double*, double*)
    """
    _add_scatter(module)
    _add_evaluate(module)
    _add_weigh(module)
    _add_fill(module)
    f = FixedFunction(module, "desire_rhs", INT32, [REAL, POINTER, POINTER, POINTER])
    t, y, ydot, problem = f.arguments
    f.build.ret(f.outside("desire_evaluate", INT32, [problem, t, _numbers(f, y), _numbers(f, ydot)]))
    f = FixedFunction(module, "desire_weights", INT32, [POINTER, POINTER, POINTER])
    y, w, problem = f.arguments
    f.build.ret(f.outside("desire_weigh", INT32, [problem, _numbers(f, y), _numbers(f, w)]))
    _add_jacobian(module)


def scatter(f: FixedFunction, problem: Any, y: Any) -> None:
    """Write a state vector to the states' places among the values."""
    f.outside("desire_scatter", VOID, [problem, y])


def _numbers(f: FixedFunction, vector: Any) -> Any:
    """Return the address of a serial N_Vector's numbers."""
    content = f.build.load(vector, typ=POINTER)
    return f.build.load(f.at(content, INT(1), INT), typ=POINTER)


def _add_scatter(module: Any) -> None:
    f = FixedFunction(module, "desire_scatter", VOID, [POINTER, POINTER])
    problem, y = f.arguments
    values, ranges = f.get(problem, "values"), f.get(problem, "ranges")
    with f.loop(INT(0), f.get(problem, "range_count")) as i:
        at = f.build.mul(i, INT(3))
        slot, first, count = (f.load(ranges, f.build.add(at, INT(k)), INT) for k in range(3))
        to, source = f.at(values, slot), f.at(y, first)
        one = f.build.icmp_signed("==", count, INT(1))
        with f.build.if_else(one) as (single, several):
            with single:
                f.build.store(f.build.load(source, typ=REAL), to)
            with several:
                f.copy(to, source, f.build.mul(count, INT(8)))
    f.build.ret_void()


def _add_evaluate(module: Any) -> None:
    """Where a derivative is not finite, name the state `suspect` and ask for a smaller step."""
    f = FixedFunction(module, "desire_evaluate", INT32, [POINTER, REAL, POINTER, POINTER])
    problem, t, y, k = f.arguments
    f.store(f.get(problem, "values"), INT(T), t)
    scatter(f, problem, y)
    f.add(problem, "derivative_calls", INT(1))
    f.call(f.get(problem, "derivatives"), INT, [f.get(problem, "memory"), k])
    n = f.get(problem, "n")
    with f.build.if_then(_all_finite(f, k, n), likely=True):
        f.build.ret(INT32(0))
    with f.loop(INT(0), n) as i:
        term = f.build.fmul(f.load(k, i), REAL(0.0))
        with f.build.if_then(f.build.fcmp_unordered("!=", term, REAL(0.0))):
            f.put(problem, "suspect", i)
    f.build.ret(INT32(GO_BACK))


def _all_finite(f: FixedFunction, k: Any, n: Any) -> Any:
    """Whether n numbers are finite: 0·x is 0 for finite x only. Eight at a time: this follows every call."""
    eight = ir.VectorType(REAL, _LANES)
    total, single = f.build.alloca(eight), f.build.alloca(REAL)
    f.build.store(eight([0.0] * _LANES), total)
    f.build.store(REAL(0.0), single)
    blocks = f.build.sdiv(n, INT(_LANES))
    with f.loop(INT(0), blocks) as i:
        lanes = f.build.load(f.at(k, f.build.mul(i, INT(_LANES))), typ=eight, align=8)
        term = f.build.fmul(lanes, eight([0.0] * _LANES))
        f.build.store(f.build.fadd(f.build.load(total, typ=eight), term), total)
    with f.loop(f.build.mul(blocks, INT(_LANES)), n) as i:
        term = f.build.fmul(f.load(k, i), REAL(0.0))
        f.build.store(f.build.fadd(f.build.load(single, typ=REAL), term), single)
    lanes, sum_ = f.build.load(total, typ=eight), f.build.load(single, typ=REAL)
    for lane in range(_LANES):
        sum_ = f.build.fadd(sum_, f.build.extract_element(lanes, INT32(lane)))
    return f.build.fcmp_ordered("==", sum_, REAL(0.0))


def _add_weigh(module: Any) -> None:
    """1 / (ERMAX·max |y| so far), the maximum taken as 1 while it is 0 (language.md 11)."""
    f = FixedFunction(module, "desire_weigh", INT32, [POINTER, POINTER, POINTER])
    problem, y, w = f.arguments
    largest, tolerance = f.get(problem, "largest"), f.get(problem, "tolerance")
    n, most = f.get(problem, "n"), f.build.alloca(REAL)
    f.build.store(REAL(0.0), most)
    with f.loop(INT(0), n) as i:
        size = f.intrinsic("llvm.maxnum", f.intrinsic("llvm.fabs", f.load(y, i)), f.load(largest, i))
        f.store(largest, i, size)
        f.build.store(f.intrinsic("llvm.maxnum", size, f.build.load(most, typ=REAL)), most)
    f.put(problem, "floor", f.build.fmul(f.build.load(most, typ=REAL), REAL(FLOOR)))
    with f.loop(INT(0), n) as i:
        f.store(w, i, f.build.fdiv(REAL(1.0), f.build.fmul(tolerance, _scale(f, problem, i))))
    f.build.ret(INT32(0))


def _scale(f: FixedFunction, problem: Any, i: Any) -> Any:
    """Return the largest magnitude of state i so far, 1 for 0."""
    size = f.load(f.get(problem, "largest"), i)
    not_less = f.intrinsic("llvm.maxnum", size, f.get(problem, "floor"))
    return f.build.select(f.build.fcmp_ordered("==", size, REAL(0.0)), REAL(1.0), not_less)


def _add_jacobian(module: Any) -> None:
    """CVLsJacFn; CVODE has cleared the matrix."""
    f = FixedFunction(module, "desire_jacobian", INT32, [REAL, *[POINTER] * 7])
    t, y, fy, matrix, problem, spare, spare2, _ = f.arguments
    data = f.call(f.get(problem, "data_of"), POINTER, [matrix])
    with f.build.if_then(f.build.icmp_signed("!=", f.get(problem, "nonzeros"), INT(0))):
        _write_pattern(f, problem, matrix)
    y, fy, spare, spare2 = (_numbers(f, v) for v in (y, fy, spare, spare2))
    f.build.ret(f.outside("desire_fill", INT32, [problem, t, y, fy, data, spare, spare2]))


def _add_fill(module: Any) -> None:
    """Write the Jacobian's entries to their places in a matrix that has been cleared."""
    f = FixedFunction(module, "desire_fill", INT32, [POINTER, REAL, *[POINTER] * 5])
    problem, t, y, fy, data, spare, spare2 = f.arguments
    f.add(problem, "jacobian_calls", INT(1))
    f.store(f.get(problem, "values"), INT(T), t)
    scatter(f, problem, y)
    method = f.get(problem, "method")
    with f.build.if_then(f.build.icmp_signed("==", method, INT(Matrix.TANGENT.value))):
        _fill_by_tangent(f, problem, data, spare)
    with f.build.if_then(f.build.icmp_signed("==", method, INT(Matrix.DIFFERENCES.value))):
        _fill_by_differences(f, problem, data, (y, fy), (spare, spare2))
    with f.build.if_then(f.build.icmp_signed("==", method, INT(Matrix.PROGRAM.value))):
        _fill_by_program(f, problem, data)
    wild = f.build.not_(_finite_entries(f, problem, data))
    own = f.build.icmp_signed("==", method, INT(Matrix.PROGRAM.value))
    f.build.ret(f.build.select(wild, f.build.select(own, INT32(GIVE_UP), INT32(GO_BACK)), INT32(0)))


def _finite_entries(f: FixedFunction, problem: Any, data: Any) -> Any:
    """Whether all is finite: an infinite entry makes corrections 0, which would pass for convergence."""
    total, places = f.build.alloca(REAL), f.get(problem, "places")
    f.build.store(REAL(0.0), total)
    with f.loop(INT(0), f.load(f.get(problem, "entry_starts"), f.get(problem, "colours"), INT32)) as i:
        term = f.build.fmul(f.load(data, f.load(places, i, INT32)), REAL(0.0))
        f.build.store(f.build.fadd(f.build.load(total, typ=REAL), term), total)
    return f.build.fcmp_ordered("==", f.build.load(total, typ=REAL), REAL(0.0))


def _write_pattern(f: FixedFunction, problem: Any, matrix: Any) -> None:
    """Give a sparse matrix its rows and column starts, which SUNMatZero cleared."""
    size = f.build.mul(f.get(problem, "nonzeros"), INT(4))
    f.copy(f.call(f.get(problem, "indices_of"), POINTER, [matrix]), f.get(problem, "row_indices"), size)
    size = f.build.mul(f.build.add(f.get(problem, "n"), INT(1)), INT(4))
    f.copy(f.call(f.get(problem, "starts_of"), POINTER, [matrix]), f.get(problem, "column_starts"), size)


@contextmanager
def _slice(f: FixedFunction, problem: Any, table: str, colour: Any) -> Iterator[Any]:
    """Loop over the positions that belong to a colour."""
    starts = f.get(problem, table)
    stop = f.load(starts, f.build.add(colour, INT(1)), INT32)
    with f.loop(f.load(starts, colour, INT32), stop) as i:
        yield i


def _fill_by_tangent(f: FixedFunction, problem: Any, data: Any, column: Any) -> None:
    seeds, directions = f.get(problem, "seeds"), f.get(problem, "directions")
    rows, places = f.get(problem, "rows"), f.get(problem, "places")
    with f.loop(INT(0), f.get(problem, "colours")) as colour:
        with _slice(f, problem, "seed_starts", colour) as i:
            f.store(directions, f.load(seeds, i, INT32), REAL(1.0))
        f.call(f.get(problem, "tangent"), INT, [f.get(problem, "memory"), column])
        with _slice(f, problem, "seed_starts", colour) as i:
            f.store(directions, f.load(seeds, i, INT32), REAL(0.0))
        with _slice(f, problem, "entry_starts", colour) as i:
            f.store(data, f.load(places, i, INT32), f.load(column, f.load(rows, i, INT32)))


def _fill_by_differences(
    f: FixedFunction, problem: Any, data: Any, base: tuple[Any, Any], spare: tuple[Any, Any]
) -> None:
    """Curtis, Powell and Reid (1974): states that share no row are moved together."""
    (y, fy), (column, moved) = base, spare
    seeds, columns = f.get(problem, "seeds"), f.get(problem, "columns")
    rows, places = f.get(problem, "rows"), f.get(problem, "places")
    change = f.get(problem, "spare")
    f.copy(moved, y, f.build.mul(f.get(problem, "n"), INT(8)))
    with f.loop(INT(0), f.get(problem, "colours")) as colour:
        with _slice(f, problem, "seed_starts", colour) as i:
            state = f.load(seeds, i, INT32)
            least = f.build.fmul(_scale(f, problem, state), REAL(_LEAST))
            size = f.intrinsic("llvm.maxnum", f.intrinsic("llvm.fabs", f.load(y, state)), least)
            to = f.build.fadd(f.load(y, state), f.build.fmul(size, REAL(_DIFFERENCE)))
            f.store(change, state, f.build.fsub(to, f.load(y, state)))
            f.store(moved, state, to)
        scatter(f, problem, moved)
        f.add(problem, "derivative_calls", INT(1))
        f.call(f.get(problem, "derivatives"), INT, [f.get(problem, "memory"), column])
        with _slice(f, problem, "seed_starts", colour) as i:
            state = f.load(seeds, i, INT32)
            f.store(moved, state, f.load(y, state))
        with _slice(f, problem, "entry_starts", colour) as i:
            row = f.load(rows, i, INT32)
            rise = f.build.fsub(f.load(column, row), f.load(fy, row))
            slope = f.build.fdiv(rise, f.load(change, f.load(columns, i, INT32)))
            f.store(data, f.load(places, i, INT32), slope)


def _fill_by_program(f: FixedFunction, problem: Any, data: Any) -> None:
    f.call(f.get(problem, "jacobian"), INT, [f.get(problem, "memory"), data])
    array, sources, places = (f.get(problem, name) for name in ("array", "sources", "places"))
    with _slice(f, problem, "entry_starts", INT(0)) as i:
        f.store(data, f.load(places, i, INT32), f.load(array, f.load(sources, i, INT32)))
