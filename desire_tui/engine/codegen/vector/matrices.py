"""Matrix statements and sums of products."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.vector import products
from desire_tui.engine.codegen.vector.elements import StripExpressions
from desire_tui.engine.codegen.vector.fusion import needs_copy, value_footprint
from desire_tui.engine.codegen.vector.strips import Strip
from desire_tui.engine.lowered.effects import count_draws
from desire_tui.engine.lowered.expressions import Outer
from desire_tui.engine.lowered.walk import walk_values

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.statements import SetDot, SetMat


def write_matrix(statements: ArrayOperands, action: SetMat) -> None:
    """Write `MATRIX W = …` or `DELTA W = …`."""
    count = action.rows * action.cols
    values = (action.value, action.lower, action.upper)
    prepared = statements.prepare(count, count_draws(*values), *values)
    footprint = value_footprint(action.value)
    footprint.writes.add((action.slot, action.slot + count))
    copies = needs_copy(footprint)
    own = statements.at(action.slot)
    target = statements.temp(count) if copies else own
    mask = None if action.mask_slot is None else statements.at(action.mask_slot)

    def body(strip: Strip) -> None:
        expressions = StripExpressions(strip, statements.cells, prepared)
        lanes = strip.lanes
        value = expressions.value(action.value)
        if action.mode == "add":
            value = lanes.add(strip.fetch(own), value)
        if action.lower is not None:
            least = expressions.value(action.lower)
            value = lanes.choose(lanes.compare("olt", value, least), least, value)
        if action.upper is not None:
            most = expressions.value(action.upper)
            value = lanes.choose(lanes.compare("ogt", value, most), most, value)
        expressions.finish()
        if mask is not None:
            free = lanes.compare("une", strip.fetch(mask), lanes.const(0.0))
            value = lanes.choose(free, value, strip.fetch(own))
        strip.put(target, value)

    if any(isinstance(n, Outer) for n in walk_values(action.value)):
        cols = action.cols
        loop(statements.text, "0", str(action.rows), 1, lambda row: _row_strips(statements, cols, row, body))
    else:
        statements.sweep(count, 0, 0, body)
    if copies:
        statements.move(target, own, count)
    statements.cells.forget(action.slot, count)


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
    text, lanes = statements.text, statements.lanes
    total = lanes.const(0.0)
    for term in action.terms:
        count = term.left.count
        left = statements.at(term.left.slot)
        if term.right is None:
            text.declarations.add(products.total())
            value = text.op(f"call double @total(ptr {left}, i64 {count})")
        else:
            text.declarations.add(products.dot())
            right = statements.base(term.right)
            value = text.op(f"call double @dot(ptr {left}, ptr {right}, i64 {count})")
        total = lanes.add(total, value if term.sign == 1.0 else lanes.mul(lanes.const(term.sign), value))
    if action.average and action.terms:
        total = lanes.div(total, lanes.const(float(action.terms[0].left.count)))
    statements.cells.store(action.slot, total)
