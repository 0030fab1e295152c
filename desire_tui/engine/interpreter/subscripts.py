"""Slots of array elements: every subscript is checked against its bound (error 2), then truncated."""

from __future__ import annotations

import ast
from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import builder as py
from desire_tui.engine.interpreter.builder import at
from desire_tui.engine.interpreter.faults import Fault
from desire_tui.engine.nodes import Number
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.translate import Translator
    from desire_tui.engine.nodes import Element, Expr
    from desire_tui.engine.values import Quantity


def element_slot(translator: Translator, node: Element, quantity: Quantity) -> ast.expr:
    """Return code for an element's slot: a constant where all subscripts are number literals."""
    if len(node.subscripts) != len(quantity.shape):
        facts = {"name": node.name, "given": len(node.subscripts), "needed": len(quantity.shape)}
        raise Fault("script-subscript-count", node, **facts)
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
            part = ast.BinOp(part, ast.Mult(), py.number(stride))
        moving = part if moving is None else ast.BinOp(moving, ast.Add(), part)
    if moving is None:
        return py.number(constant)
    return ast.BinOp(moving, ast.Add(), py.number(constant))


def _checked(node: Number, size: int, place: int) -> int:
    if not 1 <= node.value <= size:
        raise Fault("script-subscript-out-of-range", node, value=f"{node.value:g}", size=size, place=place)
    return int(node.value)


def _subscript(translator: Translator, node: Expr, size: int, place: int) -> ast.expr:
    """`int(v) if 1 <= (v := …) <= size else bad_subscript(v, size, place)`."""
    variable = translator.build.fresh("s")
    value = ast.NamedExpr(ast.Name(variable, ast.Store()), translator.real(node))
    inside = ast.Compare(py.number(1), [ast.LtE(), ast.LtE()], [value, py.number(size)])
    failed = py.call("bad_subscript", py.load(variable), py.number(size), py.number(place))
    return at(ast.IfExp(inside, py.call("int", py.load(variable)), at(failed, node)), node)
