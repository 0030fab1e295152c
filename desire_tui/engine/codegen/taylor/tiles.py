"""Recurrences of long arrays tile by tile: all orders of some elements while they are in the cache.

Threads share the tiles. What a tile computes does not depend on who does it, nor do tiles read each other's
coefficients (`tile_layout`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.shared_loops import write_shared
from desire_tui.engine.codegen.ir.text import IrText, literal
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.frame import Frame
from desire_tui.engine.codegen.taylor.tile_layout import TileLayout
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.codegen.threads.pool import thread_pool
from desire_tui.engine.passes.series.nodes import Series

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.codegen.taylor.layout import Layout
    from desire_tui.engine.passes.series.nodes import SeriesProgram


class Tile(VectorRecurrences):
    """Writes the function for a tile: elements %first … %end - 1 of all arrays, %m with the margins.

    Its arguments are the values, the coefficients, and the address of the order.
    """

    def __init__(self, program: SeriesProgram, layout: Layout) -> None:
        self.layout, self._all = TileLayout(program), layout
        self.text = IrText()
        self.frame = Frame(self.text, self.layout, "%s")
        super().__init__(self.frame, machine().width)
        self._program, self._count = program, 0
        operands = [o for node in program.nodes if node.count is not None for o in node.operands]
        self._numbers = {o.number: o for o in operands if isinstance(o, Series) and o.count is None}

    @property
    def numbers(self) -> Iterable[int]:
        """Numbers whose coefficients arrays are made of."""
        return self._numbers

    def share(self, outer: IrText) -> None:
        """Write the loop over all tiles behind the function's text."""
        outer.do("%order = alloca i64")
        outer.do("store i64 %p, ptr %order")
        write_shared(outer, thread_pool().share, self.text, "%order", str(self._count), self.layout.elements)

    def begin(self, count: int) -> None:
        """Write what comes first: memory, the margins, where values begin."""
        text = self.text
        text.declarations.add("declare ptr @malloc(i64)")
        text.declarations.add("declare void @free(ptr)")
        self._count = count
        text.do("%p = load i64, ptr %dx")
        margin = text.op(f"mul i64 %p, {self.layout.reach}")
        text.do(f"%from = {_larger(text, text.op(f'sub i64 %first, {margin}'), '0')}")
        text.do(f"%to = {_smaller(text, text.op(f'add i64 %end, {margin}'), str(count))}")
        text.do("%m = sub i64 %to, %from")
        text.do("%here = getelementptr double, ptr %v, i64 %from")
        text.do(f"%s = call ptr @malloc(i64 {8 * self.layout.room})")
        for number, node in self._numbers.items():
            first = text.op(f"load double, ptr {self._at_number(node, '0')}")
            self._frame.take_first(self._numbers[number], first)

    def finish(self) -> None:
        """Write what comes last: states' coefficients go where the solver reads them."""
        text = self.text
        text.do("%skipped = sub i64 %first, %from")
        text.do("%own = sub i64 %end, %first")

        def order(k: str) -> None:
            for piece in self._program.states:
                if piece.series.count is None:
                    continue
                inner = text.op(f"getelementptr double, ptr {self._frame.row(piece.series, k)}, i64 %skipped")
                offset = text.op(f"mul i64 {k}, {self._all.apart(piece.series)}")
                place = text.op(f"add i64 {offset}, {self._all.place(piece.series)}")
                row = text.op(f"getelementptr double, ptr %c, i64 {place}")
                self._copy(text.op(f"getelementptr double, ptr {row}, i64 %first"), inner, "%own")

        loop(text, "1", text.op("add i64 %p, 1"), 1, order)
        text.do("call void @free(ptr %s)")

    # ------------------------------------------------------------------ what is not as in whole arrays

    def turn(self) -> None:
        """Read the numbers' coefficients."""
        for number, node in self._numbers.items():
            self._frame.now[number] = self.text.op(f"load double, ptr {self._at_number(node, '%k')}")

    def _at_number(self, node: Series, order: str) -> str:
        row = self.text.op(f"getelementptr double, ptr %c, i64 {self._all.place(node)}")
        return self.text.op(f"getelementptr double, ptr {row}, i64 {order}")

    def _at_order(self, operand: Series, order: str, i: str) -> str:
        if operand.count is None:
            return self._lanes.splat(self.text.op(f"load double, ptr {self._at_number(operand, order)}"))
        return super()._at_order(operand, order, i)

    def _end(self, node: Series) -> str:  # noqa: ARG002 - all have the same
        return "%m"

    def _length(self, node: Series) -> str:  # noqa: ARG002 - all have the same
        return "%m"

    def _values(self, slot: int, count: int) -> str:
        self.frame.loaded.append((slot, count))
        return self.text.op(f"getelementptr double, ptr %here, i64 {slot}")

    def _shift(self, node: Series) -> None:
        """Move a row; what would come from beyond the tile is 0, as it is at the arrays' ends."""
        (given,) = node.operands
        assert isinstance(given, Series)
        text, lanes, one, by = self.text, self._lanes, Lanes(self.text), node.by
        target = self._frame.row(node)
        source = text.op(f"getelementptr double, ptr {self._frame.row(given)}, i64 {by}")
        start = max(-by, 0) // lanes.width * lanes.width
        loop(text, str(start), "%m", lanes.width, lambda i: put(lanes, target, i, fetch(lanes, source, i)))
        gone = text.op(_smaller(text, str(abs(by)), "%m"))
        first = text.op(f"sub i64 %m, {gone}") if by > 0 else "0"
        end = "%m" if by > 0 else gone
        loop(text, first, end, 1, lambda i: put(one, target, i, literal(0.0)))


def _smaller(text: IrText, a: str, b: str) -> str:
    return f"select i1 {text.op(f'icmp slt i64 {a}, {b}')}, i64 {a}, i64 {b}"


def _larger(text: IrText, a: str, b: str) -> str:
    return f"select i1 {text.op(f'icmp sgt i64 {a}, {b}')}, i64 {a}, i64 {b}"
