"""Small vector models as scalar ones: statements over vectors written out for each element.

The operations of each element, and their order, are those of the loops in `codegen.vector`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.effects import reads_replaced
from desire_tui.engine.lowered.expressions import (
    Const,
    ElementOperand,
    Load,
    MatVec,
    Op,
    Outer,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.lowered.segment import Event
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetDot, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_values, with_bodies
from desire_tui.engine.random_sequence import DRAWS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

_SUMS = 8
"""Products of a row of a matrix are added up in so many sums (`codegen.vector.products`)."""
_ELEMENT_MOST = 10_000
"""Operations of one element that `element_of` writes out."""
_ZERO = Const(0.0)


class TooManyError(Exception):
    """There would be more numbers than are wanted."""


class WrittenOut(NamedTuple):
    """A segment without statements over vectors, as far as they can be written out."""

    segment: Segment
    over_elements: frozenset[int]
    """Identities of the operations that belong to elements: their functions are the vector library's."""


def scalar_elements(segment: Segment, most: int) -> WrittenOut:
    """Return a segment written out. TooManyError: it would hold more than `most` operations."""
    writer = _Writer(most)
    body = tuple(writer.actions(segment.body))
    events = tuple(writer.event(event) for event in segment.events)
    if not writer.written:
        return WrittenOut(segment, frozenset())
    return WrittenOut(replace(segment, body=body, events=events), frozenset(writer.over_elements))


def element_of(value: Value, at: int) -> Value | None:
    """Return element `at` (of a matrix: row by row) of an expression; None: it cannot be written out.

    A product of vectors is not: it has a line of its own.
    """
    if any(isinstance(node, Outer) for node in walk_values(value)):
        return None
    try:
        made = _Element(_Writer(_ELEMENT_MOST), at).value(value)
    except TooManyError:
        return None
    return None if any(isinstance(node, ElementOperand) for node in walk_values(made)) else made


class _Writer:
    def __init__(self, most: int) -> None:
        self._left = most
        self.written = False
        self.over_elements = set[int]()

    def actions(self, actions: Iterable[Action]) -> Iterator[Action]:
        """Yield statements; what cannot be written out is left as it is.

        Of a vector the last element comes first: so random numbers are drawn, and so it changes if it reads
        itself.
        """
        for action in actions:
            match action:
                case Guard():
                    yield with_bodies(
                        action, tuple(self.actions(action.body)), tuple(self.actions(action.orelse))
                    )
                case SetVec(mask_slot=None) if action.mode != "largest" and not reads_replaced(action):
                    yield from self._vector(action)
                case SetMat(mask_slot=None) if _are_numbers(action) and not reads_replaced(action):
                    yield from self._matrix(action)
                case SetDot():
                    self.written = True
                    value = self._dot(action)
                    yield Set(action.slot, value, action.where, action.persistent)
                case DerivVec():
                    self.written = True
                    for at in reversed(range(action.count)):
                        value = _Element(self, at).value(action.value)
                        yield Deriv(action.state + at, value, action.where)
                case _:
                    yield action

    def event(self, event: Event) -> Event:
        """Return an event with its block written out."""
        body = tuple(self.actions(event.body))
        return Event(body, event.where, event.condition, event.period, event.start)

    def _vector(self, action: SetVec) -> Iterator[Action]:
        self.written = True
        for at in reversed(range(action.count)):
            value = _Element(self, at).value(action.value)
            if action.mode == "add":
                value = self.op("add", Load(action.slot + at), value)
            persistent = action.persistent or action.mode == "add"
            yield Set(action.slot + at, value, action.where, persistent)

    def _matrix(self, action: SetMat) -> Iterator[Action]:
        self.written = True
        for at in reversed(range(action.rows * action.cols)):
            value = _Element(self, at).value(action.value)
            if action.mode == "add":
                value = self.op("add", Load(action.slot + at), value)
            if action.lower is not None:
                value = self.op("max", value, action.lower)
            if action.upper is not None:
                value = self.op("min", value, action.upper)
            yield Set(action.slot + at, value, action.where, action.persistent or action.mode == "add")

    def _dot(self, action: SetDot) -> Value:
        total: Value = _ZERO
        for term in action.terms:
            parts: list[Value] = []
            for at in range(term.left.count):
                left, element = Load(term.left.slot + at), _Element(self, at)
                parts.append(left if term.right is None else self.op("mul", left, element.value(term.right)))
            value = self._total(parts)
            total = self.op(
                "add", total, value if term.sign == 1.0 else self.op("mul", value, Const(term.sign))
            )
        if action.average and action.terms:
            total = self.op("div", total, Const(float(action.terms[0].left.count)))
        return total

    def _total(self, parts: Sequence[Value]) -> Value:
        """Return the sum of many numbers, as `codegen.vector.products` adds them up."""
        main = len(parts) // (2 * _SUMS) * 2 * _SUMS
        if not main:
            return self.sum(_ZERO, parts)
        both = [self.sum(_ZERO, parts[lane : main : 2 * _SUMS]) for lane in range(2 * _SUMS)]
        sums = [
            self.op("add", first, second) for first, second in zip(both[:_SUMS], both[_SUMS:], strict=True)
        ]
        return self.sum(self.in_pairs(sums), parts[main:])

    def in_pairs(self, sums: Sequence[Value]) -> Value:
        """Add up neighbours, then their sums, and so on."""
        while len(sums) > 1:
            sums = [self.op("add", a, b) for a, b in zip(sums[::2], sums[1::2], strict=True)]
        return sums[0]

    def sum(self, first: Value, parts: Sequence[Value]) -> Value:
        """Add up numbers one by one."""
        total = first
        for part in parts:
            total = self.op("add", total, part)
        return total

    def op(self, name: str, *args: Value) -> Op:
        """Return an operation of an element."""
        self._left -= 1
        if self._left < 0:
            raise TooManyError
        made = Op(name, args)
        self.over_elements.add(id(made))
        return made


class _Element:
    """Values of one element of a statement; an object met again is the same object."""

    def __init__(self, writer: _Writer, at: int) -> None:
        self._writer, self._at = writer, at
        self._known: dict[int, Value] = {}

    def value(self, node: Value) -> Value:
        """Return what the element is."""
        known = self._known.get(id(node))
        if known is None:
            known = self._known[id(node)] = self._made(node)
        return known

    def _made(self, node: Value) -> Value:
        if not any(isinstance(n, ElementOperand) or _draws(n) for n in walk_values(node)):
            return node  # one number for all elements
        match node:
            case Vec():
                return Load(node.slot + self._at)
            case ShiftedVec():
                at = self._at + node.by
                return Load(node.slot + at) if 0 <= at < node.count else _ZERO
            case MatVec():
                return self._product(node)
            case Outer():
                u, v = (
                    Load(slot + at)
                    for slot, at in zip(
                        (node.u_slot, node.v_slot), divmod(self._at, node.v_count), strict=True
                    )
                )
                return self._writer.op(node.op, u, v)
            case Op():
                return self._writer.op(node.name, *map(self.value, node.args))
            case Table1():
                return Table1(self.value(node.x), node.slot, node.count)
            case Table2():
                x, y = self.value(node.x), self.value(node.y)
                return Table2(x, y, node.f_slot, node.rows, node.cols, node.x_slot, node.y_slot)
            case _:
                return node  # refused later, as an operand over elements

    def _product(self, node: MatVec) -> Value:
        op, add_up = self._writer.op, self._writer.sum
        if node.transposed:
            first, step, terms = node.slot + self._at, node.cols, node.rows
        else:
            first, step, terms = node.slot + self._at * node.cols, 1, node.cols
        parts: list[Value] = [op("mul", Load(first + k * step), Load(node.x_slot + k)) for k in range(terms)]
        if node.transposed:
            return add_up(_ZERO, parts)
        main = terms // _SUMS * _SUMS
        sums = [add_up(_ZERO, parts[lane:main:_SUMS]) for lane in range(_SUMS)]
        return add_up(self._writer.in_pairs(sums), parts[main:])


def _are_numbers(action: SetMat) -> bool:
    """Whether an element's bounds, if there are any, are plain numbers."""
    return all(bound is None or isinstance(bound, Const) for bound in (action.lower, action.upper))


def _draws(node: Value) -> bool:
    return isinstance(node, Op) and node.name in DRAWS
