"""Slots of array elements: every subscript is checked against its bound (error 2), then truncated."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.python_ast import at
from desire_tui.engine.nodes.expressions import Number
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    import ast

    from desire_tui.engine.interpreter.scalar_translator import ScalarTranslator
    from desire_tui.engine.nodes.expressions import Element, Expr
    from desire_tui.engine.values import Quantity


def element_slot(translator: ScalarTranslator, node: Element, quantity: Quantity) -> ast.expr:
    """Return code for an element's slot: a constant where all subscripts are number literals."""
    if len(node.subscripts) != len(quantity.shape):
        facts = {"name": node.name, "given": len(node.subscripts), "needed": len(quantity.shape)}
        raise ScriptFault("script-subscript-count", node, **facts)
    width = 2 if quantity.kind is Kind.COMPLEX else 1
    constant = quantity.slot
    moving: ast.expr | None = None
    for place, (subscript, size) in enumerate(zip(node.subscripts, quantity.shape, strict=True), 1):
        stride = prod(quantity.shape[place:]) * width
        if isinstance(subscript, Number):
            constant += (_checked(subscript, size, place) - 1) * stride
            continue
        constant -= stride
        part = _subscript(translator, subscript, size, place)
        if stride != 1:
            part = py.binary(part, py.MULTIPLY, py.number(stride))
        moving = part if moving is None else py.binary(moving, py.ADD, part)
    if moving is None:
        return py.number(constant)
    return py.binary(moving, py.ADD, py.number(constant))


def _checked(node: Number, size: int, place: int) -> int:
    if not 1 <= node.value <= size:
        raise ScriptFault(
            "script-subscript-out-of-range", node, value=f"{node.value:g}", size=size, place=place
        )
    return int(node.value)


def _subscript(translator: ScalarTranslator, node: Expr, size: int, place: int) -> ast.expr:
    """`int(v) if 1 <= (v := …) <= size else bad_subscript(v, size, place)`."""
    variable = translator.build.fresh("s")
    value = py.assign_inline(variable, translator.real(node))
    inside = py.compare(py.number(1), [py.AT_MOST, py.AT_MOST], [value, py.number(size)])
    failed = py.call("bad_subscript", py.load(variable), py.number(size), py.number(place))
    return at(py.if_else(inside, py.call("int", py.load(variable)), at(failed, node)), node)
