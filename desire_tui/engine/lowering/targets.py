"""What a statement assigns: scalars, elements, vectors, matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowering.products import array
from desire_tui.engine.lowering.scope import UNKNOWN
from desire_tui.engine.lowering.subscripts import element
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Target
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.values import Quantity


def scalar_slot(context: LoweringContext, target: Target) -> int | None:
    """Return the slot that `target` names, made if new. Errors 69, 218, 2, 19."""
    if isinstance(target, Element):
        quantity = context.quantity(target.name)
        if quantity is not None and quantity.kind is not Kind.REAL:
            context.report("not-real-target", target, name=quantity.name)
            return None
        return element(context, target)[0]
    name = context.actual(target.name)
    if name in context.functions:
        context.report("function-as-variable", target, name=name)
        return None
    quantity = context.scope.names.get(name)
    if quantity is not None and quantity.shape:
        context.report("array-as-number", target, name=name)
        return None
    if quantity is not None and quantity.kind is not Kind.REAL:
        context.report("not-real-target", target, name=name)
        return None
    if name == "PI":
        context.report("constant-target", target, name=name)
        return None
    return (quantity or context.scope.scalar(name)).slot


def mark_set(context: LoweringContext, target: Target, slot: int) -> None:
    """Note that the pass has set a scalar or an element."""
    context.flow.set_slots[slot] = None
    if isinstance(target, Name):
        context.flow.ready[context.actual(target.name)] = Load(slot)


def mark_held(context: LoweringContext, target: Target) -> None:
    """Note that a scalar can be read from now on, though not every pass sets it."""
    if isinstance(target, Name):
        quantity = context.quantity(target.name)
        if quantity is not None:
            context.flow.ready[context.actual(target.name)] = Load(quantity.slot)


def vector(context: LoweringContext, node: Node, name: str) -> Quantity | None:
    """Return the one-dimensional REAL array to be assigned. Errors 70, 69, 75, 218."""
    return _array(context, node, name, (1,))


def matrix(context: LoweringContext, node: Node, name: str) -> Quantity | None:
    """Return the two-dimensional REAL array to be assigned. Errors 70, 69, 75, 218."""
    return _array(context, node, name, (2,))


def states(context: LoweringContext, node: Node, name: str) -> Quantity | None:
    """Return the vector or matrix whose derivative is to be computed. Errors 70, 69, 75, 218."""
    return _array(context, node, name, (1, 2))


def _array(context: LoweringContext, node: Node, name: str, ranks: tuple[int, ...]) -> Quantity | None:
    place = Name(name, node.start, node.end)
    quantity = array(context, place, "not-an-array")
    if quantity is None:
        return None
    if quantity.kind is not Kind.REAL:
        context.report("not-real-target", place, name=quantity.name)
        return None
    if len(quantity.shape) not in ranks:
        key = "states-target" if len(ranks) > 1 else "vector-target" if ranks == (1,) else "matrix-target"
        context.report(key, place, name=quantity.name, dimensions=len(quantity.shape))
        return None
    return quantity


def mark_array(context: LoweringContext, slot: int, count: int) -> None:
    """Note that the pass has set a whole array."""
    if count != UNKNOWN:
        context.flow.set_ranges.add(slot, count)
