"""LU factors of a dense matrix in place of SUNDIALS': the same bits, columns kept in the cache, on all cores.

SUNDIALS' `SUNDlsMat_denseGETRF` goes through the whole rest of the matrix for each pivot. Here the pivots of
a panel of columns come first, then each column behind it takes all of their updates in turn (blocked
right-looking LU: Golub & Van Loan, Matrix Computations, 4th edition, 3.4). An element has the same products
taken from it in the same order, so that factors, pivots and results are those of SUNDIALS, bit for bit,
whoever takes which column.
"""

from __future__ import annotations

import ctypes
import functools
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir import shared_loops
from desire_tui.engine.codegen.ir.counted_loops import elementwise, fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code, machine, module_text
from desire_tui.engine.digest import blake2b

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.jit.machine_code import MachineCode

_PANEL = 32
"""Columns whose pivots are sought together: of 1,000 states, a panel stays in the second cache."""
_COLUMNS = 4
"""A block of the others."""
LEAST = 64
"""Smaller matrices are factorised by SUNDIALS in some 100 µs."""


def factorise_address(n: int) -> int:
    """Return the address of `int setup(SUNLinearSolver, SUNMatrix)` for n states; 0: leave it to SUNDIALS."""
    if n < LEAST:
        return 0
    code = _native_code()
    if shared_loops.is_large(n * n):
        from desire_tui.engine.codegen.threads.pool import thread_pool  # few models are so large

        ctypes.CFUNCTYPE(None, ctypes.c_void_p)(code.address("dense.connect"))(thread_pool().share)
    return code.address("dense.setup")


@functools.cache
def _native_code() -> MachineCode:
    text = module_text([_setup(), _CONNECT, _SERIAL, _columns_function()], [_SHARE])
    name = f"dense-{blake2b(text.encode(), digest_size=8).hexdigest()}"
    return kept_code(name) or compile_and_keep(text, name, level=2, vectorize=False)


_SHARE = "@dense.share = internal global ptr @dense.serial"
_CONNECT = """define void @dense.connect(ptr %share) #0 {
  store ptr %share, ptr @dense.share
  ret void
}"""
_SERIAL = """define internal void @dense.serial(ptr %f, ptr %a, ptr %p, ptr %job, i64 %count, i64 %_) #0 {
  call void %f(ptr %a, ptr %p, ptr %job, i64 0, i64 %count)
  ret void
}"""
"""`pool.share` for who is alone."""


class _Writer:
    """Writes loops over a matrix whose columns stand at `%columns`, its pivots (int32) at `%pivots`."""

    def __init__(self) -> None:
        self.text = IrText()
        self.one = Lanes(self.text)

    def column(self, number: str) -> str:
        """Return the address of a column."""
        at = self.text.op(f"getelementptr ptr, ptr %columns, i64 {number}")
        return self.text.op(f"load ptr, ptr {at}")

    def pivot(self, number: str) -> str:
        """Return the row that was exchanged with this one."""
        at = self.text.op(f"getelementptr i32, ptr %pivots, i64 {number}")
        return self.text.op(f"sext i32 {self.text.op(f'load i32, ptr {at}')} to i64")

    def when(self, condition: str, body: Callable[[], None]) -> None:
        """Write a body that is skipped where the condition does not hold."""
        stem = self.text.fresh()
        self.text.branch(condition, f"{stem}.yes", f"{stem}.no")
        self.text.begin(f"{stem}.yes")
        body()
        self.text.jump(f"{stem}.no")
        self.text.begin(f"{stem}.no")

    def exchange(self, column: str, row: str, other: str) -> None:
        """Exchange two rows' elements of a column."""
        mine, its = fetch(self.one, column, row), fetch(self.one, column, other)
        put(self.one, column, row, its)
        put(self.one, column, other, mine)

    def update(self, column: str, pivots: str, k: str) -> None:
        """Take column k, times the element in its row, from the rows below."""
        factor = fetch(self.one, column, k)

        def step(lanes: Lanes, i: str) -> None:
            part = lanes.mul(lanes.splat(factor), fetch(lanes, pivots, i))
            put(lanes, column, i, lanes.sub(fetch(lanes, column, i), part))

        below = self.text.op(f"add i64 {k}, 1")
        self.when(
            self.one.compare("une", factor, self.one.const(0.0)),
            lambda: elementwise(self.text, "%n", machine().width, step, below),
        )

    def update_twice(self, column: str, k: str) -> None:
        """Take columns k and k + 1 in one loop: half as often is the column fetched and stored."""
        text, one = self.text, self.one
        following = text.op(f"add i64 {k}, 1")
        first, second = self.column(k), self.column(following)
        a = fetch(one, column, k)
        b = one.sub(fetch(one, column, following), one.mul(a, fetch(one, first, following)))
        both = [one.compare("une", factor, one.const(0.0)) for factor in (a, b)]
        stem = text.fresh()
        text.branch(text.op(f"and i1 {both[0]}, {both[1]}"), f"{stem}.both", f"{stem}.apart")
        text.begin(f"{stem}.both")
        put(one, column, following, b)

        def step(lanes: Lanes, i: str) -> None:
            x = fetch(lanes, column, i)
            for factor, pivots in ((a, first), (b, second)):
                x = lanes.sub(x, lanes.mul(lanes.splat(factor), fetch(lanes, pivots, i)))
            put(lanes, column, i, x)

        elementwise(text, "%n", machine().width, step, text.op(f"add i64 {k}, 2"))
        text.jump(f"{stem}.done")
        text.begin(f"{stem}.apart")
        self.update(column, first, k)
        self.update(column, second, following)
        text.jump(f"{stem}.done")
        text.begin(f"{stem}.done")


def _columns_function() -> str:
    """Return the body of the shared loop: a panel's exchanges in all other columns, its updates behind it."""
    w = _Writer()
    text = w.text
    for place, name in enumerate(("%n", "%panel", "%behind")):
        text.do(f"{name} = load i64, ptr {text.op(f'getelementptr i64, ptr %job, i64 {place}')}")
    width = text.op("sub i64 %behind, %panel")
    odd = text.op(f"and i64 {width}, 1")
    even = text.op(f"sub i64 %behind, {odd}")

    def one_column(number: str) -> None:
        is_behind = text.op(f"icmp sge i64 {number}, %panel")
        j = text.op(f"add i64 {number}, {text.op(f'select i1 {is_behind}, i64 {width}, i64 0')}")
        column = w.column(j)
        # all exchanges first: the panel's columns have taken part in those behind their own
        loop(text, "%panel", "%behind", 1, lambda k: w.exchange(column, k, w.pivot(k)))

        def updates() -> None:
            loop(text, "%panel", even, 2, lambda k: w.update_twice(column, k))
            loop(text, even, "%behind", 1, lambda k: w.update(column, w.column(k), k))

        w.when(is_behind, updates)

    loop(text, "%first", "%end", 1, one_column)
    text.do("ret void")
    parameters = "ptr %columns, ptr %pivots, ptr %job, i64 %first, i64 %end"
    return f"define internal void @dense.columns({parameters}) #0 {{\n{text.body()}\n}}"


def _setup() -> str:
    """Return the linear solver's operation `setup`.

    A SUNMatrix is `{content, …}`, a dense one's content `{int32 rows; int32 columns; double *data; int32
    stride; double **columns}`, the solver's `{int32 n; int32 *pivots; int32 flag}`. The flag is 0, or the
    number of the column that has no pivot, from 1.
    """
    w = _Writer()
    text = w.text
    text.alloca("[3 x i64]", "%job")
    text.do("%content = load ptr, ptr %matrix")
    size = text.op("getelementptr i8, ptr %content, i64 4")
    text.do(f"%n = sext i32 {text.op(f'load i32, ptr {size}')} to i64")
    text.do(f"%columns = load ptr, ptr {text.op('getelementptr i8, ptr %content, i64 24')}")
    text.do("%own = load ptr, ptr %solver")
    text.do(f"%pivots = load ptr, ptr {text.op('getelementptr i8, ptr %own, i64 8')}")
    text.do("%flag = getelementptr i8, ptr %own, i64 16")
    text.do("store i32 0, ptr %flag")
    text.do(f"%is_large = icmp sge i64 {text.op('mul i64 %n, %n')}, {shared_loops.LEAST}")
    loop(text, "0", "%n", _PANEL, lambda panel: _panel(w, panel))
    text.do("ret i32 0")
    text.begin("singular")
    text.do("ret i32 1")
    return f"define i32 @dense.setup(ptr %solver, ptr %matrix) #0 {{\n{text.body()}\n}}"


def _panel(w: _Writer, panel: str) -> None:
    text = w.text
    above = text.op(f"add i64 {panel}, {_PANEL}")
    behind = text.op(f"select i1 {text.op(f'icmp slt i64 {above}, %n')}, i64 {above}, i64 %n")
    loop(text, panel, behind, 1, lambda k: _pivot(w, k, panel, behind))
    for place, value in enumerate(("%n", panel, behind)):
        text.do(f"store i64 {value}, ptr {text.op(f'getelementptr i64, ptr %job, i64 {place}')}")
    share = text.op("load ptr, ptr @dense.share")
    others = text.op(f"sub i64 %n, {text.op(f'sub i64 {behind}, {panel}')}")
    arrays = "ptr @dense.columns, ptr %columns, ptr %pivots, ptr %job"
    block = text.op(f"select i1 %is_large, i64 {_COLUMNS}, i64 %n")
    text.do(f"call void {share}({arrays}, i64 {others}, i64 {block})")


def _pivot(w: _Writer, k: str, panel: str, behind: str) -> None:
    """Find the pivot of column k, exchange rows in the panel's columns, and update those behind k."""
    text, one = w.text, w.one
    column = w.column(k)
    most, where = text.alloca("double"), text.alloca("i64")
    text.do(f"store double {one.intrinsic('fabs', fetch(one, column, k))}, ptr {most}")
    text.do(f"store i64 {k}, ptr {where}")
    below = text.op(f"add i64 {k}, 1")

    def look(i: str) -> None:
        size = one.intrinsic("fabs", fetch(one, column, i))

        def take() -> None:
            text.do(f"store double {size}, ptr {most}")
            text.do(f"store i64 {i}, ptr {where}")

        w.when(one.compare("ogt", size, text.op(f"load double, ptr {most}")), take)

    loop(text, below, "%n", 1, look)
    row = text.op(f"load i64, ptr {where}")
    at = text.op(f"getelementptr i32, ptr %pivots, i64 {k}")
    text.do(f"store i32 {text.op(f'trunc i64 {row} to i32')}, ptr {at}")
    stem = text.fresh()
    zero = one.compare("oeq", fetch(one, column, row), one.const(0.0))
    text.branch(zero, f"{stem}.none", f"{stem}.some")
    text.begin(f"{stem}.none")
    text.do(f"store i32 {text.op(f'trunc i64 {below} to i32')}, ptr %flag")
    text.jump("singular")
    text.begin(f"{stem}.some")
    loop(text, panel, behind, 1, lambda j: w.exchange(w.column(j), k, row))
    factor = one.div(one.const(1.0), fetch(one, column, k))

    def scale(lanes: Lanes, i: str) -> None:
        put(lanes, column, i, lanes.mul(fetch(lanes, column, i), lanes.splat(factor)))

    elementwise(text, "%n", machine().width, scale, below)
    loop(text, below, behind, 1, lambda j: w.update(w.column(j), column, k))
