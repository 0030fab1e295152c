"""Arrays' series as wholes: what is read of operands, moved between arrays, summed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.layout import row_length
from desire_tui.engine.digest import blake2b
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.codegen.taylor.frame import Frame


_RUNS_MOST = 64


class Arrays:
    """What `vector` needs besides the recurrences of single elements."""

    def __init__(self, frame: Frame, width: int) -> None:
        self._frame = frame
        self._narrow = Fused(frame.text, width)
        """For sums of elements, whose order must not depend on the array's length."""
        self._lanes = self._narrow

    # ------------------------------------------------------------------ whole arrays

    def _shift(self, node: Series) -> None:
        (given,) = node.operands
        assert isinstance(given, Series)
        text, n, by = self._frame.text, node.size, node.by
        lanes, one = self._lanes, Lanes(self._frame.text)
        target = self._frame.row(node)
        if abs(by) < n:
            source = text.op(f"getelementptr double, ptr {self._frame.row(given)}, i64 {by}")
            loop(text, str(max(-by, 0) // lanes.width * lanes.width), self._end(node), lanes.width,
                 lambda i: put(lanes, target, i, fetch(lanes, source, i)))  # fmt: skip
        gone = min(abs(by), n)
        start = n - gone if by > 0 else 0
        loop(text, str(start), str(start + gone), 1, lambda i: put(one, target, i, literal(0.0)))

    def _gather(self, node: Series) -> None:
        one, target = Lanes(self._frame.text), self._frame.row(node)
        if scattered(node):
            self._gather_by_table(node, target)
            return
        place = 0
        for operand, at, count in runs(node):
            if isinstance(operand, Series) and operand.count is not None:
                to = self._frame.text.op(f"getelementptr double, ptr {target}, i64 {place}")
                row = self._frame.row(operand)
                self._copy(to, self._frame.text.op(f"getelementptr double, ptr {row}, i64 {at}"), str(count))
            else:
                put(one, target, str(place), self._frame.coefficient(operand))
            place += count

    def _gather_by_table(self, node: Series, target: str) -> None:
        """Copy elements from places in tables: text for each of thousands would take LLVM minutes."""
        text, one, layout = self._frame.text, Lanes(self._frame.text), self._frame.layout
        moving = [(o, at) if isinstance(o, Series) else None for o, at in node.lanes]
        places = self._table(layout.place(m[0]) + m[1] if m else layout.zeros for m in moving)
        distances = self._table(layout.apart(m[0]) if m else 0 for m in moving)

        def element(i: str) -> None:
            offset = text.op(f"mul i64 %k, {self._entry(distances, i)}")
            place = text.op(f"add i64 {offset}, {self._entry(places, i)}")
            put(one, target, i, fetch(one, "%c", place))

        loop(text, "0", str(node.size), 1, element)

    def _table(self, numbers: Iterable[int]) -> str:
        """Return the name of a constant array of whole numbers."""
        listed = list(numbers)
        content = ", ".join(f"i64 {number}" for number in listed)
        name = f"@taylor.{blake2b(content.encode(), digest_size=8).hexdigest()}"
        kind = f"[{len(listed)} x i64]"
        self._frame.text.declarations.add(f"{name} = private unnamed_addr constant {kind} [{content}]")
        return name

    def _entry(self, table: str, i: str) -> str:
        at = self._frame.text.op(f"getelementptr i64, ptr {table}, i64 {i}")
        return self._frame.text.op(f"load i64, ptr {at}")

    def _product(self, node: Series) -> None:
        assert node.matrix is not None
        (x,) = node.operands
        assert isinstance(x, Series)
        text = self._frame.text
        slot, rows, columns, transposed = node.matrix
        source, target = self._frame.row(x), self._frame.row(node)
        matrix, one, lanes = self._values(slot, rows * columns), Lanes(text), self._lanes

        def matrix_row(r: str) -> str:
            return text.op(f"getelementptr double, ptr {matrix}, i64 {text.op(f'mul i64 {r}, {columns}')}")

        if not transposed:

            def dot(r: str) -> None:
                row = matrix_row(r)
                put(one, target, r, self._sum(columns, lambda some, i: some.mul(
                    fetch(some, row, i), fetch(some, source, i))))  # fmt: skip

            loop(text, "0", str(rows), 1, dot)
            return
        loop(text, "0", self._end(node), lanes.width, lambda i: put(lanes, target, i, lanes.const(0.0)))

        def add_row(r: str) -> None:
            row, factor = matrix_row(r), fetch(one, source, r)
            main = columns // lanes.width * lanes.width
            for some, begin, end in ((lanes, 0, main), (one, main, columns)):
                wide = some.splat(factor)

                def add(i: str, some: Lanes = some, wide: str = wide) -> None:
                    product = some.mul(fetch(some, row, i), wide)
                    put(some, target, i, some.add(fetch(some, target, i), product))

                loop(text, str(begin), str(end), some.width, add)

        loop(text, "0", str(rows), 1, add_row)

    # ------------------------------------------------------------------ operands

    def _of(self, operand: Series | Constant, i: str) -> str:
        """Return k-th coefficients from element i on."""
        if isinstance(operand, Constant):
            return self._lanes.const(0.0)
        if operand.count is None:
            return self._lanes.splat(self._frame.now[operand.number])
        return fetch(self._lanes, self._frame.row(operand), i)

    def _at_order(self, operand: Series, order: str, i: str) -> str:
        if operand.count is None:
            return self._lanes.splat(self._frame.get(self._frame.layout.place(operand), order))
        return fetch(self._lanes, self._frame.row(operand, order), i)

    def _first(self, operand: Series | Constant, i: str) -> str:
        """Return coefficients 0 from element i on."""
        if isinstance(operand, Constant):
            return self._constant(operand, i)
        if operand.count is None:
            return self._lanes.splat(self._frame.first(operand))
        return fetch(self._lanes, self._frame.at(self._frame.layout.place(operand)), i)

    def _constant(self, constant: Constant, i: str) -> str:
        if constant.count is None:
            return self._lanes.splat(self._frame.first(constant))
        return fetch(self._lanes, self._values(constant.slot, constant.count), i)

    def _sum(self, count: int, element: Callable[[Lanes, str], str]) -> str:
        """Return the sum of some elements: as many partial sums as there are lanes, added in order."""
        text, lanes, one = self._frame.text, self._narrow, Lanes(self._frame.text)
        wide, single = text.alloca(lanes.kind), text.alloca("double")
        text.do(f"store {lanes.kind} {lanes.const(0.0)}, ptr {wide}")
        main = count // lanes.width * lanes.width

        def add(some: Lanes, cell: str, i: str) -> None:
            total = some.add(text.op(f"load {some.kind}, ptr {cell}"), element(some, i))
            text.do(f"store {some.kind} {total}, ptr {cell}")

        loop(text, "0", str(main), lanes.width, lambda i: add(lanes, wide, i))
        parts = text.op(f"load {lanes.kind}, ptr {wide}")
        total = literal(0.0)
        for lane in range(lanes.width):
            total = one.add(total, text.op(f"extractelement {lanes.kind} {parts}, i64 {lane}"))
        text.do(f"store double {total}, ptr {single}")
        loop(text, str(main), str(count), 1, lambda i: add(one, single, i))
        return text.op(f"load double, ptr {single}")

    def _end(self, node: Series) -> str:
        """Return behind which element an array's loops end: whole strips."""
        return str(row_length(node))

    def _length(self, node: Series) -> str:
        """Return how many elements an array has here."""
        return str(node.size)

    def _values(self, slot: int, count: int) -> str:
        """Return the address of an array's values at the step's start."""
        self._frame.loaded.append((slot, count))
        return self._frame.slot(slot)

    def _copy(self, to: str, source: str, count: str) -> None:
        text = self._frame.text
        text.declarations.add("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
        size = text.op(f"mul i64 8, {count}")
        text.do(f"call void @llvm.memcpy.p0.p0.i64(ptr {to}, ptr {source}, i64 {size}, i1 false)")


def runs(node: Series) -> list[tuple[Series | Constant, int, int]]:
    """Return what a gather is made of: operands, the first element taken of each, how many behind it too."""
    found: list[tuple[Series | Constant, int, int]] = []
    for operand, at in node.lanes:
        last = found[-1] if found else None
        if last and operand.count is not None and last[0] is operand and last[1] + last[2] == at:
            found[-1] = operand, last[1], last[2] + 1
        else:
            found.append((operand, at, 1))
    return found


def scattered(node: Series) -> bool:
    """Whether a gather has too many parts for a text of each."""
    return len(runs(node)) > _RUNS_MOST
