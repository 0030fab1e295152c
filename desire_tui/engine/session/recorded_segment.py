"""A segment that samples more than its program asks for: any quantity, and derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowered.segment import SampleColumn
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetVec, Where
from desire_tui.engine.lowered.walk import with_bodies
from desire_tui.engine.session.overrides import name_and_subscripts
from desire_tui.engine.source import Span

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.values import Quantity, Values

DERIVATIVE = "d/dt "
"""What stands before a state's name in the name of its derivative, as in the program."""
_DOT = "dot"
"""What stands behind it in the short form, unless the program itself uses that name."""


def recording(segment: Segment, wanted: tuple[str, ...], values: Values) -> Segment:
    """Return the segment with more columns: `y`, `A[2]`, `A` (all elements), `d/dt x` or `xdot`.

    DesireError 409: no such quantity or element.
    """
    body = _WithDerivatives(segment, values)
    columns: list[SampleColumn] = []
    for name in wanted:
        for label, slot in _places(name, segment, values, body):
            columns.append(SampleColumn(label, slot, _anywhere(segment)))
    known = {column.name for column in segment.columns}
    return replace(
        segment,
        body=body.actions(segment.body),
        stash=(*segment.stash, *(c for c in columns if c.name not in known)),
        scalars=(*segment.scalars, *body.slots),
    )


def _places(name: str, segment: Segment, values: Values, body: _WithDerivatives) -> Iterator[tuple[str, int]]:
    """Yield the columns that a name stands for: label and slot."""
    state = (
        name.removeprefix(DERIVATIVE).strip() if name.startswith(DERIVATIVE) else _short_form(name, values)
    )
    own, subscripts = _split(state or name, segment)
    quantity = values.find(own)
    if quantity is None or (state is not None and not quantity.is_state):
        known = [q.name for q in values] + [f"{q.name}{_DOT}" for q in values if q.is_state]
        facts = {"name": name, "close": closest(name, known)}
        raise DesireError(Diagnostic("record-unknown", None, facts, segment.source))
    for label, slot in _elements(quantity, subscripts, name, segment):
        if state is None:
            yield label, slot
        else:
            yield name if label == own else f"{DERIVATIVE}{label}", body.slot_of(slot)


def _short_form(name: str, values: Values) -> str | None:
    """Return the state whose derivative `xdot` means; None: the program has a quantity of that name."""
    own = name.removesuffix(_DOT)
    found = values.find(own)
    is_short = own != name and values.find(name) is None and found is not None and found.is_state
    return own if is_short else None


def _split(name: str, segment: Segment) -> tuple[str, tuple[int, ...]]:
    try:
        return name_and_subscripts(name)
    except ValueError:
        facts = {"name": name, "close": None}
        raise DesireError(Diagnostic("record-unknown", None, facts, segment.source)) from None


def _elements(
    quantity: Quantity, subscripts: tuple[int, ...], name: str, segment: Segment
) -> Iterator[tuple[str, int]]:
    """Yield label and slot of a scalar, of one element, or of all elements of an array."""
    width = quantity.slots // quantity.size
    if not quantity.shape and not subscripts:
        yield quantity.name, quantity.slot
        return
    places = [tuple(k - 1 for k in subscripts)] if subscripts else list(np.ndindex(quantity.shape))
    for place in places:
        if len(place) != len(quantity.shape) or not all(
            0 <= k < n for k, n in zip(place, quantity.shape, strict=True)
        ):
            facts = {"name": name, "close": None}
            raise DesireError(Diagnostic("record-unknown", None, facts, segment.source))
        label = f"{quantity.name}[{','.join(str(k + 1) for k in place)}]"
        yield label, quantity.slot + width * int(np.ravel_multi_index(place, quantity.shape))


class _WithDerivatives:
    """Adds statements that keep derivatives in slots of their own, each before its `d/dt` line."""

    def __init__(self, segment: Segment, values: Values) -> None:
        self._states, self._values = segment.states, values
        self._slots: dict[int, int] = {}

    @property
    def slots(self) -> tuple[int, ...]:
        """The slots made."""
        return tuple(self._slots.values())

    def slot_of(self, state_slot: int) -> int:
        """Return where the derivative of the state in a slot is kept."""
        for states in self._states:
            if states.slot <= state_slot < states.slot + states.count:
                number = states.first + state_slot - states.slot
                if number not in self._slots:
                    self._slots[number] = self._values.unnamed(1)
                return self._slots[number]
        raise KeyError(state_slot)

    def actions(self, actions: Iterable[Action]) -> tuple[Action, ...]:
        """Return statements with those that keep the derivatives asked for."""
        return (
            tuple(new for action in actions for new in self._action(action))
            if self._slots
            else tuple(actions)
        )

    def _action(self, action: Action) -> Iterator[Action]:
        if isinstance(action, Guard):
            yield with_bodies(action, self.actions(action.body), self.actions(action.orelse))
            return
        if isinstance(action, Deriv) and action.state in self._slots:
            yield Set(self._slots[action.state], action.value, action.where)
        if isinstance(action, DerivVec):
            yield from self._vector(action)
        yield action

    def _vector(self, action: DerivVec) -> Iterator[Action]:
        wanted = [n for n in range(action.count) if action.state + n in self._slots]
        if not wanted:
            return
        whole = self._values.room(action.count)
        yield SetVec(whole, action.count, action.value, action.where)
        for number in wanted:
            yield Set(self._slots[action.state + number], Load(whole + number), action.where)


def _anywhere(segment: Segment) -> Where:
    """Return a place for what the program does not ask for, where an infinite value would be reported."""
    places = [*(states.where for states in segment.states), *(column.where for column in segment.columns)]
    return places[0] if places else Where(Span(0, 0))
