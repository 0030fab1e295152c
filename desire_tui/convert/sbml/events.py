"""Events of an SBML model.

An event with a delay becomes two: one that notes the time at which it is due and the values to be assigned,
and one that assigns them then. Events that go off together are executed by priority, the highest first.
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
    """Add the events to the model, those of higher priority first."""
    order = sorted(symbols.events(), key=lambda one: -_priority(one, symbols))
    for one in order:
        symbols.model.events.extend(_parts(one, symbols))


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


def _parts(one: Any, symbols: Symbols) -> Iterator[Event]:
    name = one.getId() or "event"
    trigger = one.getTrigger()
    condition = symbols.formula(trigger, name)
    try:
        set_off = rising(condition)
    except UnlocatableError as reason:
        symbols.refuse(one, name, str(reason))
        return
    at_start = None if trigger.getInitialValue() else condition
    comment = " ".join(one.getName().split()) or name
    assignments = list(_assignments(one, symbols))
    delay = symbols.formula(one.getDelay(), name) if one.isSetDelay() else ZERO
    block = _together(assignments, symbols)
    after: list[Event] = []
    if delay != ZERO:
        block, after = _delayed(one, assignments, delay, symbols)
        if not trigger.getPersistent() and len(set_off) == 1:
            never = Quantity(block[-1].name, _NEVER)
            after.insert(0, Event(_falling(set_off[0]), [never], f"{comment}: no longer"))
    for count, moment in enumerate(set_off):
        yield Event(moment, block, comment, at_start if count == 0 else None)
    yield from after


def _delayed(
    one: Any, assignments: list[Quantity], delay: Expression, symbols: Symbols
) -> tuple[list[Quantity], list[Event]]:
    """Return what is noted when the event is set off (when it is due comes last), and what executes it."""
    name = one.getId() or "event"
    due = symbols.fresh(f"{name}_due")
    symbols.model.held.append(Quantity(due, _NEVER))
    noted: list[Quantity] = []
    if one.getUseValuesFromTriggerTime():
        for k, assignment in enumerate(assignments):
            value = symbols.fresh(f"{name}_{assignment.name}")
            symbols.model.held.append(Quantity(value, ZERO))
            noted.append(Quantity(value, assignment.value))
            assignments[k] = Quantity(assignment.name, Name(value))
    symbols.note(one, name, "if it is set off again before it is executed, only the later time counts")
    executed = [*_together(assignments, symbols), Quantity(due, _NEVER)]
    comment = f"{' '.join(one.getName().split()) or name}: due"
    noted.append(Quantity(due, Binary("+", TIME, delay)))
    return noted, [Event(Binary("-", TIME, Name(due)), executed, comment)]


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
