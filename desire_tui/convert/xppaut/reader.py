"""An `.ode` file as a model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.model import Model
from desire_tui.convert.problem import place
from desire_tui.convert.xppaut.building import Building
from desire_tui.convert.xppaut.declarations import declaration
from desire_tui.convert.xppaut.equations import equations
from desire_tui.convert.xppaut.flags import events
from desire_tui.convert.xppaut.logical_lines import logical_lines
from desire_tui.convert.xppaut.presets import presets, read_options, settings
from desire_tui.convert.xppaut.quantities import quantities
from desire_tui.engine.data_classes import replace

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.logical_lines import Line
    from desire_tui.engine.source import Source

_REFUSED = {
    "volterra": "Volterra integral equations are not solved here",
    "volt": "Volterra integral equations are not solved here",
    "algebraic": "algebraic equations are not solved here",
    "solve": "algebraic equations are not solved here",
    "special": "this network function has no counterpart here",
    "export": "functions of a library are not called here",
    "options": "options in a file of their own are not read; copy them into the file behind @",
    "unknown": "it is no declaration of XPPAUT's",
    "matrix row": "no markov line stands above it",
}


def read_ode(source: Source) -> Model:
    """Return the model that an `.ode` file describes; what could not be taken over is among its problems."""
    title = source.file_name.removesuffix(".ode")
    model = Model(title, f"{source.file_name} (XPPAUT)")
    lines = logical_lines(source, model.problems)
    if lines:
        model.comment, lines[0] = _header(lines[0])
    building = Building(model, [declaration(line) for line in lines])
    read_options(building)
    quantities(building)
    equations(building)
    model.events.extend(events(building))
    presets(building)
    settings(building)
    _left_over(building)
    model.problems.sort(key=place)
    return model


def _header(line: Line) -> tuple[str, Line]:
    """Return the comment at the top of the file, up to its last blank line, and the first line without it."""
    above, blank, below = line.comment.rpartition("\n\n")
    return above if blank else below, replace(line, comment=below if blank else "")


def _left_over(building: Building) -> None:
    for one in building.declarations:
        if one.kind in _REFUSED and one not in building.used:
            building.refuse(one.line, _REFUSED[one.kind])
        elif one.kind == "bndry":
            reason = "boundary values are not fitted here; the initial-value problem is converted"
            building.note(one.line, one.line.text, reason)
