"""A file of another program in, a Desire program and what is to be said about it out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.ordering import CircularError
from desire_tui.convert.program_text import program_text
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from desire_tui.convert.model import Model

ENDINGS = (".ode", ".xml", ".sbml")
"""Names of files that can be converted end so."""


@dataclass(frozen=True)
class Conversion:
    """A Desire program made from another program's model.

    `problems`: errors for what could not be taken over, without which the program is not the model;
    warnings for what was done in another way.
    """

    text: str
    problems: tuple[Diagnostic, ...]

    @property
    def complete(self) -> bool:
        """Whether the program says all that the model says."""
        return all(problem.severity != "error" for problem in self.problems)


def is_convertible(name: str) -> bool:
    """Whether a file of this name may hold a model that `convert` reads."""
    return name.lower().endswith(ENDINGS)


def convert(source: Source) -> Conversion:
    """Convert a model of XPPAUT (`.ode`) or in SBML.

    DesireError: the file is neither, or cannot be read as what it is; a library is missing.
    """
    try:
        model = _read(source)
        text, renamed = program_text(model)
    except CircularError as circle:
        facts = {"what": circle.names[0], "reason": f"these wait for each other: {circle}"}
        raise DesireError(Diagnostic("convert-part", None, facts, source)) from None
    notes = [_renaming(source, old, new) for old, new in renamed.items()]
    return Conversion(text, (*model.problems, *notes))


def _read(source: Source) -> Model:
    if source.text.lstrip("\ufeff \t\r\n").startswith("<"):
        from desire_tui.convert.sbml.reader import read_sbml

        return read_sbml(source)
    if not source.name.lower().endswith(".ode"):
        raise DesireError(Diagnostic("convert-kind", facts={"path": source.file_name}))
    from desire_tui.convert.xppaut.reader import read_ode

    return read_ode(source)


def _renaming(source: Source, old: str, new: str) -> Diagnostic:
    whole = Span(0, len(source.text))
    place = source.name_within(whole, old)
    return Diagnostic(
        "convert-renamed", None if place == whole else place, {"old": old, "new": new}, source, "warning"
    )
