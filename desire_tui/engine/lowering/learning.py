"""CLEARN, PLEARN and INTP: learning statements of a segment (docs/neural.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const
from desire_tui.engine.lowered.statements import LearningStep
from desire_tui.engine.lowering.products import array, nonconformable
from desire_tui.engine.lowering.scope import UNKNOWN, agree, size_of
from desire_tui.engine.lowering.targets import mark_array
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.nodes.segment import Learn
    from desire_tui.engine.values import Quantity


def learn(builder: SegmentBuilder, node: Learn) -> None:
    """`CLEARN y = W(x) lrate, crit[#]`, `PLEARN y = W*x; lrate`, `INTP y = W*x; thresh`.

    W is rows × cols, the output has `rows` elements, the input `cols`. Errors 70, 74, 75, 218, 475.
    """
    context = builder.context
    out = _ranked(builder, node, node.output, 1)
    weights = _ranked(builder, node, node.weights, 2)
    given = _ranked(builder, node, node.input, 1)
    rate = context.lower(node.rate)
    criterion = None if node.criterion is None else context.lower(node.criterion)
    if out is None or weights is None or given is None:
        return
    for quantity, wanted in ((out, weights.shape[0]), (given, weights.shape[1])):
        if not agree(quantity.shape[0], wanted):
            nonconformable(
                context, Name(quantity.name, node.start, node.end), quantity.name, quantity.shape, (wanted,)
            )
            return
    rows = weights.shape[0]
    plain = criterion is None or (isinstance(criterion, Const) and criterion.value < 0.0)
    h = None if plain else _declared_behind(builder, out)
    if h is None and isinstance(criterion, Const) and not plain:
        context.report("learning-needs-vector", node, name=out.name, rows=rows)
        return
    full = None if plain or (h is not None and criterion == Const(0.0)) else context.scope.hidden(1)
    if full is not None:
        builder.watch(full, context.where(node))
    for read in (given, weights, h):
        if read is not None and UNKNOWN not in read.shape:
            context.flow.read_range(read.slot, size_of(read))
    builder.body.append(
        LearningStep(
            node.kind, out.slot, out.shape[0], weights.slot, given.slot, given.shape[0],
            rate, criterion, None if h is None else h.slot, node.fast, context.where(node), full,
        )
    )  # fmt: skip
    mark_array(context, out.slot, out.shape[0])


def _declared_behind(builder: SegmentBuilder, out: Quantity) -> Quantity | None:
    """Return the vector declared right after a CLEARN's output if it has as many elements, else None."""
    names = builder.context.scope.names
    arrays = iter([quantity for quantity in names.values() if quantity.shape])
    for quantity in arrays:
        if quantity.name == out.name:
            break
    h = next(arrays, None)
    fits = h is not None and h.kind is Kind.REAL and len(h.shape) == 1 and agree(h.shape[0], out.shape[0])
    return h if fits else None


def _ranked(builder: SegmentBuilder, node: Learn, name: str, rank: int) -> Quantity | None:
    place = Name(name, node.start, node.end)
    quantity = array(builder.context, place, "not-an-array")
    if quantity is not None and len(quantity.shape) != rank:
        key = "vector-target" if rank == 1 else "matrix-target"
        builder.context.report(key, place, name=quantity.name, dimensions=len(quantity.shape))
        return None
    return quantity
