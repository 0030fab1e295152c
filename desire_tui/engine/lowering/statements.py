"""Scalar statements of a segment: assignments, derivatives, guards, time histories, delays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Load
from desire_tui.engine.lowered.statements import (
    DelayLine,
    GetHistory,
    Set,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.engine.lowering.lowering_cache import lower_cached
from desire_tui.engine.lowering.lowering_context import BAD
from desire_tui.engine.lowering.products import array
from desire_tui.engine.lowering.scope import UNKNOWN, size_of
from desire_tui.engine.lowering.subscripts import constant
from desire_tui.engine.lowering.targets import mark_held, mark_set, scalar_slot
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.commands import Simple
    from desire_tui.engine.nodes.control import If
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.segment import (
        Delay,
        Derivative,
        Event,
        Every,
        FunctionTable,
        Get,
        Sample,
        Store,
        Term,
        TrackHold,
    )
    from desire_tui.engine.values import Quantity

GUARDS_MOST = 80
"""`if` inside of `if`, OUT, SAMPLE and step: Python nests a hundred, and so does nobody."""


def assign(builder: SegmentBuilder, node: Assign) -> None:
    """`y = e`: defined variable or difference equation."""
    context = builder.context
    target = node.target
    context.assigned_scalar = context.actual(target.name) if isinstance(target, Name) else None
    slot = scalar_slot(context, target)
    value = lower_cached(context, node.value)
    context.assigned_scalar = None
    if slot is not None:
        made = Set(slot, value, context.where(node))
        builder.body.append(made)
        context.flow.assignments.append(made)
        mark_set(context, target, slot)


def derivative(builder: SegmentBuilder, node: Derivative) -> None:
    """`d/dt x = e`, `d/dt x[i] = e`. Error 101 for a second one."""
    context = builder.context
    slot = scalar_slot(context, node.target)
    value = lower_cached(context, node.value)
    if slot is None:
        return
    array_of = context.quantity(node.target.name) if isinstance(node.target, Element) else None
    if builder.is_second_derivative(slot, 1):
        context.report("state-twice", node.target, name=context.actual(node.target.name))
    elif array_of is not None and UNKNOWN not in array_of.shape:
        other = builder.overlaid(slot, 1, array_of)
        if other is not None:
            context.report("state-twice-overlaid", node.target, name=array_of.name, other=other)
    builder.derivative(slot, 1, value, context.where(node))


def term(builder: SegmentBuilder, node: Term) -> None:
    """`term e`."""
    context = builder.context
    level = context.scope.hidden(1)
    builder.body.append(Terminate(context.lower(node.value), builder.terms, context.where(node), level))
    builder.levels.append(level)
    builder.terms += 1


def condition(builder: SegmentBuilder, node: If) -> None:
    """`if e`; a script's `if C then` is error 219."""
    context = builder.context
    if node.value is None:
        context.report("then-in-segment", node)
        return
    value = lower_cached(context, node.value)
    if len(builder.guards) >= GUARDS_MOST and context.first_report("nested if"):
        context.report("ifs-too-deep", node, limit=GUARDS_MOST)
    builder.open("if", context.where(node), value)


def simple(builder: SegmentBuilder, node: Simple) -> None:
    """`OUT`, `step`, `else`, `end if`; anything else is error 219."""
    context = builder.context
    if node.word == "OUT":
        _end_moment(builder, node)
        builder.open("out", context.where(node))
    elif node.word == "step":
        _end_moment(builder, node)
        builder.open("step", context.where(node))
    elif node.word == "end event":
        if not builder.at_moment:
            context.report("stray-end-event", node)
        _end_moment(builder, node)
    elif node.word == "else":
        if not builder.otherwise():
            context.report("stray-else", node, word=node.word)
    elif node.word in {"end if", "proceed"}:
        if not builder.end_if():
            context.report("stray-else", node, word=node.word)
    else:
        context.report("illegal-in-dynamic", node, word=node.word)


def sample(builder: SegmentBuilder, node: Sample) -> None:
    """`SAMPLE m`: m is fixed now and truncated. Error 8 for a second one, 44 for m < 1."""
    context = builder.context
    if "SAMPLE" in builder.once_only:
        context.report("second-sample", node)
        return
    builder.once_only["SAMPLE"] = context.span(node)
    _end_moment(builder, node)
    every = constant(context, node.every)
    # 13.98 counts as 13, but a whole number computed with a rounding error counts as itself
    count = 1 if every is None else whole(every * (1 + 1e-9), 1)
    if count is None:
        context.report("sample-below-one", node.every, value=f"{every:g}")
    builder.open("sample", context.where(node), every=count or 1)


def event(builder: SegmentBuilder, node: Event) -> None:
    """`event e`: the statements behind it are executed where e rises through 0."""
    condition = builder.context.lower(node.value)
    _begin_moment(builder, node, condition, None)


def every(builder: SegmentBuilder, node: Every) -> None:
    """`every T, t0`: the statements behind it are executed at t0, t0 + T and so on."""
    context = builder.context
    period = context.lower(node.period)
    start = Const(0.0) if node.first is None else context.lower(node.first)
    _begin_moment(builder, node, None, (period, start))


def _begin_moment(
    builder: SegmentBuilder, node: Event | Every, condition: Value | None, times: tuple[Value, Value] | None
) -> None:
    _end_moment(builder, node)
    if any(guard.kind == "if" for guard in builder.guards):
        builder.context.report("moment-in-if", node, word="event" if times is None else "every")
        return
    builder.begin_moment(builder.context.where(node), condition, times)


def _end_moment(builder: SegmentBuilder, node: Node) -> None:
    if not builder.end_moment():
        builder.context.report("if-open-at-moment", node)


def store(builder: SegmentBuilder, node: Store) -> None:
    """`store X = x`."""
    context = builder.context
    quantity = history(builder, node, node.array)
    value = context.lower(node.variable)
    if quantity is not None and isinstance(value, Load):
        count = size_of(quantity)
        context.flow.set_ranges.add(quantity.slot, max(count, 1))
        builder.body.append(
            StoreHistory(quantity.slot, count, value.slot, builder.counter(), context.where(node))
        )


def get(builder: SegmentBuilder, node: Get) -> None:
    """`get x = X`."""
    context = builder.context
    quantity = history(builder, node, node.array)
    slot = scalar_slot(context, node.variable)
    if quantity is not None and slot is not None:
        count = size_of(quantity)
        builder.body.append(GetHistory(slot, quantity.slot, count, builder.counter(), context.where(node)))
        mark_held(context, node.variable)


def delay(builder: SegmentBuilder, node: Delay) -> None:
    """`tdelay y = D(x, tau` and `delay y = D(x, tau`."""
    context = builder.context
    buffer = history(builder, node, node.buffer)
    slot = scalar_slot(context, node.variable)
    source = context.lower(node.source)
    tau = context.lower(node.tau)
    if buffer is not None and slot is not None:
        builder.names[buffer.slot] = buffer.name
        made = DelayLine(
            slot,
            buffer.slot,
            size_of(buffer),
            source,
            tau,
            node.per_step,
            builder.counter(),
            context.where(node),
        )
        builder.body.append(made)
        mark_held(context, node.variable)


def track_hold(builder: SegmentBuilder, node: TrackHold) -> None:
    """`trkhld y, y0 = p, x`: both keep their values from pass to pass, 0 at first."""
    context = builder.context
    control, value = context.lower(node.control), context.lower(node.value)
    held, tracked = scalar_slot(context, node.held), scalar_slot(context, node.tracked)
    if held is not None and tracked is not None:
        builder.body.append(UpdateTrackHold(held, tracked, control, value, context.where(node)))
        mark_held(context, node.held)
        mark_held(context, node.tracked)


def table(builder: SegmentBuilder, node: FunctionTable) -> None:
    """`func y = F(x`, `func2 f = F(x, y; X, Y`."""
    context = builder.context
    slot = scalar_slot(context, node.target)
    value = context.lower(node.call)
    if slot is not None and value is not BAD:
        made = Set(slot, value, context.where(node))
        builder.body.append(made)
        context.flow.assignments.append(made)
        mark_set(context, node.target, slot)


def history(builder: SegmentBuilder, node: Node, name: str) -> Quantity | None:
    """Return the one-dimensional array of `store`, `get` or a delay. Errors 19, 75."""
    context = builder.context
    place = Name(name, node.start, node.end)
    quantity = array(context, place, "not-an-array")
    if quantity is None:
        return None
    if len(quantity.shape) != 1:
        context.report("history-not-vector", place, name=quantity.name)
        return None
    if quantity.shape[0] != UNKNOWN:
        context.flow.read_range(quantity.slot, quantity.shape[0])
    return quantity
