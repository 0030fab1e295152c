"""Jumps in derivatives made into events, so that what they do to tangents can be computed.

`swtch`, relations, `if` and the like jump where an argument that depends on states or parameters passes a
threshold. The derivatives get a number in place of the jump, and events set it where the argument passes:
they are located under every rule, and `moment_tangents` does the rest (the block sets nothing that has a
tangent, so S+ = S- + (f- - f+)·t*').
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.lowered.segment import Event
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetMat, SetVec
from desire_tui.engine.lowered.switching import JUMPS
from desire_tui.engine.lowered.walk import simple_actions
from desire_tui.engine.passes.dead_code import needed_by
from desire_tui.engine.passes.derivative_rules import ONE, ZERO, op
from desire_tui.engine.passes.differentiate import Differentiator
from desire_tui.engine.passes.moments import definitions
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.switch_finder import is_scalar
from desire_tui.engine.passes.tangents import NotDifferentiable
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, SimpleAction, Where
    from desire_tui.engine.passes.tangents import Tangents

_ONCE = Const(1e300)
_EDGE = Const(1e-12)
_HALF, _MINUS = Const(0.5), Const(-1.0)


def located_jumps(segment: Segment, tangents: Sequence[Tangents], allocate: Callable[[int], int]) -> Segment:
    """Return the segment with events for each jump whose argument has a tangent in some direction.

    NotDifferentiable: the elements of an array jump one by one, or there is a jump under an `if`.
    """
    finder = _Finder(segment, tangents, allocate)
    body = finder.actions(segment.body, under=False)
    if not finder.modes:
        return segment
    given = definitions(body)
    begin: list[Action] = []
    for mode in finder.modes:
        made = Set(mode.slot, Op(mode.operation, (mode.argument,)), mode.where)
        begin += [*needed_by(given, (made,)), made]
    first = Event(tuple(begin), finder.modes[0].where, period=_ONCE, start=Load(T))
    passing = [event for mode in finder.modes for event in mode.events()]
    return replace(segment, body=body, events=(first, *passing, *segment.events))


@dataclass(frozen=True)
class _Mode:
    """A jump's value in `slot`, which its `argument` makes another where it passes a threshold."""

    slot: int
    operation: str
    argument: Value
    where: Where

    def events(self) -> Iterator[Event]:
        """Yield what gives it other values."""
        g, now = self.argument, Load(self.slot)
        for rising, value in _PASSINGS[self.operation](g, now):
            yield Event((Set(self.slot, value, self.where),), self.where, condition=rising)


def _above(g: Value, threshold: Value) -> Value:
    return op("sub", g, threshold)


def _below(g: Value, threshold: Value) -> Value:
    return op("sub", threshold, g)


def _at_zero(high: Value, low: Value) -> _Passings:
    return lambda g, _now: [(g, high), (op("neg", g), low)]


def _at_units(low: Value, middle: Value, high: Value) -> _Passings:
    return lambda g, _now: [
        (_above(g, ONE), high), (_below(g, ONE), middle),
        (_above(g, _MINUS), middle), (_below(g, _MINUS), low),
    ]  # fmt: skip


def _stairs(upper: Callable[[Value], Value], lower: Callable[[Value], Value]) -> _Passings:
    """Return steps of 1, up where the argument passes `upper`, down where it passes `lower`.

    Down a little later: on the very edge it would go up and down for ever.
    """
    return lambda g, now: [
        (_above(g, upper(now)), op("add", now, ONE)),
        (_below(g, op("sub", lower(now), _EDGE)), op("sub", now, ONE)),
    ]


if TYPE_CHECKING:
    _Passings = Callable[[Value, Load], list[tuple[Value, Value]]]
    """What rises through 0 where a jump with this argument and present value passes, and its new value."""

_PASSINGS: dict[str, _Passings] = {
    "swtch": _at_zero(ONE, ZERO),
    "sgn": _at_zero(ONE, _MINUS),
    "rect": _at_units(ZERO, ONE, ZERO),
    "deadc": _at_units(_MINUS, ZERO, ONE),
    "round": _stairs(lambda m: op("add", m, _HALF), lambda m: op("sub", m, _HALF)),
    "floor": _stairs(lambda m: op("add", m, ONE), lambda m: m),
    "trnc": _stairs(
        lambda m: op("comp", op("add", m, _HALF), m, op("add", m, ONE)),
        lambda m: op("comp", op("sub", m, _HALF), op("sub", m, ONE), m),
    ),
}


class _Finder:
    """Rewrites statements over numbers in place of jumps, and collects those: `modes`."""

    def __init__(
        self, segment: Segment, tangents: Sequence[Tangents], allocate: Callable[[int], int]
    ) -> None:
        self._derivative = {id(action) for action in simple_actions(derivative_slice(segment))}
        self._differentiators = [Differentiator(t, delayed=lambda _, value: value) for t in tangents]
        self._allocate = allocate
        self.modes: list[_Mode] = []

    def actions(self, actions: Iterable[Action], *, under: bool) -> tuple[Action, ...]:
        """Return statements without jumps that have to be located; `under`: they stand under an `if`."""
        return tuple(
            self._guard(action, under=under)
            if isinstance(action, Guard)
            else self._statement(action, under=under)
            if id(action) in self._derivative
            else action
            for action in actions
        )

    def _guard(self, guard: Guard, *, under: bool) -> Guard:
        if guard.kind != "if":
            return guard  # what acts at steps or samples acts there, wherever the argument passes
        condition = guard.condition
        assert condition is not None
        if self._moves(condition) and any(id(a) in self._derivative for a in simple_actions((guard,))):
            if under:
                raise NotDifferentiable(guard)
            mode = self._mode("swtch", self._value(condition, guard.where, under=under), guard.where)
            condition = op("sub", mode, _HALF)
        body, orelse = self.actions(guard.body, under=True), self.actions(guard.orelse, under=True)
        return Guard(guard.kind, body, guard.where, condition, orelse, guard.every)

    def _statement(self, action: SimpleAction, *, under: bool) -> SimpleAction:
        if not isinstance(action, Set | SetVec | SetMat | Deriv | DerivVec):
            return action
        value = self._value(action.value, action.where, under=under)
        return action if value is action.value else _with_value(action, value)

    def _value(self, value: Value, where: Where, *, under: bool) -> Value:
        if isinstance(value, Table1):
            x = self._value(value.x, where, under=under)
            return value if x is value.x else Table1(x, value.slot, value.count)
        if isinstance(value, Table2):
            x, y = (self._value(part, where, under=under) for part in (value.x, value.y))
            return Table2(x, y, value.f_slot, value.rows, value.cols, value.x_slot, value.y_slot)
        if not isinstance(value, Op):
            return value
        args = tuple(self._value(argument, where, under=under) for argument in value.args)
        if value.name not in JUMPS or not self._moves(value.args[0]):
            same = all(new is old for new, old in zip(args, value.args, strict=True))
            return value if same else Op(value.name, args)
        if under or not is_scalar(value.args[0]):
            raise NotDifferentiable(value)
        if value.name != "comp":
            return self._mode(value.name, args[0], where)
        return op("comp", op("sub", self._mode("swtch", args[0], where), _HALF), *args[1:])

    def _mode(self, operation: str, argument: Value, where: Where) -> Load:
        slot = self._allocate(1)
        self.modes.append(_Mode(slot, operation, argument, where))
        return Load(slot)

    def _moves(self, argument: Value) -> bool:
        """Whether where it passes a threshold depends on a direction."""
        return any(differentiator.of(argument) is not None for differentiator in self._differentiators)


def _with_value(action: Set | SetVec | SetMat | Deriv | DerivVec, value: Value) -> SimpleAction:
    match action:
        case Set():
            return Set(action.slot, value, action.where, action.persistent)
        case Deriv():
            return Deriv(action.state, value, action.where)
        case DerivVec():
            return DerivVec(action.state, action.count, value, action.where)
        case SetVec():
            return SetVec(
                action.slot, action.count, value, action.where, action.mode, action.mask_slot,
                action.persistent,
            )  # fmt: skip
        case SetMat():
            return SetMat(
                action.slot, action.rows, action.cols, value, action.where, action.mode, action.lower,
                action.upper, action.mask_slot, action.persistent,
            )  # fmt: skip
