"""`delay(x, tau)` in an expression: what x was at t - tau."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.lowered.segment import DelayedValue
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Call


def delayed(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower `delay(x, tau, h)`: the operation `delayed` of the history's number, the time, and h there."""
    context.reads.append("")  # every place has a history of its own
    if extent:
        return context.report("delay-of-array", node)
    source, tau, *before = [context.lower(argument) for argument in node.args]
    if context.rule == 0:
        return context.report("delay-without-states", node)
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
