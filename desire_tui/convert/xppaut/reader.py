"""An `.ode` file as a model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.model import Model
from desire_tui.convert.xppaut.building import Building
from desire_tui.convert.xppaut.declarations import declaration
from desire_tui.convert.xppaut.logical_lines import logical_lines

if TYPE_CHECKING:
    from desire_tui.engine.source import Source


def read_ode(source: Source) -> Model:
    """Return the model that an `.ode` file describes; what could not be taken over is among its problems."""
    title = source.file_name.removesuffix(".ode")
    model = Model(title, f"{source.file_name} (XPPAUT)")
    lines = logical_lines(source, model.problems)
    Building(model, [declaration(line) for line in lines]).build()
    return model
