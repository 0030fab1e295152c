"""Array statements that read elements they have assigned: one element after the other, the last one first."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.functions import minimum
from desire_tui.engine.codegen.scalar.expressions import ScalarExpressions
from desire_tui.engine.codegen.vector import products
from desire_tui.engine.lowered.expressions import MatVec, Outer, PatternRow, ShiftedVec, Vec
from desire_tui.engine.lowered.statements import SetVec
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.expressions import ElementOperand
    from desire_tui.engine.lowered.statements import SetMat


def write_in_place(statements: ArrayOperands, action: SetVec | SetMat) -> None:
    """Write the statement as a loop from the last element down; nothing read is kept from one to the next."""
    text, lanes = statements.text, statements.lanes
    vector = isinstance(action, SetVec)
    count = action.count if isinstance(action, SetVec) else action.rows * action.cols
    bounds = (None, None) if isinstance(action, SetVec) else (action.lower, action.upper)
    rows = {
        id(node): statements.base(node)
        for node in walk_values(action.value, *bounds)
        if isinstance(node, PatternRow)
    }
    own = statements.at(action.slot)
    mask = None if action.mask_slot is None else statements.at(action.mask_slot)

    def body(step: str) -> None:
        index = text.op(f"sub i64 {count - 1}, {step}")
        element = _Element(statements, index, rows)
        value = element.value(action.value)
        masked = None if mask is None else lanes.compare("une", fetch(lanes, mask, index), lanes.const(0.0))
        if vector and masked is not None:
            value = lanes.choose(masked, lanes.const(0.0), value)
        if action.mode == "add":
            value = lanes.add(fetch(lanes, own, index), value)
        for bound, relation in zip(bounds, ("olt", "ogt"), strict=True):
            if bound is not None:
                limit = element.value(bound)
                value = lanes.choose(lanes.compare(relation, value, limit), limit, value)
        if not vector and masked is not None:
            value = lanes.choose(masked, value, fetch(lanes, own, index))
        put(lanes, own, index, value)

    loop(text, "0", str(count), 1, body)
    if action.mode == "largest":
        text.declarations.add(products.largest())
        copy = statements.temp(count)
        statements.move(own, copy, count)
        text.do(f"call void @largest(ptr {copy}, ptr {own}, i64 {count})")
    statements.cells.forget(action.slot, count)
    statements.free_temps()


class _Element(ScalarExpressions):
    """Values of one element, read from memory where it is evaluated."""

    def __init__(self, statements: ArrayOperands, index: str, rows: dict[int, str]) -> None:
        super().__init__(statements.lanes, statements.cells, "%random")
        self._statements = statements
        self._index = index
        self._rows = rows

    def load(self, slot: int) -> str:
        """Read a scalar; an element of the target may have changed."""
        return self.text.op(f"load double, ptr {self._statements.at(slot)}")

    def operand(self, node: ElementOperand) -> str:
        """Read or compute the element of an operand."""
        at, index, lanes = self._statements.at, self._index, self.lanes
        match node:
            case Vec():
                return fetch(lanes, at(node.slot), index)
            case ShiftedVec():
                moved = self.text.op(f"add i64 {index}, {node.by}")
                inside = self.text.op(f"icmp ult i64 {moved}, {node.count}")
                safe = self.text.op(f"select i1 {inside}, i64 {moved}, i64 0")
                return lanes.choose(inside, fetch(lanes, at(node.slot), safe), lanes.const(0.0))
            case MatVec():
                return self._product(node)
            case PatternRow():
                return fetch(lanes, self._rows[id(node)], index)
            case Outer():
                row = self.text.op(f"udiv i64 {index}, {node.v_count}")
                column = self.text.op(f"urem i64 {index}, {node.v_count}")
                u, v = fetch(lanes, at(node.u_slot), row), fetch(lanes, at(node.v_slot), column)
                return lanes.mul(u, v) if node.op == "mul" else minimum(lanes, u, v)
            case _:
                assert_never(node)

    def _product(self, node: MatVec) -> str:
        text, lanes = self.text, self.lanes
        a, x = self._statements.at(node.slot), self._statements.at(node.x_slot)
        if not node.transposed:
            text.declarations.add(products.dot())
            row = text.op(
                f"getelementptr double, ptr {a}, i64 {text.op(f'mul i64 {self._index}, {node.cols}')}"
            )
            return text.op(f"call double @dot(ptr {row}, ptr {x}, i64 {node.cols})")
        total = text.alloca("double")
        text.do(f"store double {lanes.const(0.0)}, ptr {total}")

        def add(i: str) -> None:
            place = text.op(f"add i64 {text.op(f'mul i64 {i}, {node.cols}')}, {self._index}")
            part = lanes.mul(fetch(lanes, a, place), fetch(lanes, x, i))
            text.do(f"store double {lanes.add(text.op(f'load double, ptr {total}'), part)}, ptr {total}")

        loop(text, "0", str(node.rows), 1, add)
        return text.op(f"load double, ptr {total}")
