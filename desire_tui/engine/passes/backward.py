"""A run against time, for a negative TMAX: the same segment over s = -t.

Loops, rules and solvers always go forward. Where the segment reads t it reads -s, and dx/ds = -dx/dt; whoever
shows times turns them round (`runtime.simulator`). An event comes where its expression rises through 0 along
the run, and a clock's moments are the same times as forward, the latest first (`runtime.event_times`).
`delay(x, tau)` looks up x at t - tau, which such a run has passed if tau is below 0 (`runtime.event_times`).
The array of a JACOBIAN part, which holds derivatives over t, holds those over -t as long as the run lasts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.segment import DelayedValue, Event, Jacobian, JacobianEntry
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, StoreHistory
from desire_tui.engine.passes.copies import Copies
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment


def backward(segment: Segment, spare: int) -> Segment:
    """Return the segment over -t.

    `spare`: a number that nobody uses; `store X = t` reads t there.
    """
    given = segment.jacobian
    turned = _Turned(spare, range(given.slot, given.slot + segment.order**2) if given else range(0))
    body, faults = turned.of(segment.body), turned.of(segment.faults)
    events = tuple(turned.event(event) for event in segment.events)
    delays = tuple(
        DelayedValue(turned.of(d.source), _negative(turned.of(d.tau)), d.where) for d in segment.delays
    )
    jacobian = turned.jacobian(given) if given else None
    return replace(segment, body=body, faults=faults, events=events, delays=delays, jacobian=jacobian)


class _Turned(Copies):
    """Parts over -t."""

    def __init__(self, spare: int, matrix: range) -> None:
        super().__init__()
        self._spare, self._matrix = spare, matrix
        self._time = _negative(Load(T))

    def event(self, event: Event) -> Event:
        """Return an event over -t; a clock's times stay the program's, and it ends with its first moment."""
        body = self.of(event.body)
        if event.condition is not None:
            return Event(body, event.where, self.of(event.condition))
        assert event.period is not None
        assert event.start is not None
        early = Op("sub", (self._time, self.of(event.start)))
        is_due = Op("add", (early, Op("mul", (Const(0.5), self.of(event.period)))))
        body = (Guard("if", body, event.where, is_due),)
        return Event(body, event.where, period=event.period, start=event.start)

    def jacobian(self, given: Jacobian) -> Jacobian:
        """Return a JACOBIAN part over -t."""
        entries = [
            JacobianEntry(e.row, e.column, _negative(self.of(e.value)), e.where) for e in given.entries
        ]
        return Jacobian(given.slot, self.of(given.body), tuple(entries))

    def items(self, item: Any) -> tuple[Any, ...]:
        """Let `store X = t` read a copy of t."""
        if not (isinstance(item, StoreHistory) and item.slot == T):
            return super().items(item)
        stored = StoreHistory(item.array_slot, item.count, self._spare, item.counter, item.where)
        return (Set(self._spare, self._time, item.where), stored)

    def made(self, part: Any, copy: Any) -> Any:
        """Turn t and derivatives."""
        if isinstance(copy, Load):
            return self._time if copy.slot == T else _negative(part) if copy.slot in self._matrix else part
        if isinstance(copy, Op) and copy.name == "delayed":
            number, time, *before = copy.args
            return Op("delayed", (number, _negative(time), *before))
        if isinstance(copy, Deriv):
            return Deriv(copy.state, _negative(copy.value), copy.where)
        if isinstance(copy, DerivVec):
            return DerivVec(copy.state, copy.count, _negative(copy.value), copy.where)
        if isinstance(copy, Set) and copy.slot == T:
            return Set(T, _negative(copy.value), copy.where, copy.persistent)
        return copy


def _negative(value: Value) -> Value:
    return Const(-value.value) if isinstance(value, Const) else Op("sub", (Const(0.0), value))  # -t is 0 at 0
