"""Vector, matrix and DOT statements of a segment (language.md 9.2, 9.3)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.left_chains import signed_terms
from desire_tui.engine.lowered.expressions import Op, Outer, Vec
from desire_tui.engine.lowered.statements import DotTerm, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.lowering.products import array, matrix_vector, nonconformable, note_read
from desire_tui.engine.lowering.scope import UNKNOWN, agree, size_of
from desire_tui.engine.lowering.targets import mark_array, mark_set, matrix, scalar_slot, states, vector
from desire_tui.engine.nodes.expressions import Binary, Name, Number
from desire_tui.engine.nodes.signs import unsigned

if TYPE_CHECKING:
    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.assignments import Dot, MatrixAssign, VectorAssign
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.segment import VectorDerivative
    from desire_tui.engine.values import Quantity


def vector_assign(builder: SegmentBuilder, node: VectorAssign) -> None:
    """`Vector y = v`, `Vectr delta x = v; min, max`, `Vector y^ = v`, `Vector y = [m] v`."""
    context = builder.context
    quantity = _target(context, node)
    if quantity is None:
        return
    count = quantity.shape[0]
    mask = _mask(builder, node, node.mask, (count,))
    context.assigned_slots, context.assigned_array = (quantity.slot, count), quantity.name
    if node.delta:
        context.flow.read_range(quantity.slot, count)
    value = context.lower(node.value, (count,))
    mode: Literal["set", "add", "largest"] = "add" if node.delta else "largest" if node.largest else "set"
    if node.lower is not None and node.upper is not None:
        lower, upper = context.lower(node.lower, (count,)), context.lower(node.upper, (count,))
        added = Op("add", (Vec(quantity.slot, count), value))
        value, mode = Op("min", (Op("max", (added, lower)), upper)), "set"
    context.assigned_slots = None
    made = SetVec(quantity.slot, count, value, context.where(node), mode, mask)
    builder.body.append(made)
    context.flow.assignments.append(made)
    mark_array(context, quantity.slot, count)


def vector_derivative(builder: SegmentBuilder, node: VectorDerivative) -> None:
    """`Vectr d/dt x = v`, and `MAT d/dt S = sum` of a whole matrix. Error 101 for a second one."""
    context = builder.context
    quantity = states(context, node, node.name)
    if quantity is None:
        known = context.quantity(node.name)
        context.lower(node.value, known.shape if known is not None and known.shape else (UNKNOWN,))
        return
    count = size_of(quantity)
    value = context.lower(node.value, quantity.shape)
    if count != UNKNOWN and any(isinstance(part, Outer) for part in walk_values(value)):
        whole = context.scope.hidden(count)
        rows, columns = quantity.shape
        builder.body.append(SetMat(whole, rows, columns, value, context.where(node)))
        value = Vec(whole, count)
    if count != UNKNOWN:
        if builder.is_second_derivative(quantity.slot, count):
            context.report("state-twice", node, name=quantity.name)
        elif other := builder.overlaid(quantity.slot, count, quantity):
            context.report("state-twice-overlaid", node, name=quantity.name, other=other)
    builder.derivative(quantity.slot, count, value, context.where(node), array=True)


def _target(context: LoweringContext, node: VectorAssign) -> Quantity | None:
    """Return the vector that a statement assigns; None: there is none, its right side has been checked."""
    quantity = vector(context, node, node.name)
    if quantity is None:
        context.lower(node.value, (UNKNOWN,))
    return quantity


def matrix_assign(builder: SegmentBuilder, node: MatrixAssign) -> None:
    """`MATRIX W = [M] sum; min, max` and `DELTA W = …`."""
    context = builder.context
    quantity = matrix(context, node, node.name)
    if quantity is None:
        return
    rows, cols = quantity.shape
    size = size_of(quantity)
    mask = _mask(builder, node, node.mask, (rows, cols))
    context.assigned_slots, context.assigned_array = (quantity.slot, size), quantity.name
    if node.delta or mask is not None:
        context.flow.read_range(quantity.slot, size)
    value = context.lower(node.value, (rows, cols))
    lower_bound = None if node.lower is None else context.lower(node.lower, (rows, cols))
    upper_bound = None if node.upper is None else context.lower(node.upper, (rows, cols))
    context.assigned_slots = None
    made = SetMat(
        quantity.slot, rows, cols, value, context.where(node), "add" if node.delta else "set",
        lower_bound, upper_bound, mask,
    )  # fmt: skip
    builder.body.append(made)
    context.flow.assignments.append(made)
    mark_array(context, quantity.slot, size)


def dot(builder: SegmentBuilder, node: Dot) -> None:
    """`DOT s = u*v + u*1 + u*A*v`, `AVG s = …`: operands are names."""
    context = builder.context
    slot = scalar_slot(context, node.target)
    terms: list[DotTerm] = []
    for sign, term in signed_terms(node.value):
        made = _dot_term(builder, sign, term)
        if made is not None:
            terms.append(made)
    if node.average:
        for other in terms[1:]:
            if not agree(other.left.count, terms[0].left.count):
                context.report("average-lengths", node)
                break
    if slot is not None:
        done = SetDot(slot, tuple(terms), node.average, context.where(node))
        builder.body.append(done)
        context.flow.assignments.append(done)
        mark_set(context, node.target, slot)


def _dot_term(builder: SegmentBuilder, sign: float, node: Expr) -> DotTerm | None:
    context = builder.context
    factors: list[Expr] = []
    rest = node
    while isinstance(rest, Binary) and rest.op == "*":
        factors.append(rest.right)
        rest = rest.left
    leading, first = unsigned(rest)
    sign *= leading
    factors.append(first)
    factors.reverse()
    if len(factors) not in (2, 3) or not isinstance(first, Name):
        context.report("dot-term", node)
        return None
    u = array(context, first)
    if u is None:
        return None
    if len(u.shape) != 1:
        context.report("vector-target", first, name=u.name, dimensions=len(u.shape))
        return None
    count = u.shape[0]
    note_read(context, first, u.slot, count, 0)
    left = Vec(u.slot, count)
    if len(factors) == 3:
        product = matrix_vector(context, factors[1], factors[2], count)
        if product is None:
            context.report("dot-term", node)
            return None
        return DotTerm(sign, left, product)
    second = factors[1]
    if isinstance(second, Number) and second.value == 1.0:
        return DotTerm(sign, left, None)
    if not isinstance(second, Name):
        context.report("dot-term", second)
        return None
    v = array(context, second)
    if v is None:
        return None
    if len(v.shape) != 1 or not agree(v.shape[0], count):
        nonconformable(context, second, v.name, v.shape, (count,))
        return None
    note_read(context, second, v.slot, v.shape[0], 0)
    return DotTerm(sign, left, Vec(v.slot, count))


def _mask(builder: SegmentBuilder, node: Node, name: str | None, extent: tuple[int, ...]) -> int | None:
    """Return the slot of a mask array of the right shape. Error 74."""
    if name is None:
        return None
    context = builder.context
    place = Name(name, node.start, node.end)
    quantity = array(context, place)
    if quantity is None:
        return None
    same = len(quantity.shape) == len(extent) and all(
        agree(a, b) for a, b in zip(quantity.shape, extent, strict=True)
    )
    if not same:
        nonconformable(context, place, quantity.name, quantity.shape, extent)
        return None
    note_read(context, place, quantity.slot, size_of(quantity), 0)
    return quantity.slot
