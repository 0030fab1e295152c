"""A run against time, for a negative TMAX: the same segment over s = -t.

Loops, rules and solvers always go forward. Where the segment reads t it reads -s, and dx/ds = -dx/dt; whoever
shows times turns them round (`runtime.simulator`). An event comes where its expression rises through 0 along
the run, and a clock's moments are the same times as forward, the latest first (`runtime.event_times`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.segment import Event
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, StoreHistory
from desire_tui.engine.passes.copies import Copies
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment


def backward(segment: Segment, spare: int) -> Segment:
    """Return the segment over -t. A JACOBIAN part, of derivatives over t, is left to the compiler.

    `spare`: a number that nobody uses; `store X = t` reads t there.
    """
    turned = _Turned(spare)
    body, faults = turned.of(segment.body), turned.of(segment.faults)
    events = tuple(turned.event(event) for event in segment.events)
    return replace(segment, body=body, faults=faults, events=events, jacobian=None)


class _Turned(Copies):
    """Parts over -t."""

    def __init__(self, spare: int) -> None:
        super().__init__()
        self._spare = spare
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

    def items(self, item: Any) -> tuple[Any, ...]:
        """Let `store X = t` read a copy of t."""
        if not (isinstance(item, StoreHistory) and item.slot == T):
            return super().items(item)
        stored = StoreHistory(item.array_slot, item.count, self._spare, item.counter, item.where)
        return (Set(self._spare, self._time, item.where), stored)

    def made(self, part: Any, copy: Any) -> Any:
        """Turn t and derivatives."""
        if isinstance(copy, Load):
            return self._time if copy.slot == T else part
        if isinstance(copy, Deriv):
            return Deriv(copy.state, _negative(copy.value), copy.where)
        if isinstance(copy, DerivVec):
            return DerivVec(copy.state, copy.count, _negative(copy.value), copy.where)
        if isinstance(copy, Set) and copy.slot == T:
            return Set(T, _negative(copy.value), copy.where, copy.persistent)
        return copy


def _negative(value: Value) -> Value:
    return Const(-value.value) if isinstance(value, Const) else Op("sub", (Const(0.0), value))  # -t is 0 at 0
