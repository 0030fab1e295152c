"""What array statements need around their loops: scratch memory, operands prepared, sweeps over strips."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.random import advance
from desire_tui.engine.codegen.scalar.statements import ScalarStatements
from desire_tui.engine.codegen.vector import products
from desire_tui.engine.codegen.vector.elements import LoopSetup, invariants, lane_states
from desire_tui.engine.codegen.vector.strips import Strip
from desire_tui.engine.lowered.expressions import ElementOperand, MatVec, Outer, PatternRow, ShiftedVec, Vec
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.values import IROW

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.lowered.expressions import Value


class ArrayOperands(ScalarStatements):
    """Scalar statements, and the tools of array statements.

    `temps` says how many doubles of scratch the context's `temps` must hold.
    """

    def __init__(self, text: IrText, cells: Cells, width: int) -> None:
        super().__init__(text, cells)
        self.wide = Lanes(text, width)
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
        """Write a matrix product into scratch memory."""
        name = "tmatvec" if node.transposed else "matvec"
        self.text.declarations.add(
            products.transposed_times_vector() if node.transposed else products.matrix_times_vector()
        )
        result = self.temp(node.cols if node.transposed else node.rows)
        self.text.do(
            f"call void @{name}(ptr {self.at(node.slot)}, ptr {self.at(node.x_slot)}, ptr {result}, "
            f"i64 {node.rows}, i64 {node.cols})"
        )
        return result

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

    def sweep(self, count: int, below: int, above: int, body: Callable[[Strip], None]) -> None:
        """Write a loop over `count` elements; the first `below` and last `above` reach outside operands."""
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
        self.text.declarations.add("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
        arguments = f"ptr {target}, ptr {source}, i64 {8 * count}, i1 false"
        self.text.do(f"call void @llvm.memcpy.p0.p0.i64({arguments})")
