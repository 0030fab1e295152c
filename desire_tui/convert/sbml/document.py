"""A text as libSBML's document, brought to one form; libSBML is imported here and nowhere else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.convert.problem import placed
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.source import Span

if TYPE_CHECKING:
    from desire_tui.engine.source import Source

_STEPS: tuple[tuple[str, dict[str, object]], ...] = (
    ("flatten comp", {"performValidation": False}),
    ("setLevelAndVersion", {"strict": False}),
    ("expandFunctionDefinitions", {}),
    ("promoteLocalParameters", {}),
)
"""Converters of libSBML's, in the order in which they are applied."""


def library() -> Any:
    """Return libSBML. DesireError: it is not installed."""
    try:
        import libsbml
    except ImportError:
        raise DesireError(Diagnostic("convert-library", facts={"library": "python-libsbml"})) from None
    return libsbml


def document(source: Source, problems: list[Diagnostic]) -> Any:
    """Return libSBML's model of a file. DesireError: it cannot be read as SBML.

    Packages that change what a model means and are not known here are `problems`.
    """
    libsbml = library()
    read = libsbml.readSBMLFromString(source.text)
    serious = [
        read.getError(k)
        for k in range(read.getNumErrors())
        if read.getError(k).getSeverity() >= libsbml.LIBSBML_SEV_ERROR
    ]
    if serious:
        raise DesireError(*(_unreadable(source, error) for error in serious))
    if read.getModel() is None:
        facts = {"path": source.file_name, "reason": "there is no model"}
        raise DesireError(Diagnostic("convert-unreadable", None, facts, source))
    _packages(read, source, problems)
    _fast_reactions(read.getModel(), source, problems)
    for name, options in _STEPS:
        properties = libsbml.ConversionProperties(libsbml.SBMLNamespaces(3, 2))
        properties.addOption(name, True)
        for option, value in options.items():
            properties.addOption(option, value)
        read.convert(properties)
    # a model owns nothing: the document must live as long as it
    return read


def _unreadable(source: Source, error: Any) -> Diagnostic:
    reason = " ".join(error.getMessage().split()).rstrip(".")
    place = line_span(source, error.getLine())
    return Diagnostic("convert-unreadable", place, {"path": source.file_name, "reason": reason}, source)


_KNOWN = frozenset({"l3v2extendedmath", "comp", "layout", "render", "fbc", "groups", "qual"})
"""Packages that are flattened, or that say nothing about rates."""


def _packages(read: Any, source: Source, problems: list[Diagnostic]) -> None:
    for k in range(read.getNumPlugins()):
        name = read.getPlugin(k).getPackageName()
        if name not in _KNOWN and read.getPackageRequired(name):
            problems.append(placed(source, line_span(source, 1), "convert-part", f"package {name}",
                                   "it changes what the model means"))  # fmt: skip


def _fast_reactions(sbml: Any, source: Source, problems: list[Diagnostic]) -> None:
    """Refuse reactions that are equilibria: level 3 version 2 has none, and the converter drops the word."""
    for k in range(sbml.getNumReactions()):
        reaction = sbml.getReaction(k)
        if reaction.isSetFast() and reaction.getFast():
            reason = "equilibria of fast reactions are not solved here"
            span = line_span(source, reaction.getLine())
            problems.append(placed(source, span, "convert-part", reaction.getId(), reason))


def line_span(source: Source, line: int) -> Span | None:
    """Return the place of a line of the file, from 1; None: there is none."""
    text = source.line(line)
    if not text.strip():
        return None
    start = source.line_starts[line - 1] + len(text) - len(text.lstrip())
    return Span(start, start + len(text.strip()))
