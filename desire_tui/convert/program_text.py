"""A model as a Desire program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.layout import comment_lines
from desire_tui.convert.names import NameTable, names_of
from desire_tui.convert.run_part import run_lines
from desire_tui.convert.script_part import script_lines
from desire_tui.convert.segment_part import segment_lines

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.model import Model


def program_text(model: Model) -> tuple[str, dict[str, str]]:
    """Return the program, and what it calls otherwise than the model's file: old names with new ones.

    CircularError: parameters or initial values wait for each other.
    """
    names = NameTable(names_of(model))
    return "\n".join(_lines(model, names)) + "\n", names.renamed


def _lines(model: Model, names: NameTable) -> Iterator[str]:
    is_map = model.settings.rule == 0
    next_names = {state.name: names.fresh(f"next_{names(state.name)}") for state in model.states if is_map}
    ended = names.fresh("ended") if any(event.ends_run for event in model.events) else ""
    yield f"-- {model.title} -- converted from {model.origin}"
    yield from comment_lines(model.comment)
    yield from _notes(model, names)
    yield from script_lines(model, names, next_names)
    if ended:
        yield f"{ended} = 0"
    yield from run_lines(model.settings)
    yield "DYNAMIC"
    yield from segment_lines(model, names, next_names, ended)


def _notes(model: Model, names: NameTable) -> Iterator[str]:
    """Yield what differs from the model's file, so that it stays with the program."""
    for problem in model.problems:
        place = "" if problem.line is None else f"line {problem.line}: "
        yield f"-- ! {place}{problem.message}"
    for old, new in names.renamed.items():
        yield f"-- ! {old} is called {new} here"
