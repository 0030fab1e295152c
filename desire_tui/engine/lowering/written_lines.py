"""Scalar equations and defined variables lowered from their forms and words, without looking at their nodes.

`d/dt v12 = a*(i11 - i12)` and a thousand lines like it are one form (`nodes.lazy_parts`): the operations are
found once, the slots of the names a column at a time. What comes out is what `plain_lines` makes of nodes.
"""

from __future__ import annotations

from contextlib import suppress
from itertools import takewhile
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.lazy_operations import new_record
from desire_tui.engine.lowered.statements import Deriv
from desire_tui.engine.lowering.lowering_cache import Cached, Stretch, can_read, parameter, stretches_of
from desire_tui.engine.lowering.operators import OPERATIONS
from desire_tui.engine.nodes.expressions import Binary, Name, Number, Unary
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.lazy_operations import Leaves
    from desire_tui.engine.lowered.segment import StateRange
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.lowering.submodels import Line
    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.expressions import Expr


class FormOutline:
    """The operations of a form's expression over word numbers (`lowered.lazy_operations.Outline`).

    `leaves`: for each slot or number, from left to right, its word's number, and how its word is read:
    0 as a name, 1 as a number, -1 as a number with its sign changed.
    """

    __slots__ = ("key", "leaves", "value")

    def __init__(self, value: Expr) -> None:
        self.value = value
        key: list[object] = []
        self.leaves: list[tuple[int, int]] = []
        self._collect(value, key)
        self.key = tuple(key)

    def _collect(self, node: Expr, key: list[object]) -> None:
        number = _number(node)
        if number is not None:
            key.append(None)
            self.leaves.append(number)
        elif isinstance(node, Name):
            key.append(None)
            self.leaves.append((int(node.name[1:]), 0))
        elif isinstance(node, Binary):
            key.append(OPERATIONS[node.op])
            self._collect(node.left, key)
            self._collect(node.right, key)
        else:
            assert isinstance(node, Unary)
            if node.op == "-":
                key.append("neg")
            self._collect(node.operand, key)

    def filled(self, leaves: Leaves) -> Op:
        """Return the expression over these slots and numbers."""
        made = _filled(self.value, iter(leaves))
        assert isinstance(made, Op)
        return made


def _filled(node: Expr, leaves: Iterator[int | float]) -> Value:
    if _number(node) is not None:
        return Const(next(leaves))
    if isinstance(node, Binary):
        left = _filled(node.left, leaves)
        return Op(OPERATIONS[node.op], (left, _filled(node.right, leaves)))
    if isinstance(node, Unary):
        operand = _filled(node.operand, leaves)
        return operand if node.op == "+" else Op("neg", (operand,))
    slot = next(leaves)
    assert isinstance(slot, int)
    return Load(slot)


def _number(node: Expr) -> tuple[int, int] | None:
    """Return the word of a number, and 1, or -1 if an odd number of signs stands before it."""
    sign = 1
    while isinstance(node, Unary):
        sign = -sign if node.op == "-" else sign
        node = node.operand
    return (int(node.value), sign) if isinstance(node, Number) else None


_OUTLINES_ROOM = 500
_outlines: RecentlyUsed[int, FormOutline] = RecentlyUsed(_OUTLINES_ROOM)
"""By the id of a form's expression, which the outline holds."""


def _outline_of(value: Expr) -> FormOutline:
    known = _outlines[id(value)]
    if known is None:
        known = FormOutline(value)
        _outlines.keep(id(value), known)
    return known


def lowered_value(
    context: LoweringContext, node: Derivative | Assign, cache: RecentlyUsed[int, Cached]
) -> Value | None:
    """Return the value of a statement that has a form; None: a name cannot be read without more ado."""
    assert node.form is not None
    outline = _outline_of(node.form.value)
    ready, words = context.flow.ready, node.words
    leaves: list[int | float] = []
    for word, sign in outline.leaves:
        if sign:
            leaves.append(float(words[word]) if sign > 0 else -float(words[word]))
            continue
        load = ready.get(words[word]) or parameter(context, words[word])
        if load is None:
            return None
        leaves.append(load.slot)
    return _value(node, outline, tuple(leaves), cache)


def lowered_derivatives(
    context: LoweringContext,
    lines: Sequence[Line],
    states: Mapping[int, StateRange],
    cache: RecentlyUsed[int, Cached],
) -> list[Deriv]:
    """Return the first of some lines lowered: `d/dt` lines that have forms, and names that can be read."""
    nodes: list[Derivative] = []
    targets: list[StateRange] = []
    for node, _ in lines:
        if type(node) is not Derivative or node.form is None:
            break
        state = states.get(id(node))
        if state is None:
            break
        nodes.append(node)
        targets.append(state)
    made: list[Deriv] = []
    for state, value in zip(targets, _values(context, nodes, cache), strict=False):
        line: Deriv = new_record(Deriv)  # a third of the time of its constructor
        line.state, line.value, line.where = state.first, value, state.where  # type: ignore[misc]  # frozen for the type checker only
        made.append(line)
    return made


def _values(
    context: LoweringContext, nodes: Sequence[Derivative | Assign], cache: RecentlyUsed[int, Cached]
) -> list[Value]:
    """Return the values of the first of some statements with forms, up to one that cannot be read."""
    stretches = stretches_of(context)
    key = tuple(map(id, nodes))
    known = stretches[key]
    if known is not None and can_read(context, known.reads):
        return known.values
    reads: dict[str, int] = {}
    values = _values_anew(context, nodes, cache, reads)
    if len(values) == len(nodes) > 1:
        stretches.keep(key, Stretch(nodes, tuple(reads.items()), values))
    return values


def _values_anew(
    context: LoweringContext,
    nodes: Sequence[Derivative | Assign],
    cache: RecentlyUsed[int, Cached],
    reads: dict[str, int],
) -> list[Value]:
    """Return the same, a form's statements after the other's; note the slots of their names."""
    expressions = [node.form.value for node in nodes if node.form is not None]
    alike = {id(expression): expression for expression in expressions}
    if len(alike) == 1:
        return _values_alike(context, expressions[0], nodes, cache, reads)
    values: list[Value | None] = [None] * len(nodes)
    for expression in alike.values():
        numbers = [number for number, other in enumerate(expressions) if other is expression]
        found = _values_alike(context, expression, [nodes[number] for number in numbers], cache, reads)
        for number, value in zip(numbers, found, strict=False):
            values[number] = value
    return [*takewhile(lambda value: value is not None, values)]  # type: ignore[list-item]  # as it says


def _values_alike(
    context: LoweringContext,
    expression: Expr,
    nodes: Sequence[Derivative | Assign],
    cache: RecentlyUsed[int, Cached],
    reads: dict[str, int],
) -> list[Value]:
    """Return the values of the first of some statements with the same operations."""
    outline = _outline_of(expression)
    rows = _leaves(context, outline, [node.words for node in nodes], reads)
    return [_value(node, outline, leaves, cache) for node, leaves in zip(nodes, rows, strict=False)]


def _value(
    node: Derivative | Assign,
    outline: FormOutline,
    leaves: tuple[int | float, ...],
    cache: RecentlyUsed[int, Cached],
) -> Value:
    """Return a statement's value, the same as the last time if its leaves are."""
    known = cache[id(node)]
    if known is not None and type(known.value) is Op and known.value.leaves == leaves:
        return known.value
    made: Op = new_record(Op)
    made.outline, made.leaves = outline, leaves
    cache.keep(id(node), Cached(node, (), made))
    return made


def _leaves(
    context: LoweringContext, outline: FormOutline, lines: Sequence[Sequence[str]], reads: dict[str, int]
) -> list[tuple[int | float, ...]]:
    """Return slots and numbers of lines of a form, from their words, up to a line that cannot be read."""
    columns: list[list[int] | list[float]] = []
    for word, sign in outline.leaves:
        words = [line[word] for line in lines]
        if sign:
            columns.append([*map(float, words)] if sign > 0 else [-float(word) for word in words])
        else:
            slots = _slots(context, words)
            reads.update(zip(words, slots, strict=False))
            columns.append(slots)
    return [*zip(*columns, strict=False)]


def _slots(context: LoweringContext, names: Sequence[str]) -> list[int]:
    """Return the slots of names, up to one that cannot be read."""
    ready = context.flow.ready
    with suppress(KeyError):
        return [ready[name].slot for name in names]
    found: list[int] = []
    for name in names:
        load = ready.get(name) or parameter(context, name)
        if load is None:
            break
        found.append(load.slot)
    return found


def age() -> None:
    """Between two segments: forget forms that no program of late had."""
    _outlines.age()
