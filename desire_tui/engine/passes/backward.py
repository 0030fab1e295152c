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


class _Turned:
    """Copies of statements and expressions; what stands at several places stays one."""

    def __init__(self, spare: int) -> None:
        self._spare = spare
        self._known: dict[int, tuple[object, Any]] = {}
        self._time = _negative(Load(T))

    def of(self, part: Any) -> Any:
        """Return a statement, an expression or a tuple of them over -t."""
        if isinstance(part, tuple):
            if type(part) is not tuple:
                return part  # a place
            items = []
            for item in part:
                if isinstance(item, StoreHistory) and item.slot == T:
                    items.append(Set(self._spare, self._time, item.where))
                    item = StoreHistory(  # noqa: PLW2901 - the same statement, of the turned time
                        item.array_slot, item.count, self._spare, item.counter, item.where
                    )
                items.append(self.of(item))
            if len(items) != len(part):
                return tuple(items)
            return part if all(map(_same, items, part)) else tuple(items)
        names: tuple[str, ...] | None = getattr(type(part), "__slots__", None)
        if names is None or isinstance(part, str | float | int | Const):
            return part
        known = self._known.get(id(part))
        if known is None:
            known = self._known[id(part)] = part, self._copy(part, names)
        return known[1]

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

    def _copy(self, part: Any, names: tuple[str, ...]) -> Any:
        if isinstance(part, Load):
            return self._time if part.slot == T else part
        fields = [getattr(part, name) for name in names]
        changed = [self.of(field) for field in fields]
        made = part if all(map(_same, changed, fields)) else type(part)(*changed)
        if isinstance(made, Deriv):
            return Deriv(made.state, _negative(made.value), made.where)
        if isinstance(made, DerivVec):
            return DerivVec(made.state, made.count, _negative(made.value), made.where)
        if isinstance(made, Set) and made.slot == T:
            return Set(T, _negative(made.value), made.where, made.persistent)
        return made


def _negative(value: Value) -> Value:
    return Const(-value.value) if isinstance(value, Const) else Op("sub", (Const(0.0), value))  # -t is 0 at 0


def _same(one: object, other: object) -> bool:
    return one is other
