"""Output requests of a segment: display, listing, stash, recover, SHOW; their position does not matter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.lowered.segment import Picture, SampleColumn, SampleRequest
from desire_tui.engine.lowering.measured import measured_curves, split_measured
from desire_tui.engine.lowering.scope import UNKNOWN, size_of
from desire_tui.engine.lowering.subscripts import constant, element, truncated
from desire_tui.engine.nodes.expressions import Element
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.nodes.display import Request, Show
    from desire_tui.engine.nodes.expressions import Target

_DISPLAYS = frozenset({"dispt", "dispxy", "DISPXY"})


def request(builder: SegmentBuilder, node: Request) -> None:
    """`dispt dispxy DISPXY type stash recover`. Errors 8, 14, 200, 69, 536."""
    context = builder.context
    family = "display" if node.kind in _DISPLAYS else node.kind
    if family in builder.once_only:
        line = context.source.position(builder.once_only[family].start).row
        context.report("second-request", node, kind=node.kind, line=line)
        return
    builder.once_only[family] = context.span(node)
    sampled, measured = split_measured(context, node)
    points = measured_curves(context, node, measured) if family == "display" else ()
    columns = tuple(c for c in (column(builder, item) for item in sampled) if c is not None)
    if node.kind == "DISPXY" and len(node.items) % 2:
        context.report("pairs-expected", node)
    elif node.kind == "dispxy" and len(node.items) < 2:
        context.report("abscissa-and-ordinate", node)
    if node.kind == "stash":
        builder.stash.extend(columns)
    elif node.kind == "recover":
        builder.recover.extend(columns)
    else:
        channel = None if node.channel is None else truncated(context, node.channel)
        builder.requests.append(SampleRequest(node.kind, columns, channel, context.where(node), points))


def column(builder: SegmentBuilder, item: Target) -> SampleColumn | None:
    """Return a requested variable: a scalar or an element that has a value when samples are taken."""
    context = builder.context
    if isinstance(item, Element):
        slot, shown = element(context, item)
        if slot is None:
            return None
        builder.names[slot] = shown
        return SampleColumn(shown, slot, context.where(item))
    name = context.actual(item.name)
    quantity = context.scope.names.get(name)
    if quantity is not None and quantity.shape:
        context.report("array-in-request", item, name=name)
        return None
    if quantity is not None and quantity.kind is Kind.COMPLEX:
        context.report("complex-in-dynamic", item, name=name)
        return None
    if quantity is None or not (name in context.assigned or context.scope.is_defined(quantity)):
        if name in context.scope.times_of_files:
            context.report("times-in-request", item, name=name, file=context.scope.times_of_files[name])
        elif context.first_report(name):
            close = closest(name, context.known_names(name))
            context.report("undefined-in-segment", item, name=name, close=close)
        return None
    builder.names[quantity.slot] = name
    return SampleColumn(name, quantity.slot, context.where(item))


def show(builder: SegmentBuilder, node: Show) -> None:
    """`SHOW A, ncol`. Error 112."""
    context = builder.context
    quantity = context.quantity(node.name)
    if quantity is None or not quantity.shape:
        context.report("show-array", node, name=context.actual(node.name))
        return
    if quantity.kind is Kind.COMPLEX:
        context.report("complex-in-dynamic", node, name=quantity.name)
        return
    count = size_of(quantity)
    columns: float | None = float(quantity.shape[-1])
    if node.columns is not None:
        columns = constant(context, node.columns)
        if columns is not None and not 1 <= columns < 1e9:
            context.report("show-columns", node.columns, value=f"{columns:g}")
            return
    if columns is not None and count != UNKNOWN:
        builder.pictures.append(Picture(quantity.name, quantity.slot, count, int(columns), builder.by_size))
