"""`delay(x, tau)` in an expression: what x was at t - tau."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, ElementOperand, Load, Op, Table1, Table2, Vec
from desire_tui.engine.lowered.segment import DelayedValue
from desire_tui.engine.lowered.statements import Set
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.lowering.lowering_context import BAD, UNKNOWN_SLOT
from desire_tui.engine.lowering.scope import UNKNOWN
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Call


def delayed(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower `delay(x, tau, h)`: the operation `delayed` of the history's number, the time, and h there."""
    context.reads[""] = UNKNOWN_SLOT  # every place has a history of its own
    values = [context.lower(argument, extent) for argument in node.args]
    if context.rule == 0:
        return context.report("delay-without-states", node)
    if not any(isinstance(part, ElementOperand) for value in values for part in walk_values(value)):
        return _number(context, node, *values)
    return _array(context, node, values, extent)


def _array(context: LoweringContext, node: Call, values: Sequence[Value], extent: Extent) -> Value:
    """Compute an array of what each element was before the statement; every element has a history."""
    if UNKNOWN in extent:
        return BAD  # a check before the run: nothing is computed
    from desire_tui.engine.passes.scalar_elements import element_of

    count, where = prod(extent), context.where(node)
    slot = context.scope.hidden(count)
    for at in range(count):
        parts = [part for value in values if (part := element_of(value, at)) is not None]
        if len(parts) < len(values):
            return context.report("delay-of-product", node)
        context.computed_first.append(Set(slot + at, _number(context, node, *parts), where))
    return Vec(slot, count)


def _number(context: LoweringContext, node: Call, source: Value, tau: Value, *before: Value) -> Value:
    number = len(context.delays)
    context.delays.append(DelayedValue(source, tau, context.where(node)))
    time = Op("sub", (Load(T), tau))
    return Op("delayed", (Const(float(number)), time, *(_at(value, time) for value in before)))


def _at(value: Value, time: Value) -> Value:
    """Return an expression of t at another time."""
    if isinstance(value, Load):
        return time if value.slot == T else value
    if isinstance(value, Op):
        return Op(value.name, tuple(_at(argument, time) for argument in value.args))
    if isinstance(value, Table1):
        return Table1(_at(value.x, time), value.slot, value.count)
    if isinstance(value, Table2):
        x, y = _at(value.x, time), _at(value.y, time)
        return Table2(x, y, value.f_slot, value.rows, value.cols, value.x_slot, value.y_slot)
    return value
