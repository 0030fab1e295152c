"""The JACOBIAN part of a segment: helper variables and entries J[i, k] (language.md 9.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.segment import Jacobian, JacobianEntry
from desire_tui.engine.lowering.scope import UNKNOWN
from desire_tui.engine.lowering.statements import assign
from desire_tui.engine.lowering.subscripts import constant
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.expressions import Element

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.lowering.submodels import Line


def lower_jacobian(builder: SegmentBuilder, lines: Sequence[Line]) -> Jacobian | None:
    """Lower the statements behind JACOBIAN. Errors 219, 229 without any element, 230 for one out of range."""
    context = builder.context
    known = len(context.problems)
    entries: list[JacobianEntry] = []
    matrix: str | None = None
    slot: int | None = None
    outer, builder.body = builder.body, []
    for node, frame in lines:
        context.enter(frame)
        if not isinstance(node, Assign):
            context.report("illegal-in-jacobian", node)
            continue
        target = node.target
        quantity = context.quantity(target.name) if isinstance(target, Element) else None
        if not isinstance(target, Element) or quantity is None or len(quantity.shape) != 2:
            place = len(builder.body)
            assign(builder, node)
            builder.body[place:place] = context.computed_first
            context.computed_first.clear()
            continue
        if matrix not in (None, quantity.name):
            context.report("second-jacobian", target, name=quantity.name, first=matrix)
            continue
        matrix, slot = quantity.name, quantity.slot
        if len(target.subscripts) != 2:
            context.report("subscript-count", target, name=matrix, count=2)
            continue
        value = context.lower(node.value)
        builder.body += context.computed_first
        context.computed_first.clear()
        row, column = (constant(context, s) for s in target.subscripts)
        if row is None or column is None:
            continue
        order = builder.states.order
        size = min((n for n in quantity.shape if n != UNKNOWN), default=order)
        if size < order:
            context.report("jacobian-too-small", target, name=quantity.name, order=order)
        elif not (1 <= row < order + 1 and 1 <= column < order + 1):
            context.report("jacobian-entry", target, order=order)
        else:
            entries.append(JacobianEntry(int(row) - 1, int(column) - 1, value, context.where(node)))
    body, builder.body = tuple(builder.body), outer
    if slot is None:
        if len(context.problems) == known:
            context.enter(lines[0][1])
            context.report("jacobian-missing", lines[0][0], n=builder.states.order)
        return None
    return Jacobian(slot, body, tuple(entries))
