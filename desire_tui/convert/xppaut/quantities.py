"""Parameters, functions, tables, initial values and random numbers of an `.ode` file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Expression, number, substituted
from desire_tui.convert.model import Function, Quantity
from desire_tui.convert.xppaut.chance import processes
from desire_tui.convert.xppaut.declarations import pairs
from desire_tui.convert.xppaut.tables import table
from desire_tui.convert.xppaut.vocabulary import NotConvertibleError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.xppaut.building import Building
    from desire_tui.convert.xppaut.declarations import Declaration
    from desire_tui.convert.xppaut.options import Options

_DUMMY = re.compile(r"[a-z]\w*\Z", re.ASCII)
_NO_LIST = "it is no list of name=value"


def quantities(building: Building) -> None:
    """Add them to the model, initial values to the building."""
    model = building.model
    model.parameters.extend(_parameters(building))
    _starts(building)
    for one in building.of("function"):
        if not all(_DUMMY.match(dummy) for dummy in one.dummies):
            building.refuse(one.line, "its arguments are no names")
            continue
        name, body = building.spelling[one.name.lower()], building.formula(one.right, one.line, one.dummies)
        model.functions.append(Function(name, one.dummies, body, one.line.comment))
    for one in building.of("table"):
        try:
            model.tables.append(table(one, building))
        except NotConvertibleError as reason:
            building.refuse(one.line, str(reason))
    for one in building.of("wiener"):
        for name, _, comment in _listed(one, building):
            model.noises.append(Quantity(building.spelling[name.lower()], number(1.0), comment))
    model.markov.extend(processes(building))


def _listed(one: Declaration, building: Building) -> Iterator[tuple[str, str, str]]:
    """Yield names, values ("" if left out) and comments (the first has the line's) of a list."""
    found = pairs(one.right)
    if found is None:
        building.refuse(one.line, _NO_LIST)
    for count, (name, value) in enumerate(found or ()):
        yield name, value, one.line.comment if count == 0 else ""


def _parameters(building: Building) -> Iterator[Quantity]:
    for one in building.of("param", "number"):
        for name, value, comment in _listed(one, building):
            yield Quantity(building.spelling[name.lower()], building.formula(value or "0", one.line), comment)
    for one in building.of("derived"):
        formula = building.formula(one.right, one.line)
        yield Quantity(building.spelling[one.name.lower()], formula, one.line.comment)


def _starts(building: Building) -> None:
    """Read initial values; what `x(0)=` says is the history of delays, too."""
    for one in building.declarations:
        if one.kind == "initial":
            value = building.formula(one.right, one.line)
            if not one.line.written_out:  # of a range XPPAUT takes the initial values only
                building.histories[one.name.lower()] = value
            building.starts[one.name.lower()] = (_at_start(value, building.options), one.line)
        elif one.kind == "init":
            for name, text, _ in _listed(one, building):
                building.starts[name.lower()] = (building.formula(text or "0", one.line), one.line)


def _at_start(value: Expression, options: Options) -> Expression:
    return substituted(value, {"t": number(options.start)})
