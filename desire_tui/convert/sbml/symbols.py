"""What an SBML model says about its names: which rules and events change them, and what a species stands for.

In formulas a species is its concentration, or its amount where it `hasOnlySubstanceUnits` or its compartment
has no size. Reactions change amounts. So a species whose compartment's size changes is integrated as an
amount, and its concentration is a variable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.convert.expressions import OWN_NAMES, ZERO, Expression, Name, names_in, number
from desire_tui.convert.problem import placed
from desire_tui.convert.sbml.document import line_span
from desire_tui.convert.sbml.mathml import UnknownMathError, expression_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.model import Model
    from desire_tui.engine.source import Source


class Symbols:
    """libSBML's model with what its rules, events and reactions do, by the names of what they change."""

    def __init__(self, sbml: Any, source: Source, model: Model) -> None:
        self.sbml, self.source, self.model = sbml, source, model
        rules = [sbml.getRule(k) for k in range(sbml.getNumRules())]
        self.assigned = {rule.getVariable(): rule for rule in rules if rule.isAssignment()}
        self.rated = {rule.getVariable(): rule for rule in rules if rule.isRate()}
        for rule in rules:
            if rule.isAlgebraic():
                self.refuse(rule, "algebraicRule", "algebraic equations are not solved here")
        starts = [sbml.getInitialAssignment(k) for k in range(sbml.getNumInitialAssignments())]
        self.initial = {one.getSymbol(): one for one in starts}
        self.by_events = {
            event.getEventAssignment(k).getVariable()
            for event in self.events()
            for k in range(event.getNumEventAssignments())
        }
        self.taken = {one.getId() for one in self._with_ids()}

    def _with_ids(self) -> Iterator[Any]:
        elements = self.sbml.getListOfAllElements()
        for k in range(elements.getSize()):
            one = elements.get(k)
            if one.isSetId() and self.sbml.getElementBySId(one.getId()) is not None:
                yield one

    def events(self) -> list[Any]:
        """Return the model's events in their order."""
        return [self.sbml.getEvent(k) for k in range(self.sbml.getNumEvents())]

    def fresh(self, wanted: str) -> str:
        """Return a name that nothing in the model has."""
        name, count = wanted, 0
        while name in self.taken:
            count += 1
            name = f"{wanted}{count}"
        self.taken.add(name)
        return name

    def refuse(self, element: Any, what: str, reason: str) -> None:
        """Say that a part of the model is not taken over."""
        place = line_span(self.source, element.getLine())
        self.model.problems.append(placed(self.source, place, "convert-part", what, reason))

    def note(self, element: Any, what: str, reason: str) -> None:
        """Say that a part of the model was taken over in another way."""
        place = line_span(self.source, element.getLine())
        self.model.problems.append(placed(self.source, place, "convert-note", what, reason))

    def formula(self, element: Any, what: str) -> Expression:
        """Return the formula of an element that has one; 0 where it cannot be said: a problem."""
        try:
            found = expression_of(element.getMath() if element is not None else None)
        except UnknownMathError as reason:
            self.refuse(element, what, str(reason))
            return ZERO
        for name in sorted(names_in(found) - self.taken - OWN_NAMES):
            self.refuse(element, what, f"'{name}' is declared nowhere")
        return found

    # --------------------------------------------------------------------------------------------- species

    def is_amount(self, species: Any) -> bool:
        """Whether the species stands for its amount in formulas."""
        compartment = self.sbml.getCompartment(species.getCompartment())
        if compartment is None:
            return True  # told by `parts`
        sizeless = compartment.isSetSpatialDimensions() and compartment.getSpatialDimensionsAsDouble() == 0
        return bool(species.getHasOnlySubstanceUnits() or sizeless)

    def size_changes(self, species: Any) -> bool:
        """Whether the size of the species' compartment changes while the model runs."""
        name = species.getCompartment()
        return name in self.assigned or name in self.rated or name in self.by_events

    def held_as_amount(self, species: Any) -> bool:
        """Whether the species is integrated as an amount though it stands for a concentration."""
        ruled = species.getId() in self.assigned or species.getId() in self.rated
        return not self.is_amount(species) and self.size_changes(species) and not ruled

    def amount_name(self, name: str) -> str | None:
        """Return what holds the amount of a species that is integrated so; None for anything else."""
        species = self.sbml.getSpecies(name)
        if species is None or not self.held_as_amount(species):
            return None
        return f"{name}_amount" if f"{name}_amount" not in self.taken else f"{name}_amount_of_species"

    def start(self, name: str, value: float | None, element: Any) -> Expression:
        """Return a quantity's initial value: its initial assignment's, else `value`; 0 if it has none."""
        if name in self.initial:
            return self.formula(self.initial[name], name)
        if value is None or value != value:  # noqa: PLR0124 - nan
            if name not in self.assigned:
                self.note(element, name, "it has no initial value: 0 is taken")
            return ZERO
        try:
            return number(value)
        except OverflowError:
            return ZERO


def size_of(species: Any) -> Expression:
    """Return the size of a species' compartment."""
    return Name(species.getCompartment())
