"""Expressions of a segment: names become slots, FUNCTIONs are expanded, arrays are checked.

The *extent* says what is being computed: a scalar (`()`), a vector of n elements (`(n,)`) or a matrix
(`(m, n)`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.left_chains import LONG
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowering import calls, long_chains, products
from desire_tui.engine.lowering.lowering_context import BAD
from desire_tui.engine.lowering.subscripts import element
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Name,
    Number,
    RowOf,
    Shifted,
    Transposed,
    Unary,
)

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Expr

Extent = tuple[int, ...]
SCALAR: Extent = ()

OPERATIONS = {"+": "add", "-": "sub", "*": "mul", "/": "div"}


def lower(context: LoweringContext, node: Expr, extent: Extent = SCALAR) -> Value:
    """Return the value of an expression over `extent`; problems go to the context.

    Errors 200, 70, 69, 2, 19, 59, 74, 75, 218 and those of FUNCTION calls (56, 52).
    """
    kind = node.__class__  # half the time of isinstance, for every node; mypy does not follow it
    if kind is Name:
        if context.plain:
            context.reads.append(node.name)  # type: ignore[union-attr]
            load = context.flow.ready.get(node.name)  # type: ignore[union-attr]
            if load is not None:
                return load
        return name(context, node, extent)  # type: ignore[arg-type]
    if kind is Number:
        return Const(node.value)  # type: ignore[union-attr, arg-type]
    if kind is Binary:
        return binary(context, node, extent)  # type: ignore[arg-type]
    if kind is Call:
        return calls.call(context, node, extent)  # type: ignore[arg-type]
    if kind is Unary:
        operand = lower(context, node.operand, extent)  # type: ignore[union-attr]
        if node.op == "+":  # type: ignore[union-attr]
            return operand
        return Const(-operand.value) if isinstance(operand, Const) else Op("neg", (operand,))
    if kind is Element:
        return subscripted(context, node)  # type: ignore[arg-type]
    if isinstance(node, Shifted | RowOf | Transposed):
        return products.operand(context, node, extent)
    return context.report("complex-in-dynamic", node, name="[…]")


def name(context: LoweringContext, node: Name, extent: Extent) -> Value:
    """Lower a name: a scalar, a FUNCTION's dummy, or a whole array where the extent allows it."""
    frame = context.frame
    argument = frame.arguments.get(node.name)
    if argument is not None:
        if argument.value is None:
            context.enter(argument.outer)
            argument.value = lower(context, argument.node, extent)
            context.enter(frame)
        return argument.value
    if extent:
        quantity = context.quantity(node.name)
        actual = context.actual(node.name)
        if quantity is not None and quantity.shape:
            return products.operand(context, node, extent)
        if quantity is None and actual not in context.assigned and actual != context.own:
            return products.unknown(context, node)
    return context.read(node)


def subscripted(context: LoweringContext, node: Element) -> Value:
    """Lower `A[i, k]`."""
    context.reads.append("")
    slot, _ = element(context, node)
    if slot is None:
        return BAD
    if context.assigned_arrays:
        context.flow.read_slot(slot)
    return Load(slot)


def binary(context: LoweringContext, node: Binary, extent: Extent) -> Value:
    """Lower an operation; products over an extent may hold matrix/vector products."""
    op = node.op
    if node.end - node.start >= LONG and op != "^":
        return long_chains.lower_long(context, node, extent)
    if extent and op in "*/&":
        return products.product(context, node, extent)
    left = lower(context, node.left, extent)
    right = lower(context, node.right, extent)
    operation = OPERATIONS.get(op)
    if operation is not None:
        return Op(operation, (left, right))
    if op == "^":
        return power(left, right)
    return context.report("ampersand-here", node)


def power(left: Value, right: Value) -> Op:
    """Lower `left ^ right`: whole constant powers are products (language.md 4)."""
    if isinstance(right, Const) and right.value == int(right.value) and abs(right.value) <= 1024:
        return Op("ipow", (left, right))
    return Op("pow", (left, right))
