"""What array statements need around their loops: scratch memory, operands prepared, sweeps over strips."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self, assert_never

from desire_tui.engine.codegen.ir.cells import MemoryCells
from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.random import advance
from desire_tui.engine.codegen.ir.shared_loops import BLOCK, PRODUCTS, is_large, write_shared
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.scalar.statements import ScalarStatements
from desire_tui.engine.codegen.vector import products
from desire_tui.engine.codegen.vector.elements import LoopSetup, invariants, lane_states
from desire_tui.engine.codegen.vector.strips import Strip, sweep_block
from desire_tui.engine.lowered.expressions import ElementOperand, MatVec, Outer, PatternRow, ShiftedVec, Vec
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.lowered.expressions import Value


class ArrayOperands(ScalarStatements):
    """Scalar statements, and the tools of array statements.

    `temps` says how many doubles of scratch the context's `temps` must hold. `share` gives the address of
    what shares large loops among threads (`ir.shared_loops`).
    """

    def __init__(self, text: IrText, cells: Cells, width: int, share: Callable[[], int]) -> None:
        super().__init__(text, cells)
        self.wide = Lanes(text, width)
        self._share = share
        self.is_block = False
        self.temps = 0
        self._top = 0

    # ------------------------------------------------------------------ memory

    def at(self, slot: int) -> str:
        """Return the address of a slot."""
        return self.text.op(f"getelementptr double, ptr %v, i64 {slot}")

    def temp(self, count: int) -> str:
        """Return scratch memory for an array, free again after the statement."""
        first = self._top
        self._top += -(-count // 8) * 8
        self.temps = max(self.temps, self._top)
        return self.text.op(f"getelementptr double, ptr {self.context.load('temps')}, i64 {first}")

    # ------------------------------------------------------------------ before a loop

    def prepare(self, count: int, per_element: int, *values: Value | None) -> LoopSetup:
        """Write what one statement's loop needs from before it."""
        prepared = LoopSetup()
        for value in values:
            if value is None:
                continue
            for part in invariants(value):
                prepared.splats[id(part)] = self.wide.splat(self.scalars.value(part))
            for node in walk_values(value):
                if isinstance(node, ElementOperand):
                    prepared.bases[id(node)] = self.base(node)
        if per_element:
            start = self.text.op("load i64, ptr %random")
            prepared.per_element = per_element
            prepared.states = self.text.alloca(self.wide.integers)
            states = lane_states(self.wide, start, count, per_element)
            self.text.do(f"store {self.wide.integers} {states}, ptr {prepared.states}")
            after = advance(self.lanes, start, count * per_element)
            self.text.do(f"store i64 {after}, ptr %random")
        return prepared

    def base(self, node: ElementOperand) -> str:
        """Return the address of an operand's first element; products are computed now."""
        match node:
            case MatVec():
                return self.product(node)
            case PatternRow():
                return self._pattern_row(node)
            case Outer():
                return self.at(node.v_slot)
            case Vec() | ShiftedVec():
                return self.at(node.slot)
            case _:
                assert_never(node)

    def product(self, node: MatVec) -> str:
        """Write a matrix product into scratch memory, a large one shared by elements of the result.

        In a block of the statement that it belongs to, it stands there already.
        """
        count, inner = (node.cols, node.rows) if node.transposed else (node.rows, node.cols)
        block = self.block()
        result = self.temp(count)
        if self.is_block:
            return result
        if not is_large(count * inner // PRODUCTS):
            self._part_of_product(node, result, "0", str(count))
        else:
            block._part_of_product(node, block.temp(count), "%first", "%end")  # noqa: SLF001 - of its own kind
            self.share(block, count, max(1, PRODUCTS * BLOCK // inner // products.ROWS) * products.ROWS)
        return result

    def _part_of_product(self, node: MatVec, result: str, first: str, end: str) -> None:
        a, x = self.at(node.slot), self.at(node.x_slot)
        products.write_product(self.text, node, a, x, result, first, end)

    def _pattern_row(self, node: PatternRow) -> str:
        """Return the address of row (trnc(iRow - 1) mod rows); beyond all reason, the first one."""
        op = self.text.op
        number = self.cells.load(IROW)
        sane = self.lanes.compare("olt", self.lanes.intrinsic("fabs", number), self.lanes.const(1e15))
        safe = self.lanes.choose(sane, number, self.lanes.const(1.0))
        zero_based = self.lanes.sub(safe, self.lanes.const(1.0))
        rest = op(f"srem i64 {op(f'fptosi double {zero_based} to i64')}, {node.rows}")
        lifted = op(f"add i64 {rest}, {node.rows}")
        row = op(f"select i1 {op(f'icmp slt i64 {rest}, 0')}, i64 {lifted}, i64 {rest}")
        return op(f"getelementptr double, ptr {self.at(node.slot)}, i64 {op(f'mul i64 {row}, {node.cols}')}")

    # ------------------------------------------------------------------ loops

    def block(self) -> Self:
        """Return what writes the statement at hand for a block of its elements (`ir.shared_loops`).

        It finds scratch memory where this one has it: whatever takes some must do so in the same order.
        """
        text = IrText()
        inner = type(self)(text, MemoryCells(text), self.wide.width, self._share)
        inner.is_block, inner._top = True, self._top  # noqa: SLF001 - of its own kind
        return inner

    def share(self, block: Self, count: int, size: int = BLOCK) -> None:
        """Write the loop over the blocks of `count` elements."""
        write_shared(self.text, self._share(), block.text, "%dx", str(count), size)

    def sweep(self, count: int, below: int, above: int, body: Callable[[Strip], None]) -> None:
        """Write a loop over `count` elements, or a block of them.

        The first `below` and last `above` reach outside operands.
        """
        if self.is_block:
            sweep_block(self.wide, count, below, above, body)
            return
        text, wide = self.text, self.wide
        low, high = min(below, count), max(count - above, 0)
        if low >= high:
            low = high = count
        full_end = low + (high - low) // wide.width * wide.width
        if low:
            loop(text, "0", str(low), 1, lambda i: body(Strip(wide, i, 1, edge=True)))
        if full_end > low:
            loop(text, str(low), str(full_end), wide.width, lambda i: body(Strip(wide, i, wide.width)))
        if high > full_end:
            body(Strip(wide, str(full_end), high - full_end))
        if count > high:
            loop(text, str(high), str(count), 1, lambda i: body(Strip(wide, i, 1, edge=True)))

    def free_temps(self) -> None:
        """Give scratch memory back at a statement's end."""
        self._top = 0

    def move(self, source: str, target: str, count: int) -> None:
        """Copy an array."""
        if not is_large(count):
            _copy(self.text, source, target, str(8 * count))
            return
        text = IrText()
        here, there = (text.op(f"getelementptr double, ptr {base}, i64 %first") for base in ("%v", "%dx"))
        _copy(text, here, there, text.op(f"shl i64 {text.op('sub i64 %end, %first')}, 3"))
        write_shared(self.text, self._share(), text, target, str(count), BLOCK, values=source)


def _copy(text: IrText, source: str, target: str, size: str) -> None:
    text.declarations.add("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
    text.do(f"call void @llvm.memcpy.p0.p0.i64(ptr {target}, ptr {source}, i64 {size}, i1 false)")
