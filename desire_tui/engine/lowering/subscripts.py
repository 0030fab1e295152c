"""Numbers that a segment needs at compile time: subscripts, shifts, SAMPLE's m, channels.

Subscripts are real expressions of the script's values, checked against the bounds (error 2), then truncated
(language.md 3).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.lowering.constant_values import evaluate
from desire_tui.engine.lowering.lowering_context import Argument, ExpansionFrame
from desire_tui.engine.lowering.scope import UNKNOWN
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
from desire_tui.engine.values import Kind
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Expr


def constant(context: LoweringContext, node: Expr) -> float | None:
    """Return the present value of an expression; None where it is not known, or was reported."""
    if isinstance(node, Number):
        return node.value
    try:
        return _value(context, node)
    except (ArithmeticError, ValueError):
        context.report("constant-not-computable", node)
        return None


def truncated(context: LoweringContext, node: Expr) -> int | None:
    """Return the present value, truncated."""
    value = constant(context, node)
    if value is None:
        return None
    number = whole(value)
    if number is None:
        context.report("constant-not-computable", node)
    return number


def element(context: LoweringContext, node: Element) -> tuple[int | None, str]:
    """Return a subscripted name's slot, and the name with its subscripts worked out.

    The slot is None for a subscript that is not known yet and after errors 2, 19, 69, 218, 73.
    """
    name = context.actual(node.name)
    quantity = context.scope.names.get(name)
    if quantity is None or not quantity.shape:
        key = "function-with-brackets" if context.known_function(node.name) else "array-not-declared"
        arrays = (q.name for q in context.scope.names.values() if q.shape)
        context.report(key, node, name=name, close=closest(name, arrays))
        return None, name
    if quantity.kind is Kind.COMPLEX:
        context.report("complex-in-dynamic", node, name=name)
        return None, name
    if len(node.subscripts) != len(quantity.shape):
        context.report("subscript-count", node, name=name, count=len(quantity.shape))
        return None, name
    slot: int | None = 0
    shown = []
    for number, (subscript, size) in enumerate(zip(node.subscripts, quantity.shape, strict=True), 1):
        value = constant(context, subscript)
        shown.append("…" if value is None else str(int(value)) if abs(value) < 1e15 else str(value))
        if value is None or size == UNKNOWN:
            slot = None
        elif not 1 <= value <= size:  # before it is truncated, as in scripts
            context.report(
                "subscript-out-of-range", subscript, name=name, value=f"{value:g}", size=size, number=number
            )
            slot = None
        elif slot is not None:
            slot = slot * size + int(value) - 1
    return (None if slot is None else quantity.slot + slot), f"{name}[{','.join(shown)}]"


def _value(context: LoweringContext, node: Expr) -> float | None:
    return evaluate(node, lambda part: _part(context, part))


def _part(context: LoweringContext, node: Expr) -> float | None:
    """Return the value of what is no arithmetic of numbers."""
    match node:
        case Name():
            return _named(context, node)
        case Element():
            slot, _ = element(context, node)
            quantity = context.quantity(node.name)
            if slot is None or quantity is None:
                return None
            return context.scope.constant(quantity, slot - quantity.slot)
        case Call():
            return _called(context, node)
        case Number() | Unary() | Binary() | Text() | Pair() | Transposed() | Shifted() | RowOf() | Truth():
            context.report("constant-not-computable", node)
            return None
    assert_never(node)


def _named(context: LoweringContext, node: Name) -> float | None:
    name = node.name
    argument = context.frame.arguments.get(name)
    if argument is not None:
        inner = context.frame
        context.enter(argument.outer)
        value = _value(context, argument.node)
        context.enter(inner)
        return value
    quantity = context.quantity(name)
    if quantity is None or not (quantity.shape or context.scope.is_defined(quantity)):
        name = context.actual(name)
        if context.first_report(name):
            context.report("undefined-subscript", node, name=name, close=closest(name, context.scope.names))
        return None
    if quantity.shape:
        context.report("array-as-number", node, name=quantity.name)
        return None
    return context.scope.constant(quantity)


def _called(context: LoweringContext, node: Call) -> float | None:
    function = context.functions.get(node.name)
    if function is not None and len(function.node.dummies) == len(node.args):
        inner = context.frame
        if node.name in inner.calls:
            context.report("function-recursion", node, name=node.name)
            return None
        arguments = {d: Argument(a, inner) for d, a in zip(function.node.dummies, node.args, strict=True)}
        invoked, called = (*inner.invoked, context.span(node)), (*inner.calls, node.name)
        context.enter(ExpansionFrame(function.at, {}, arguments, invoked, called))
        value = _value(context, function.node.body)
        context.enter(inner)
        return value
    entry = LIBRARY.get(node.name)
    if entry is None or entry.value is None or entry.kind == "table" or "D" not in entry.where:
        context.report("constant-not-computable", node)
        return None
    values = [_value(context, argument) for argument in node.args]
    if any(v is None for v in values):
        return None
    return float(entry.value(*values))  # type: ignore[arg-type]  # none of them is None
