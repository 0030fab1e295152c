"""Expressions of a segment: names become slots, FUNCTIONs are expanded, arrays are checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.left_chains import LONG
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowering import calls, long_chains, products
from desire_tui.engine.lowering.lowering_context import BAD, SCALAR, UNKNOWN_SLOT, Extent, LoweringContext
from desire_tui.engine.lowering.operators import OPERATIONS, power
from desire_tui.engine.lowering.relations import truth
from desire_tui.engine.lowering.subscripts import element
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Name,
    Number,
    Pair,
    RowOf,
    Shifted,
    Text,
    Transposed,
    Truth,
    Unary,
)

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.nodes.expressions import Expr


class ExpressionLowering(LoweringContext):
    """The context that knows how to lower every kind of expression."""

    def lower(self, node: Expr, extent: Extent = SCALAR) -> Value:
        """Return the value of an expression over `extent`; problems are noted.

        Errors 200, 70, 69, 2, 19, 59, 74, 75, 218 and those of FUNCTION calls (56, 52).
        """
        # `type(…) is` takes half the time of isinstance, for every node
        if type(node) is Name:
            if self.plain:
                load = self.flow.ready.get(node.name)
                if load is not None:
                    self.reads[node.name] = load.slot
                    return load
                self.reads[node.name] = UNKNOWN_SLOT
            return _name(self, node, extent)
        if type(node) is Number:
            return Const(node.value)
        if type(node) is Binary:
            return _binary(self, node, extent)
        if type(node) is Call:
            return calls.call(self, node, extent)
        if type(node) is Unary:
            operand = self.lower(node.operand, extent)
            if node.op == "+":
                return operand
            return Const(-operand.value) if isinstance(operand, Const) else Op("neg", (operand,))
        if type(node) is Element:
            return _subscripted(self, node)
        if isinstance(node, Truth):
            return truth(self, node.condition, extent)
        if isinstance(node, Shifted | RowOf | Transposed):
            return products.operand(self, node, extent)
        if isinstance(node, Pair | Text):
            return self.report("complex-in-dynamic", node, name="[…]")
        assert_never(node)


def _name(context: LoweringContext, node: Name, extent: Extent) -> Value:
    """Lower a name: a scalar, a FUNCTION's dummy, or a whole array where the extent allows it."""
    frame = context.frame
    argument = frame.arguments.get(node.name)
    if argument is not None:
        if argument.value is None:
            context.enter(argument.outer)
            argument.value = context.lower(argument.node, extent)
            context.enter(frame)
        return argument.value
    if extent:
        quantity = context.quantity(node.name)
        actual = context.actual(node.name)
        if quantity is not None and quantity.shape:
            return products.operand(context, node, extent)
        if quantity is None and actual not in context.assigned and actual != context.assigned_scalar:
            return products.unknown(context, node)
    return context.read(node)


def _subscripted(context: LoweringContext, node: Element) -> Value:
    """Lower `A[i, k]`."""
    context.reads[""] = UNKNOWN_SLOT
    slot, _ = element(context, node)
    if slot is None:
        return BAD
    if context.assigned_arrays:
        context.flow.read_slot(slot)
    return Load(slot)


def _binary(context: LoweringContext, node: Binary, extent: Extent) -> Value:
    """Lower an operation; products over an extent may hold matrix/vector products."""
    op = node.op
    if node.end - node.start >= LONG and op != "^":
        return long_chains.lower_long(context, node, extent)
    if extent and op in "*/&":
        return products.product(context, node, extent)
    # a name that can be read is most of what there is, and `lower` would take as long again for it
    ready = context.flow.ready.get if context.plain else _nothing_ready
    parts: list[Value] = []
    for part in (node.left, node.right):
        if type(part) is Name and (load := ready(part.name)) is not None:
            context.reads[part.name] = load.slot
            parts.append(load)
        else:
            parts.append(context.lower(part, extent))
    left, right = parts
    operation = OPERATIONS.get(op)
    if operation is not None:
        return Op(operation, (left, right))
    if op == "^":
        return power(left, right)
    return context.report("ampersand-here", node)


def _nothing_ready(_name: str) -> Load | None:
    """Return what can be read at once where names stand for others: nothing."""
    return None
