"""Rerolled scalar statements (`rerolling`) as loops."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.shared_loops import is_large
from desire_tui.engine.codegen.scalar import templates
from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.statements import Set

if TYPE_CHECKING:
    from desire_tui.engine.codegen.scalar.rerolling import Rolled
    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.codegen.vector.strips import Strip


def write_rolled(statements: ArrayOperands, rolled: Rolled) -> None:
    """Write the loop over statements of one shape."""
    if is_large(rolled.count):
        block = statements.block()
        _write(block, rolled)
        statements.share(block, rolled.count)
    else:
        _write(statements, rolled)
    if isinstance(rolled.first, Set):
        statements.cells.forget(rolled.first.slot, rolled.count)


def _write(statements: ArrayOperands, rolled: Rolled) -> None:
    first = rolled.first
    places = [statements.at(o) if isinstance(o, int) else _lanes(statements, o) for o in rolled.operands]
    if isinstance(first, Set):
        target = statements.at(first.slot)
    else:
        target = statements.text.op(f"getelementptr double, ptr %dx, i64 {first.state}")

    def body(strip: Strip) -> None:
        strip = replace(strip, masked=strip.active > 1)  # half the time to compile the loop and its rest
        leaves = iter(
            strip.fetch(place) if isinstance(operand, int) else place
            for place, operand in zip(places, rolled.operands, strict=True)
        )
        strip.put(target, templates.write_shape(strip.lanes, first.value, leaves))

    statements.sweep(rolled.count, 0, 0, body)


def _lanes(statements: ArrayOperands, leaves: tuple[int | float, ...]) -> str:
    """Return operands that come round: one for each lane."""
    wide = statements.wide
    values = [statements.cells.load(x) if isinstance(x, int) else statements.lanes.const(x) for x in leaves]
    if len(set(values)) == 1:
        return wide.splat(values[0])
    result = "poison"
    for lane, value in enumerate(values):
        result = statements.text.op(f"insertelement {wide.kind} {result}, double {value}, i64 {lane}")
    return result
