"""Matrix statements and sums of products."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.ir.shared_loops import BLOCK, blocks, is_large
from desire_tui.engine.codegen.vector import products
from desire_tui.engine.codegen.vector.elements import StripExpressions, is_separable
from desire_tui.engine.codegen.vector.fusion import needs_copy, value_footprint
from desire_tui.engine.codegen.vector.strips import Strip
from desire_tui.engine.lowered.effects import count_draws
from desire_tui.engine.lowered.expressions import Outer
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.statements import DotTerm, SetDot, SetMat


def write_matrix(statements: ArrayOperands, action: SetMat) -> None:
    """Write `MATRIX W = …` or `DELTA W = …`; threads share a large one, by rows for u & v."""
    count = action.rows * action.cols
    is_shared = is_large(count) and is_separable(action.value, action.lower, action.upper)
    by_rows = any(isinstance(n, Outer) for n in walk_values(action.value))
    block = statements.block() if is_shared else statements
    write = _write_rows if by_rows else _write_elements
    writer = _Writer(statements, action)
    if is_shared:
        write(block, _Writer(block, action))
        size = max(1, BLOCK // action.cols) if by_rows else BLOCK
        statements.share(block, action.rows if by_rows else count, size)
    else:
        write(statements, writer)
    writer.finish()


class _Writer:
    """Writes a matrix statement: before the loop, for a strip, and behind the loop."""

    def __init__(self, statements: ArrayOperands, action: SetMat) -> None:
        self._statements = statements
        self.action = action
        self.count = action.rows * action.cols
        values = (action.value, action.lower, action.upper)
        self._prepared = statements.prepare(self.count, count_draws(*values), *values)
        footprint = value_footprint(action.value)
        footprint.writes.add((action.slot, action.slot + self.count))
        self._copies = needs_copy(footprint)
        self._own = statements.at(action.slot)
        self._target = statements.temp(self.count) if self._copies else self._own
        self._mask = None if action.mask_slot is None else statements.at(action.mask_slot)

    def write(self, strip: Strip) -> None:
        """Write the statement for a strip."""
        action, lanes = self.action, strip.lanes
        expressions = StripExpressions(strip, self._statements.cells, self._prepared)
        value = expressions.value(action.value)
        if action.mode == "add":
            value = lanes.add(strip.fetch(self._own), value)
        if action.lower is not None:
            least = expressions.value(action.lower)
            value = lanes.choose(lanes.compare("olt", value, least), least, value)
        if action.upper is not None:
            most = expressions.value(action.upper)
            value = lanes.choose(lanes.compare("ogt", value, most), most, value)
        expressions.finish()
        if self._mask is not None:
            free = lanes.compare("une", strip.fetch(self._mask), lanes.const(0.0))
            value = lanes.choose(free, value, strip.fetch(self._own))
        strip.put(self._target, value)

    def finish(self) -> None:
        """Move a result that could not be written in place."""
        if self._copies:
            self._statements.move(self._target, self._own, self.count)
        self._statements.cells.forget(self.action.slot, self.count)


def _write_elements(statements: ArrayOperands, writer: _Writer) -> None:
    statements.sweep(writer.count, 0, 0, writer.write)


def _write_rows(statements: ArrayOperands, writer: _Writer) -> None:
    first, end = ("%first", "%end") if statements.is_block else ("0", str(writer.action.rows))
    cols = writer.action.cols
    loop(statements.text, first, end, 1, lambda row: _row_strips(statements, cols, row, writer.write))


def _row_strips(statements: ArrayOperands, cols: int, row: str, body: Callable[[Strip], None]) -> None:
    """Write the loop over one row's strips."""
    text, wide = statements.text, statements.wide
    start = text.op(f"mul i64 {row}, {cols}")
    full = cols // wide.width * wide.width

    def strip(column: str, active: int) -> None:
        body(Strip(wide, text.op(f"add i64 {start}, {column}"), active, row=row, column=column))

    if full:
        loop(text, "0", str(full), wide.width, lambda column: strip(column, wide.width))
    if cols > full:
        strip(str(full), cols - full)


def write_dot(statements: ArrayOperands, action: SetDot) -> None:
    """Write `DOT s = …` or `AVG s = …`."""
    lanes = statements.lanes
    total = lanes.const(0.0)
    for term in action.terms:
        value = _sum(statements, term)
        total = lanes.add(total, value if term.sign == 1.0 else lanes.mul(lanes.const(term.sign), value))
    if action.average and action.terms:
        total = lanes.div(total, lanes.const(float(action.terms[0].left.count)))
    statements.cells.store(action.slot, total)


def _sum(statements: ArrayOperands, term: DotTerm) -> str:
    """Write a sum; a long one is that of its blocks' sums, whoever has formed them."""
    count = term.left.count
    block = statements.block()
    operands = _operands(statements, term)
    if not is_large(count):
        return _sum_of_products(statements, operands, str(count))
    partial = statements.temp(blocks(count))
    text = block.text
    places = [text.op(f"getelementptr double, ptr {at}, i64 %first") for at in _operands(block, term)]
    to = text.op(
        f"getelementptr double, ptr {block.temp(blocks(count))}, i64 {text.op(f'sdiv i64 %first, {BLOCK}')}"
    )
    value = _sum_of_products(block, places, text.op("sub i64 %end, %first"))
    text.do(f"store double {value}, ptr {to}")
    statements.share(block, count)
    return _sum_of_products(statements, [partial], str(blocks(count)))


def _operands(statements: ArrayOperands, term: DotTerm) -> list[str]:
    left = statements.at(term.left.slot)
    return [left] if term.right is None else [left, statements.base(term.right)]


def _sum_of_products(statements: ArrayOperands, operands: list[str], count: str) -> str:
    text = statements.text
    text.declarations.add(products.total() if len(operands) == 1 else products.dot())
    name = "total" if len(operands) == 1 else "dot"
    arrays = ", ".join(f"ptr {at}" for at in operands)
    return text.op(f"call double @{name}({arrays}, i64 {count})")
