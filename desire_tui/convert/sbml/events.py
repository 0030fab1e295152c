"""Events of an SBML model.

An event with a delay becomes two: one that notes the time at which it is due and the values to be assigned,
and one that assigns them then. Events that go off together are executed by priority, the highest first, with
values from before all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.convert.expressions import (
    TIME,
    ZERO,
    Binary,
    Expression,
    Name,
    Negative,
    Number,
    names_in,
    product,
)
from desire_tui.convert.model import Event, Quantity
from desire_tui.convert.sbml.symbols import size_of
from desire_tui.convert.sbml.triggers import UnlocatableError, rising

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.sbml.symbols import Symbols

_NEVER = Number(1e30)
"""When an event is due that was not set off."""


def events(symbols: Symbols) -> None:
    """Add the events to the model: first what only notes values and times, then by priority what assigns."""
    order = sorted(symbols.events(), key=lambda one: -_priority(one, symbols))
    targets = [{one.name for one in _assignments(event, symbols)} for event in order]
    noting: list[Event] = []
    assigning: list[Event] = []
    for place, one in enumerate(order):
        before = set().union(*targets[:place])
        notes, executes = _parts(one, before, symbols)
        noting.extend(notes)
        assigning.extend(executes)
    symbols.model.events.extend([*noting, *assigning])


def _priority(one: Any, symbols: Symbols) -> float:
    if not one.isSetPriority():
        return float("-inf")
    value = symbols.formula(one.getPriority(), one.getId() or "event")
    match value:
        case Number(found):
            return found
        case Negative(Number(found)):
            return -found
        case _:
            symbols.refuse(one, one.getId() or "event", "a priority that changes has no counterpart here")
            return 0.0


def _parts(one: Any, before: set[str], symbols: Symbols) -> tuple[list[Event], list[Event]]:
    """Return the blocks of an event that note, and those that assign.

    `before`: what events assign that are executed before it where they go off together. Its values are those
    from before them, if it uses values from when it is set off.
    """
    name = one.getId() or "event"
    trigger = one.getTrigger()
    condition = symbols.formula(trigger, name)
    try:
        set_off = rising(condition, _changing(symbols))
    except UnlocatableError as reason:
        symbols.refuse(one, name, str(reason))
        return [], []
    at_start = None if trigger.getInitialValue() else condition
    comment = " ".join(one.getName().split()) or name
    assignments = list(_assignments(one, symbols))
    delay = symbols.formula(one.getDelay(), name) if one.isSetDelay() else ZERO
    noted: list[Quantity] = []
    reads = set().union(*(_read(value.value, symbols) for value in assignments))
    if one.getUseValuesFromTriggerTime() and (delay != ZERO or reads & before):
        noted, assignments = _noted(name, assignments, symbols)

    def when_set_off(block: list[Quantity]) -> list[Event]:
        return [
            Event(moment, block, comment, at_start if count == 0 else None)
            for count, moment in enumerate(set_off)
        ]

    if delay == ZERO:
        return when_set_off(noted) if noted else [], when_set_off(_together(assignments, symbols))
    due = symbols.fresh(f"{name}_due")
    never = Quantity(due, _NEVER)
    symbols.model.held.append(never)
    symbols.note(one, name, "if it is set off again before it is executed, only the later time counts")
    notes = when_set_off([*noted, Quantity(due, Binary("+", TIME, delay))])
    if not trigger.getPersistent() and len(set_off) == 1:
        notes.append(Event(_falling(set_off[0]), [never], f"{comment}: no longer"))
    executed = [*_together(assignments, symbols), never]
    return notes, [Event(Binary("-", TIME, Name(due)), executed, f"{comment}: due")]


def _noted(name: str, assignments: list[Quantity], symbols: Symbols) -> tuple[list[Quantity], list[Quantity]]:
    """Return assignments of values to names of their own, and those of these names to the event's targets."""
    noted, then = [], []
    for assignment in assignments:
        value = symbols.fresh(f"{name}_{assignment.name}")
        symbols.model.held.append(Quantity(value, ZERO))
        noted.append(Quantity(value, assignment.value))
        then.append(Quantity(assignment.name, Name(value)))
    return noted, then


def _changing(symbols: Symbols) -> set[str]:
    """Return what changes while the model runs."""
    model = symbols.model
    names = {one.name for one in [*model.variables, *model.held]}
    return names | {state.name for state in model.states} | {TIME.name}


def _falling(rising_: Expression) -> Expression:
    return rising_.operand if isinstance(rising_, Negative) else Negative(rising_)


def _assignments(one: Any, symbols: Symbols) -> Iterator[Quantity]:
    for k in range(one.getNumEventAssignments()):
        assignment = one.getEventAssignment(k)
        target = assignment.getVariable()
        value = symbols.formula(assignment, target)
        amount = symbols.amount_name(target)
        if amount is None:
            yield Quantity(target, value)
        else:
            yield Quantity(amount, product(value, size_of(symbols.sbml.getSpecies(target))))


def _together(assignments: list[Quantity], symbols: Symbols) -> list[Quantity]:
    """Return assignments whose values are all taken before the first is made."""
    targets = {one.name for one in assignments}
    reads = set().union(*(_read(one.value, symbols) for one in assignments)) if assignments else set()
    if len(assignments) < 2 or not targets & reads:
        return assignments
    before, after = [], []
    for one in assignments:
        new = symbols.fresh(f"new_{one.name}")
        before.append(Quantity(new, one.value))
        after.append(Quantity(one.name, Name(new)))
    return [*before, *after]


def _read(value: Expression, symbols: Symbols) -> set[str]:
    """Return what an expression reads, the amounts behind concentrations included."""
    names = names_in(value)
    return names | {amount for name in names if (amount := symbols.amount_name(name)) is not None}
