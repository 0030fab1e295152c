"""Scalar equations and defined variables, `d/dt x = e` and `y = e`, lowered without ceremony.

They are what large programs consist of. Where nothing about a line is unusual (no submodel's dummies, no
guard around a derivative, operands that are numbers, library functions and names that can be read here) the
ordinary way, `statements` with `expressions`, would come to the same; every other line is left to it.
"""

from __future__ import annotations

from itertools import repeat
from operator import add
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.left_chains import LONG
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.lazy_operations import new_record
from desire_tui.engine.lowered.segment import StateRange
from desire_tui.engine.lowered.statements import Deriv, Set, Where
from desire_tui.engine.lowering.lowering_cache import Cached, cache_of, known_value, parameter
from desire_tui.engine.lowering.operators import COMPOSED, OPERATIONS, power
from desire_tui.engine.lowering.written_lines import lowered_derivatives, lowered_value
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.expressions import Binary, Call, Name, Number, Unary
from desire_tui.engine.nodes.lazy_parts import written_target
from desire_tui.engine.nodes.segment import Derivative, VectorDerivative
from desire_tui.engine.quick_tuples import tuples
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.source import Span
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.builder import SegmentBuilder
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.lowering.submodels import Line
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.recently_used import RecentlyUsed

_STRETCH_FIRST, _STRETCH_MOST = 8, 128
"""Lines that are lowered together: at first, and once many have been."""
_LINES_AT_ONCE = 200
"""Between two points where the work can be broken off."""
_FUNCTIONS = {
    name: range(entry.fewest, entry.most + 1)
    for name, entry in LIBRARY.items()
    if "D" in entry.where
    and entry.kind not in {"noise", "history"}
    and name not in {"func1", "func2", *DRAWS}
}
"""Library functions that are nothing but an operation, and how many arguments they take."""


class _NotPlain(Exception):  # noqa: N818 - control flow
    """The ordinary way has to look at this expression."""


def scalar_states(context: LoweringContext, lines: Sequence[Line]) -> list[StateRange] | None:
    """Return the states of a segment whose `d/dt` lines all name different scalars as they are written.

    None: some line has to be looked at by itself. The states become states of the session here.
    """
    nodes = [node for node, _ in lines if type(node) is Derivative]
    names = [
        node.words[node.form.target] if node.form is not None else node.target.name
        for node in nodes
        if node.form is not None or type(node.target) is Name
    ]
    if (
        not names
        or len(names) != len(nodes)
        or VectorDerivative in {type(node) for node, _ in lines}
        or len({*names}) != len(names)
        or "PI" in names
        or not context.functions.keys().isdisjoint(names)
    ):
        return None
    slots = context.scope.states(names)
    if slots is None or len({*slots}) != len(slots):
        return None
    offsets = [frame.at for node, frame in lines if type(node) is Derivative]
    starts = map(add, offsets, [node.start for node in nodes])
    places = tuples(
        Where, tuples(Span, starts, map(add, offsets, [node.end for node in nodes])), repeat(None)
    )
    states: list[StateRange] = []
    for number, (name, slot, where) in enumerate(zip(names, slots, places, strict=True)):
        state: StateRange = new_record(StateRange)  # a third of the time of its constructor
        state.name, state.slot, state.first, state.count, state.where = name, slot, number, 1, where  # type: ignore[misc]  # frozen for the type checker only
        states.append(state)
    context.plain_states = dict(zip(map(id, nodes), states, strict=True))
    return states


def lower_plain_lines(builder: SegmentBuilder, lines: Sequence[Line], at: int) -> int:
    """Lower lines from number `at` on; return the number of the first that is not one of these."""
    context = builder.context
    if not context.reads_as_written:
        return at
    cancellation_point()
    flow, body = context.flow, builder.body
    states = {} if builder.guards else context.plain_states
    cache = cache_of(context)
    stretch = _STRETCH_FIRST
    for _ in range(_LINES_AT_ONCE):
        if at == len(lines):
            break
        node, frame = lines[at]
        if type(node) is Derivative and node.form is not None and states:
            wanted = lines[at : at + stretch]  # growing, so that most of what is looked at is taken
            made = lowered_derivatives(context, wanted, states, cache)
            body += made
            at += len(made)
            stretch = min(2 * stretch, _STRETCH_MOST) if len(made) == stretch else _STRETCH_FIRST
            if made:
                continue
        if type(node) is Derivative:
            state = states.get(id(node))
            value = None if state is None else _lowered(context, node, cache)
            if state is None or value is None:
                break
            body.append(Deriv(state.first, value, state.where))
        elif type(node) is Assign and (name := _scalar_name(node)) is not None:
            slot = _slot_of(context, name)
            value = None if slot is None else _lowered(context, node, cache)
            if slot is None or value is None:
                break
            definition = Set(slot, value, Where(Span(frame.at + node.start, frame.at + node.end)))
            body.append(definition)
            flow.assignments.append(definition)
            flow.set_slots[slot] = None
            flow.ready[name] = Load(slot)
        else:
            break
        at += 1
    return at


def _scalar_name(node: Assign) -> str | None:
    """Return the name of the scalar that a statement assigns; None: an element."""
    known = written_target(node)
    return known if known is not None or type(node.target) is not Name else node.target.name


def _slot_of(context: LoweringContext, name: str) -> int | None:
    """Return the slot of a scalar that may be assigned."""
    quantity = context.scope.names.get(name)
    if quantity is None or quantity.shape or quantity.kind is not Kind.REAL:
        return None
    return None if name == "PI" or name in context.functions else quantity.slot


def _lowered(
    context: LoweringContext, line: Derivative | Assign, cache: RecentlyUsed[int, Cached]
) -> Value | None:
    """Lower a line's expression, and keep it; None: it is left to the ordinary way."""
    if line.form is not None:
        return lowered_value(context, line, cache)
    node = line.value
    known = known_value(context, node, cache)
    if known is not None:
        return known
    reads: dict[str, int] = {}
    try:
        value = _value(context, node, reads)
    except (_NotPlain, RecursionError):
        return None
    cache.keep(id(node), Cached(node, tuple(reads.items()), value))
    return value


def _value(context: LoweringContext, node: Expr, reads: dict[str, int]) -> Value:
    if type(node) is Binary:
        operation = OPERATIONS.get(node.op)
        if operation is None or node.end - node.start >= LONG:
            return _power(context, node, reads)
        ready = context.flow.ready.get
        left, right = node.left, node.right
        if type(left) is Name and (load := ready(left.name)) is not None:  # most of what there is
            reads[left.name] = load.slot
            first: Value = load
        else:
            first = Const(left.value) if type(left) is Number else _value(context, left, reads)
        if type(right) is Name and (load := ready(right.name)) is not None:
            reads[right.name] = load.slot
            return Op(operation, (first, load))
        return Op(operation, (first, _value(context, right, reads)))
    if type(node) is Name:
        load = context.flow.ready.get(node.name) or parameter(context, node.name)
        if load is None:
            raise _NotPlain
        reads[node.name] = load.slot
        return load
    if type(node) is Number:
        return Const(node.value)
    if type(node) is Unary:
        operand = _value(context, node.operand, reads)
        if node.op == "+":
            return operand
        return Const(-operand.value) if isinstance(operand, Const) else Op("neg", (operand,))
    if type(node) is Call and len(node.args) in _FUNCTIONS.get(node.name, ()):
        args = tuple([_value(context, argument, reads) for argument in node.args])
        composed = COMPOSED.get(node.name)
        return Op(node.name, args) if composed is None else composed(*args)
    raise _NotPlain


def _power(context: LoweringContext, node: Binary, reads: dict[str, int]) -> Value:
    if node.op != "^":
        raise _NotPlain
    return power(_value(context, node.left, reads), _value(context, node.right, reads))
