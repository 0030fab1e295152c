"""ARRAY, STATE, INTEGER, COMPLEX (book, sections 5.3.1 and 8.3.1)."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.values import SYSTEM_VARIABLES, Kind, Quantity
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.declarations import Declare, Declared, DeclaredGroup
    from desire_tui.engine.nodes.record import Node

_KINDS = {"ARRAY": Kind.REAL, "STATE": Kind.REAL, "INTEGER": Kind.INTEGER, "COMPLEX": Kind.COMPLEX}


def declare(context: StatementContext, node: Declare) -> Operation:
    """Make the operation of a declaration. Dimensions are evaluated each time it is carried out."""
    groups = [
        (group, [[context.real(d) for d in part.dimensions] for part in group.parts]) for group in node.groups
    ]

    def action() -> None:
        for group, dimensions in groups:
            shapes = [_shape(part, of) for part, of in zip(group.parts, dimensions, strict=True)]
            _declare_group(context, node, group, shapes)

    return context.then(action)


def _shape(part: Declared, dimensions: list[Callable[[], float]]) -> tuple[int, ...]:
    shape = []
    for node, evaluate in zip(part.dimensions, dimensions, strict=True):
        size = evaluate()
        truncated = whole(size, 1)
        if truncated is None:
            raise ScriptFault("bad-dimension", node, name=part.name, value=f"{size:g}")
        shape.append(truncated)
    return tuple(shape)


def _declare_group(
    context: StatementContext, node: Declare, group: DeclaredGroup, shapes: list[tuple[int, ...]]
) -> None:
    kind, is_state = _KINDS[node.kind], node.kind == "STATE"
    if kind is Kind.COMPLEX:
        _define_j(context)
    if group.whole is None:
        for part, shape in zip(group.parts, shapes, strict=True):
            _declare_one(context, part, part.name, shape, kind, is_state=is_state)
        return
    if kind is Kind.INTEGER or kind is Kind.COMPLEX:
        raise ScriptFault("overlay-not-real", group, kind=node.kind)
    total = sum(prod(shape) for shape in shapes)
    overlaid = _declare_one(context, group, group.whole, (total,), kind, is_state=is_state)
    slot = overlaid.slot
    for part, shape in zip(group.parts, shapes, strict=True):
        known = context.values.find(part.name)
        same = known is not None and known.shape == (shape or (1,)) and known.slot == slot
        if not same:
            _check_free(context, part, part.name, scalar=not shape)
            context.values.alias(part.name, shape, slot, is_state=is_state)
        slot += prod(shape)


def _declare_one(
    context: StatementContext, node: Node, name: str, shape: tuple[int, ...], kind: Kind, *, is_state: bool
) -> Quantity:
    """Make one quantity; the same declaration again zeroes it."""
    values = context.values
    known = values.find(name)
    if known is not None and (known.shape, known.kind, known.is_state) == (shape, kind, is_state) and shape:
        values.zero(known)
        return known
    _check_free(context, node, name, scalar=not shape)
    if not shape:
        return _declare_scalar(context, node, name, kind, is_state=is_state)
    if prod(shape) >= values.capacity:
        raise ScriptFault("array-too-large", node, name=name, elements=prod(shape), room=values.capacity)
    values.names.pop(name, None)
    return values.array(name, shape, kind, is_state=is_state)


def _declare_scalar(
    context: StatementContext, node: Node, name: str, kind: Kind, *, is_state: bool
) -> Quantity:
    values = context.values
    known = values.find(name)
    if known is not None and known.kind is not kind:
        if values.is_defined(known):
            raise ScriptFault("declared-twice", node, name=name, before="a number")
        values.names.pop(name)
        known = None
    made = known or values.scalar(name, kind, is_state=is_state)
    made.is_state = made.is_state or is_state
    if not values.defined[made.slot]:
        values.assign(made.slot, 0.0)
    return made


def _check_free(context: StatementContext, node: Node, name: str, *, scalar: bool) -> None:
    """Errors 28, 55, 73 for a name that is in use already."""
    scope, values = context.scope, context.values
    if name in SYSTEM_VARIABLES:
        raise ScriptFault("system-variable-declared", node, name=name)
    if name in scope.functions or name in scope.procedures:
        what = "FUNCTION" if name in scope.functions else "PROCEDURE"
        raise ScriptFault("name-of-something-else", node, name=name, what=f"a {what}")
    known = values.find(name)
    if known is None:
        return
    if known.shape:
        size = ",".join(map(str, known.shape))
        raise ScriptFault("declared-twice", node, name=name, before=f"{name}[{size}]")
    if not scalar and values.is_defined(known):
        raise ScriptFault("name-of-something-else", node, name=name, what="a number")


def _define_j(context: StatementContext) -> None:
    """Define j, the square root of −1, at the first COMPLEX line."""
    values = context.values
    known = values.find("j")
    if known is not None and known.kind is Kind.COMPLEX:
        return
    if values.names.pop("j", None) is not None:
        context.machine.forget()  # code made so far knows another j
    made = values.scalar("j", Kind.COMPLEX)
    values.assign(made.slot, 0.0)
    values.cells[made.slot + 1] = 1.0
