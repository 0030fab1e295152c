"""An SBML file as a model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import (
    ONE,
    ZERO,
    Call,
    Expression,
    Name,
    names_in,
    with_parts,
)
from desire_tui.convert.model import Model, Settings, State
from desire_tui.convert.ordering import in_order
from desire_tui.convert.problem import place
from desire_tui.convert.sbml.document import document
from desire_tui.convert.sbml.events import events
from desire_tui.convert.sbml.mathml import RATE_OF
from desire_tui.convert.sbml.parts import plain_quantities, species
from desire_tui.convert.sbml.reactions import reactions
from desire_tui.convert.sbml.symbols import Symbols

if TYPE_CHECKING:
    from desire_tui.engine.source import Source

DURATION = 10.0
"""How long the program runs: SBML says nothing about it."""
TOLERANCE = 1e-9
SAMPLES = 1001


def read_sbml(source: Source) -> Model:
    """Return the model of an SBML file; what could not be taken over is among its problems.

    DesireError: it cannot be read as SBML, libSBML is not installed, or quantities wait for each other.
    """
    model = Model(source.file_name.rpartition(".")[0], f"{source.file_name} (SBML)")
    read = document(source, model.problems)
    sbml = read.getModel()
    model.title = " ".join(sbml.getName().split()) or sbml.getId() or model.title
    symbols = Symbols(sbml, source, model)
    plain_quantities(symbols)
    species(symbols, reactions(symbols))
    events(symbols)
    if not model.states:  # times of events and samples need a run that integrates
        model.states.append(State(symbols.fresh("clock"), ONE))
    _rates(model, symbols)
    _order(model)
    _settings(model, symbols)
    model.problems.sort(key=place)
    return model


def _order(model: Model) -> None:
    """Put variables in an order in which they can be computed. CircularError."""
    found = {variable.name: variable for variable in model.variables}
    order = in_order({name: names_in(variable.value) for name, variable in found.items()})
    model.variables = [found[name] for name in order]


def _rates(model: Model, symbols: Symbols) -> None:
    """Put derivatives in the place of SBML's `rateOf`: those of states are known, what is constant has 0."""
    rates = {state.name: state.rate for state in model.states}
    constant = {one.name for one in [*model.parameters, *model.held]}

    def known(expression: Expression) -> Expression:
        if isinstance(expression, Call) and expression.function == RATE_OF:
            (what,) = expression.arguments
            if isinstance(what, Name) and what.name in rates:
                return known(rates[what.name])
            if not (isinstance(what, Name) and what.name in constant):
                symbols.refuse(symbols.sbml, "rateOf", "the derivative of what has no equation is not known")
            return ZERO
        return with_parts(expression, known)

    for variable in model.variables:
        variable.value = known(variable.value)
    for state in model.states:
        state.rate = known(state.rate)


def _settings(model: Model, symbols: Symbols) -> None:
    names = [symbols.sbml.getSpecies(k).getId() for k in range(symbols.sbml.getNumSpecies())]
    model.settings = Settings(rule=14, duration=DURATION, samples=SAMPLES, tolerance=TOLERANCE)
    changing = {state.name for state in model.states}
    changing |= {one.name for one in [*model.variables, *model.held]}
    model.settings.ordinates = tuple(name for name in names if name in changing)[:12]
