"""Equations, fixed and auxiliary quantities of an `.ode` file, and what of them is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import ZERO, Name
from desire_tui.convert.model import Quantity, State
from desire_tui.convert.ordering import CircularError, in_order, needed_by
from desire_tui.convert.xppaut.algebraic import algebraic
from desire_tui.convert.xppaut.networks import networks

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.logical_lines import Line


def equations(building: Building) -> None:
    """Add states, variables and what is shown to the model."""
    _states(building)
    _variables(building)
    algebraic(building)
    _shown(building)
    _drawn(building)


def _states(building: Building) -> None:
    model, seen = building.model, set[str]()
    for one in building.of("rate", "next"):
        name = one.name.lower()
        if name in seen:
            building.refuse(one.line, f"'{one.name}' has an equation already")
            continue
        seen.add(name)
        start, _ = building.starts.pop(name, (ZERO, one.line))
        rate = building.formula(one.right, one.line)
        model.states.append(State(building.spelling[name], rate, start, one.line.comment))
    for process in model.markov:
        if process.name.lower() in building.starts:
            process.initial = building.starts.pop(process.name.lower())[0]
    for name, (start, line) in building.starts.items():
        if name in building.spelling:  # a fixed quantity: what others read before it is computed
            model.held.append(Quantity(building.spelling[name], start))
        else:
            building.note(line, name, "there is no such variable: its initial value is left out")


def _variables(building: Building) -> None:
    """Read fixed quantities; those that stand below the use of their values are moved up."""
    found: dict[str, Quantity] = {}
    lines: dict[str, Line] = {}
    for one in building.of("fixed"):
        name = building.spelling[one.name.lower()]
        if name in found or one.name.lower() in building.states:
            building.refuse(one.line, f"'{one.name}' has a formula already")
            continue
        found[name] = Quantity(name, building.formula(one.right, one.line), one.line.comment)
        lines[name] = one.line
    for network in networks(building):
        found[network.name] = network
    functions = {function.name: function for function in building.model.functions}
    needs = {name: needed_by(one.value, functions) & found.keys() - {name} for name, one in found.items()}
    try:
        order = in_order(needs)
    except CircularError as circle:
        line = next(lines[name] for name in circle.names if name in lines)
        building.refuse(line, f"these wait for each other: {circle}")
        order = list(found)
    above: set[str] = set()
    for name in found:
        for late in sorted(needs[name] - above if name in lines else ()):
            building.note(
                lines[name], late, "it stands below its use; XPPAUT takes its value of the step before, "
                "here it is computed above",
            )  # fmt: skip
        above.add(name)
    building.model.variables.extend(found[name] for name in order)


def _shown(building: Building) -> None:
    taken = {*building.spelling.values()}
    for one in building.of("aux"):
        name, sign, formula = one.right.partition("=")
        name = name.strip()
        if not sign or not name:
            building.refuse(one.line, "it is no name=formula")
            continue
        value = building.formula(formula, one.line)
        if isinstance(value, Name) and value.name.lower() == name.lower():
            continue  # the quantity of that name itself
        while name in taken or name.lower() in building.spelling:
            name = f"{name}_aux"
        taken.add(name)
        building.model.shown.append(Quantity(name, value, one.line.comment))


def _drawn(building: Building) -> None:
    model, settings = building.model, building.model.settings
    known = {**building.spelling, **{shown.name.lower(): shown.name for shown in model.shown}}
    only = [name.lower() for one in building.of("only") for name in one.right.replace(",", " ").split()]
    settings.ordinates = tuple(known[name] for name in only if name in known)
    x, y = building.options.axes
    if x != "t" and x in known:
        settings.abscissa = known[x]
        others = [state.name for state in model.states if state.name != known[x]]
        settings.ordinates = (known[y],) if y in known else tuple(others[:1]) or (known[x],)
