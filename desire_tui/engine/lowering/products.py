"""Whole arrays in vector and matrix expressions: conformability, matrix products, outer products, recursion.

Elements are assigned in place, from the last to the first, each seeing what stands in memory then. For an
array that overlays the target this is meant so (a recurrent net: `Vector v = tanh(W*xx)` with v a part of
xx); the target itself in its own matrix product, or shifted by k > 0, is error 85 (compatibility.md).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.left_chains import PIECE, is_long
from desire_tui.engine.library import shifted_by
from desire_tui.engine.lowered.expressions import MatVec, Op, Outer, PatternRow, ShiftedVec, Vec
from desire_tui.engine.lowering.lowering_context import BAD
from desire_tui.engine.lowering.operators import OPERATIONS
from desire_tui.engine.lowering.scope import UNKNOWN, agree, size_of
from desire_tui.engine.lowering.subscripts import constant
from desire_tui.engine.nodes.expressions import Binary, Name, Transposed
from desire_tui.engine.nodes.expressions import RowOf as RowOfNode
from desire_tui.engine.nodes.expressions import Shifted as ShiftedNode
from desire_tui.engine.nodes.signs import unsigned
from desire_tui.engine.values import Kind, Quantity

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Expr


def product(
    context: LoweringContext, node: Binary, extent: Extent, keep: Callable[[Value], Value] | None = None
) -> Value:
    """Lower a chain of factors from left to right, with `A*x`, `A%*x`, `u*v`, `u & v` as units.

    `keep` computes the first factors of a long chain beforehand, and factors that are long themselves.
    """
    factors: list[tuple[str, Expr]] = []
    rest: Expr = node
    while isinstance(rest, Binary) and rest.op in "*/&":
        factors.append((rest.op, rest.right))
        rest = rest.left
    factors.append(("*", rest))
    factors.reverse()
    result: Value | None = None
    at = 0
    while at < len(factors):
        op, factor = factors[at]
        following = factors[at + 1] if at + 1 < len(factors) else None
        value = _signed_unit(context, factor, following, extent) if following else None
        if value is None:
            if op == "&":
                context.report("ampersand-here", factor)
                op = "*"
            long = keep is not None and is_long(factor)
            if long and keep is not None and result is not None:
                result = keep(result)
            value = context.lower(factor, extent)
            if long and keep is not None:
                value = keep(value)
        else:
            at += 1
        if keep is not None and result is not None and at % PIECE == 0:
            result = keep(result)
        result = value if result is None else Op(OPERATIONS.get(op, "mul"), (result, value))
        at += 1
    assert result is not None
    return result


def operand(context: LoweringContext, node: Expr, extent: Extent) -> Value:
    """Lower a whole array that stands alone. Errors 74, 75, 69, 218, 84."""
    if not extent:
        name = getattr(node, "name", "")
        key = "array-as-number" if isinstance(node, Name) else "vector-as-number"
        return context.report(key, node, name=context.actual(name))
    if isinstance(node, Transposed):
        return context.report("matrix-needs-vector", node, name=f"{context.actual(node.name)}%")
    quantity = array(context, node)
    if quantity is None:
        return BAD
    if isinstance(node, RowOfNode):
        return _row(context, node, quantity, extent)
    if len(quantity.shape) != len(extent):
        return _wrong_rank(context, node, quantity, extent)
    if not all(agree(a, b) for a, b in zip(quantity.shape, extent, strict=True)):
        return nonconformable(context, node, quantity.name, quantity.shape, extent)
    count = _count(extent)
    if isinstance(node, ShiftedNode):
        if len(extent) != 1:
            return context.report("shift-in-matrix", node)
        by = constant(context, node.by)
        shift = shifted_by(by, max(count, 1)) if by is not None else 0
        note_read(context, node, quantity.slot, count, shift)
        return ShiftedVec(quantity.slot, count, shift)
    note_read(context, node, quantity.slot, count, 0)
    return Vec(quantity.slot, count)


def unknown(context: LoweringContext, node: Name) -> Value:
    """Report error 70: a name in a vector expression that is neither array nor number."""
    name = context.actual(node.name)
    if context.first_report(name):
        close = closest(name, context.scope.names)
        context.report("undefined-in-vector", node, name=name, close=close)
    return BAD


def array(context: LoweringContext, node: Expr, missing: str = "undefined-in-vector") -> Quantity | None:
    """Return the REAL array that a name, shifted name or row selector stands for. Errors 70, 218."""
    assert isinstance(node, Name | ShiftedNode | RowOfNode), "the grammar lets nothing else stand here"
    name = node.name
    quantity = context.quantity(name)
    actual = context.actual(name)
    if quantity is None or not quantity.shape:
        if quantity is not None or actual in context.assigned:
            context.report("number-as-array", node, name=actual)
        elif context.first_report(actual):
            arrays = (q.name for q in context.scope.names.values() if q.shape)
            context.report(missing, node, name=actual, close=closest(actual, arrays))
        return None
    if quantity.kind is Kind.COMPLEX:
        context.report("complex-in-dynamic", node, name=actual)
        return None
    return quantity


def nonconformable(
    context: LoweringContext, node: Expr, name: str, shape: tuple[int, ...], extent: Extent
) -> Value:
    """Report error 74."""
    return context.report("shapes-disagree", node, name=name, shape=_shown(shape), wanted=_shown(extent))


def note_read(context: LoweringContext, node: Expr, slot: int, count: int, shift: int | None) -> None:
    """Note that an array is read; error 85 where the target's own elements would be read once replaced.

    `shift`: element i reads element i + shift; None: every element reads the whole array.
    """
    if count <= 0:
        return
    if context.assigned_arrays:
        context.flow.read_range(slot, count)
    if context.assigned_slots is None:
        return
    start, size = context.assigned_slots
    own = isinstance(node, Name | ShiftedNode) and context.actual(node.name) == context.assigned_array
    if own and slot < start + size and start < slot + count and (shift is None or slot + shift > start):
        context.report("vector-recursion", node)


def matrix_vector(
    context: LoweringContext, matrix: Expr, vector: Expr, rows: int, *, checked: bool = True
) -> MatVec | None:
    """Lower `A*x` or `A%*x` of `rows` elements; None if the nodes are not a matrix and a vector."""
    a, x = _shaped(context, matrix, 2), _shaped(context, vector, 1)
    if a is None or x is None or not isinstance(vector, Name) or not isinstance(matrix, Name | Transposed):
        return None
    transposed = isinstance(matrix, Transposed)
    outer, inner = (a.shape[1], a.shape[0]) if transposed else (a.shape[0], a.shape[1])
    if checked and not agree(outer, rows):
        nonconformable(context, matrix, f"{a.name}{'%' if transposed else ''}", (outer, inner), (rows, inner))
    if not agree(inner, x.shape[0]):
        nonconformable(context, vector, x.name, x.shape, (inner,))
    note_read(context, vector, x.slot, x.shape[0], None)
    note_read(context, matrix, a.slot, size_of(a), None)
    return MatVec(a.slot, a.shape[0], a.shape[1], transposed, x.slot)


def _signed_unit(
    context: LoweringContext, factor: Expr, following: tuple[str, Expr], extent: Extent
) -> Value | None:
    """Lower a unit whose factors may have signs: `-A*x`, `3*-u*v`."""
    op, right = following
    (sign, first), (other, second) = unsigned(factor), unsigned(right)
    value = _unit(context, first, (op, second), extent)
    return value if value is None or sign * other > 0 else Op("neg", (value,))


def _unit(
    context: LoweringContext, factor: Expr, following: tuple[str, Expr], extent: Extent
) -> Value | None:
    op, right = following
    if len(extent) == 1:
        return matrix_vector(context, factor, right, extent[0]) if op == "*" else None
    u, v = _shaped(context, factor, 1), _shaped(context, right, 1)
    if u is None or v is None or op == "/" or not isinstance(factor, Name) or not isinstance(right, Name):
        return None
    for part, vector, wanted in ((factor, u, extent[0]), (right, v, extent[1])):
        if not agree(vector.shape[0], wanted):
            nonconformable(context, part, vector.name, vector.shape, (wanted,))
        note_read(context, part, vector.slot, vector.shape[0], None)
    how: Literal["mul", "min"] = "min" if op == "&" else "mul"
    return Outer(how, u.slot, u.shape[0], v.slot, v.shape[0])


def _shaped(context: LoweringContext, node: Expr, rank: int) -> Quantity | None:
    if not isinstance(node, Name | Transposed):
        return None
    quantity = context.quantity(node.name)
    if quantity is None or len(quantity.shape) != rank or quantity.kind is Kind.COMPLEX:
        return None
    return quantity


def _row(context: LoweringContext, node: RowOfNode, quantity: Quantity, extent: Extent) -> Value:
    if len(quantity.shape) != 2 or len(extent) != 1:
        return context.report("row-of-matrix", node, name=quantity.name)
    if not agree(quantity.shape[1], extent[0]):
        return nonconformable(context, node, f"{quantity.name}#", quantity.shape[1:], extent)
    note_read(context, node, quantity.slot, size_of(quantity), None)
    if "iRow" in context.assigned:
        context.row_read = context.where(node)
    elif context.row_chosen is None:
        context.row_chosen = context.where(node)
    return PatternRow(quantity.slot, quantity.shape[0], quantity.shape[1])


def _wrong_rank(context: LoweringContext, node: Expr, quantity: Quantity, extent: Extent) -> Value:
    if len(extent) == 1 and len(quantity.shape) == 2:
        return context.report("matrix-needs-vector", node, name=quantity.name)
    if len(extent) == 2 and len(quantity.shape) == 1:
        return context.report("vector-in-matrix", node, name=quantity.name)
    return nonconformable(context, node, quantity.name, quantity.shape, extent)


def _count(extent: Extent) -> int:
    total = 1
    for n in extent:
        total *= n
    return UNKNOWN if UNKNOWN in extent else total


def _shown(shape: tuple[int, ...]) -> str:
    return "[" + ",".join("?" if n == UNKNOWN else str(n) for n in shape) + "]"
