"""Compartments, parameters, stoichiometries and species of an SBML model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.convert.expressions import Binary, Expression, Name, product, quotient
from desire_tui.convert.model import Quantity, State
from desire_tui.convert.sbml.symbols import Symbols, size_of

if TYPE_CHECKING:
    from collections.abc import Mapping


def plain_quantities(symbols: Symbols) -> None:
    """Add compartments, parameters and stoichiometries with names."""
    sbml = symbols.sbml
    for k in range(sbml.getNumCompartments()):
        one = sbml.getCompartment(k)
        _quantity(symbols, one, one.getSize() if one.isSetSize() else None)
    for k in range(sbml.getNumParameters()):
        one = sbml.getParameter(k)
        _quantity(symbols, one, one.getValue() if one.isSetValue() else None)
    for k in range(sbml.getNumReactions()):
        reaction = sbml.getReaction(k)
        for lists in (reaction.getListOfReactants(), reaction.getListOfProducts()):
            for place in range(lists.size()):
                one = lists.get(place)
                if one.isSetId():
                    _quantity(symbols, one, one.getStoichiometry() if one.isSetStoichiometry() else 1.0)


def species(symbols: Symbols, changes: Mapping[str, Expression]) -> None:
    """Add the species. `changes`: how fast reactions change the amounts of some of them."""
    for k in range(symbols.sbml.getNumSpecies()):
        one = symbols.sbml.getSpecies(k)
        name, change = one.getId(), changes.get(one.getId())
        if symbols.sbml.getCompartment(one.getCompartment()) is None:
            symbols.refuse(one, name, f"there is no compartment '{one.getCompartment()}'")
            continue
        start = _start(symbols, one)
        if symbols.held_as_amount(one):
            _held_as_amount(symbols, one, start, change)
        elif change is None or name in symbols.assigned or name in symbols.rated:
            _add(symbols, one, start)
        else:
            rate = change if symbols.is_amount(one) else quotient(change, size_of(one))
            symbols.model.states.append(State(name, rate, start, _comment(one)))


def _held_as_amount(symbols: Symbols, one: Any, start: Expression, change: Expression | None) -> None:
    name, amount = one.getId(), symbols.amount_name(one.getId())
    assert amount is not None
    begin = product(start, size_of(one))
    if change is None:
        target = symbols.model.held if name in symbols.by_events else symbols.model.parameters
        target.append(Quantity(amount, begin, _comment(one)))
    else:
        symbols.model.states.append(State(amount, change, begin, _comment(one)))
    symbols.model.variables.append(Quantity(name, Binary("/", Name(amount), size_of(one))))


def _start(symbols: Symbols, one: Any) -> Expression:
    """Return the initial value of what the species stands for."""
    name = one.getId()
    by_concentration = one.isSetInitialConcentration()
    value = one.getInitialConcentration() if by_concentration else one.getInitialAmount()
    found = symbols.start(name, value if by_concentration or one.isSetInitialAmount() else None, one)
    if name in symbols.initial or not (by_concentration or one.isSetInitialAmount()):
        return found
    if symbols.is_amount(one):
        return product(found, size_of(one)) if by_concentration else found
    return found if by_concentration else quotient(found, size_of(one))


def _quantity(symbols: Symbols, one: Any, value: float | None) -> None:
    _add(symbols, one, symbols.start(one.getId(), value, one))


def _add(symbols: Symbols, one: Any, start: Expression) -> None:
    """Add a quantity as what it is: a variable, a state, held between events, or a parameter."""
    name, model = one.getId(), symbols.model
    if name in symbols.assigned:
        value = symbols.formula(symbols.assigned[name], name)
        model.variables.append(Quantity(name, value, _comment(one)))
    elif name in symbols.rated:
        model.states.append(State(name, symbols.formula(symbols.rated[name], name), start, _comment(one)))
    elif name in symbols.by_events:
        model.held.append(Quantity(name, start, _comment(one)))
    else:
        model.parameters.append(Quantity(name, start, _comment(one)))


def _comment(one: Any) -> str:
    """Return an element's name for people, where it has one of its own."""
    name = " ".join(one.getName().split()) if one.isSetName() else ""
    return "" if name == one.getId() else name
