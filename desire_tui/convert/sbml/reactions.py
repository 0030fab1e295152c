"""Reactions of an SBML model: their rates as variables, and how fast they change the amounts of species."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.convert.expressions import ONE, Binary, Expression, Name, Negative, number, product, total
from desire_tui.convert.model import Quantity

if TYPE_CHECKING:
    from desire_tui.convert.sbml.symbols import Symbols


def reactions(symbols: Symbols) -> dict[str, Expression]:
    """Add the rates to the model's variables; return how fast they change the amounts of species."""
    terms: dict[str, list[Expression]] = {}
    for k in range(symbols.sbml.getNumReactions()):
        reaction = symbols.sbml.getReaction(k)
        law = reaction.getKineticLaw()
        if law is None or law.getMath() is None:
            symbols.refuse(reaction, reaction.getId(), "the reaction has no rate")
            continue
        name = " ".join(reaction.getName().split()) if reaction.isSetName() else ""
        rate = symbols.formula(law, reaction.getId())
        comment = "" if name == reaction.getId() else name
        symbols.model.variables.append(Quantity(reaction.getId(), rate, comment))
        for references, sign in ((reaction.getListOfReactants(), -1), (reaction.getListOfProducts(), 1)):
            for place in range(references.size()):
                _add(references.get(place), sign, Name(reaction.getId()), symbols, terms)
    return {name: total(changes) for name, changes in terms.items()}


def _add(
    reference: Any, sign: int, rate: Expression, symbols: Symbols, terms: dict[str, list[Expression]]
) -> None:
    one = symbols.sbml.getSpecies(reference.getSpecies())
    if one is None or one.getBoundaryCondition() or one.getConstant():
        return
    change = product(_stoichiometry(reference, symbols), rate)
    factor = one.getConversionFactor() or symbols.sbml.getConversionFactor()
    if factor:
        change = Binary("*", change, Name(factor))
    terms.setdefault(one.getId(), []).append(change if sign > 0 else Negative(change))


def _stoichiometry(reference: Any, symbols: Symbols) -> Expression:
    if reference.isSetId():
        return Name(reference.getId())
    if reference.isSetStoichiometryMath():
        return symbols.formula(reference.getStoichiometryMath(), reference.getSpecies())
    if not reference.isSetStoichiometry():
        return ONE
    value = reference.getStoichiometry()
    if value != value:  # noqa: PLR0124 - nan
        symbols.refuse(reference, reference.getSpecies(), "its stoichiometry is no number")
        return ONE
    return number(value / (reference.getDenominator() or 1))
