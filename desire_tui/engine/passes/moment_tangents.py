"""What happens to tangents at the moments of `event` and `every`, whose time depends on parameters too.

An event at t* sets x+ = h(x-, t*), where g(x-, t*) = 0 defines t*. With the rates f- before and f+ behind it

    t*' = -(∂g/∂x·S-) / (∂g/∂x·f- + ∂g/∂t),    S+ = ∂h/∂x·(S- + f-·t*') + ∂h/∂t·t*' - f+·t*'

(Galán, Feehery and Barton, "Parametric sensitivity functions for hybrid discrete/continuous systems",
Appl. Numer. Math. 31, 1999). So tangents are moved along with t to the displaced moment, the block's
statements are differentiated like any others, and what they leave is moved back. An event that another's
block sets off happens at that one's time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import role
from desire_tui.engine.lowered.expressions import Load, Vec
from desire_tui.engine.lowered.segment import Event
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetVec
from desire_tui.engine.lowered.walk import with_bodies
from desire_tui.engine.passes.dead_code import needed_by, without_dead_code
from desire_tui.engine.passes.derivative_rules import ONE, ZERO, op
from desire_tui.engine.passes.differentiate import Differentiator, with_tangents
from desire_tui.engine.passes.moments import definitions
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.tangents import Tangents
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, Where

_LONG_AGO = -1e300


class MomentTangents:
    """Writes the blocks of events with what they do to tangents.

    `memory` lists numbers (slot, value) that have to be set before a run.
    """

    def __init__(
        self,
        segment: Segment,
        tangents: Sequence[Tangents],
        differentiators: Sequence[Differentiator],
        allocate: Callable[[int], int],
    ) -> None:
        self._segment, self._tangents, self._differentiators = segment, tangents, differentiators
        self.memory: tuple[tuple[int, float], ...] = ()
        if not segment.events:
            return
        self._last = allocate(1)
        self._shifts = [allocate(1) for _ in tangents]
        self._speed = allocate(1)
        self._rates = allocate(max(segment.order, 1))
        self._definitions = definitions(segment.body)
        self._derivatives = derivative_slice(segment)
        everything = [*segment.body, *(inner for event in segment.events for inner in event.body)]
        self._time = Tangents(segment.states, everything, allocate, [(T, 1)], in_place=True)
        self._by_time = Differentiator(self._time)
        self.memory = ((self._last, _LONG_AGO), *((shift, 0.0) for shift in self._shifts))

    def event(self, event: Event) -> Event:
        """Return an event that sets tangents too. NotDifferentiable: its block has no derivative."""
        where = event.where
        shift = self._shift_of_clock(event) if event.condition is None else self._shift_of_root(event)
        before, behind = self._moved("add", where), self._moved("sub", where)
        if shift is None:
            before, behind = [], []
            shift = [Set(slot, ZERO, where) for slot in self._shifts]
        block = self._at_displaced_time(event, where, moves=bool(before))
        body = (*shift, Set(self._last, Load(T), where), *before, *block, *behind)
        return Event(body, where, event.condition, event.period, event.start)

    def _at_displaced_time(self, event: Event, where: Where, *, moves: bool) -> tuple[Action, ...]:
        """Return the block with tangents, t's included."""
        block = with_tangents(self._differentiators, event.body)
        before = with_tangents(self._differentiators, self._definitions)
        kept = needed_by(before, block)
        if not moves:
            return (*kept, *block)
        clocks = [slot for slot in (t.slot(T) for t in self._tangents) if slot is not None]
        begin = [Set(slot, Load(shift), where) for slot, shift in zip(clocks, self._shifts, strict=True)]
        return (*begin, *kept, *block, *(Set(slot, ZERO, where) for slot in clocks))

    def _moved(self, operation: str, where: Where) -> list[Action]:
        """Return what moves the states' tangents along the present rates, or back."""
        made: list[Action] = list(self._rates_now())
        for tangents, shift in zip(self._tangents, self._shifts, strict=True):
            for s in self._segment.states:
                slot = tangents.slot(s.slot)
                assert slot is not None
                rate = self._rates + s.first
                if s.count == 1:
                    made.append(
                        Set(slot, op(operation, Load(slot), op("mul", Load(rate), Load(shift))), where)
                    )
                else:
                    moved = op("mul", Vec(rate, s.count), Load(shift))
                    made.append(SetVec(slot, s.count, op(operation, Vec(slot, s.count), moved), where))
        return made

    def _rates_now(self) -> tuple[Action, ...]:
        """Return what computes the derivatives at the present t and states."""
        rates = set[int]()
        actions = self._into_rates(self._derivatives, rates)
        return without_dead_code(actions, frozenset(rates))

    def _into_rates(self, actions: Iterable[Action], rates: set[int]) -> tuple[Action, ...]:
        """Return definitions, and derivatives as statements that keep them, whose ids `rates` gets."""
        made: list[Action] = []
        for action in actions:
            if isinstance(action, Deriv):
                made.append(Set(self._rates + action.state, action.value, action.where))
            elif isinstance(action, DerivVec):
                made.append(SetVec(self._rates + action.state, action.count, action.value, action.where))
            elif isinstance(action, Guard):
                body, orelse = (self._into_rates(part, rates) for part in (action.body, action.orelse))
                made.append(with_bodies(action, body, orelse))
                continue
            elif role(action) == "definition":
                made.append(action)
                continue
            else:
                continue
            rates.add(id(made[-1]))
        return tuple(made)

    def _shift_of_root(self, event: Event) -> list[Action] | None:
        """Return what computes by how much each direction displaces the root of an event's condition."""
        where, condition = event.where, event.condition
        assert condition is not None
        made: list[Action] = [*self._rates_now()]
        for s in self._segment.states:
            slot, rate = self._time.slot(s.slot), self._rates + s.first
            assert slot is not None
            if s.count == 1:
                made.append(Set(slot, Load(rate), where))
            else:
                made.append(SetVec(slot, s.count, Vec(rate, s.count), where))
        clock = self._time.slot(T)
        assert clock is not None
        made.append(Set(clock, ONE, where))
        found: list[Action] = [Set(self._speed, self._by_time.of(condition) or ZERO, where)]
        is_first = op("abs", op("sub", Load(T), Load(self._last)))
        moves = op("abs", Load(self._speed))
        for differentiator, shift in zip(self._differentiators, self._shifts, strict=True):
            change = differentiator.of(condition) or ZERO
            displaced: Value = op("neg", op("div", change, Load(self._speed)))
            displaced = op("comp", moves, ZERO, displaced)
            found.append(Set(shift, op("comp", is_first, Load(shift), displaced), where))
        followed = with_tangents([self._by_time, *self._differentiators], self._definitions)
        return [*made, *needed_by(followed, tuple(found)), *found]

    def _shift_of_clock(self, event: Event) -> list[Action] | None:
        """Return what computes by how much each direction displaces the present tick; None: none does."""
        assert event.period is not None
        assert event.start is not None
        period, start = event.period, event.start
        ticks = op("round", op("div", op("sub", Load(T), start), period))
        found: list[Action] = []
        displaces = False
        for differentiator, shift in zip(self._differentiators, self._shifts, strict=True):
            by_start, by_period = differentiator.of(start), differentiator.of(period)
            displaces = displaces or by_start is not None or by_period is not None
            moved = op("add", by_start or ZERO, op("mul", ticks, by_period or ZERO))
            found.append(Set(shift, moved, event.where))
        if not displaces:
            return None
        followed = with_tangents(self._differentiators, self._definitions)
        return [*needed_by(followed, tuple(found)), *found]
