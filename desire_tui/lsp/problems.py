"""Problems as the protocol's diagnostics, and what would mend them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from desire_tui.engine.source import Span
from desire_tui.language.problem_marks import mark_of
from desire_tui.lsp.positions import Places, units

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.lsp.documents import Snapshot

PAGE = "https://desire-tui.github.io/desire-tui/errors/#error-{code}"
SHOWN_MAX = 1000
"""Editors get slow with more problems than anybody reads."""
_SEVERITIES = {"error": types.DiagnosticSeverity.Error, "warning": types.DiagnosticSeverity.Warning}


def diagnostics_of(problems: Sequence[Diagnostic], uri: str, snapshot: Snapshot) -> list[types.Diagnostic]:
    """Return problems of a text; those without a place stand at its beginning."""
    return [_diagnostic(problem, uri, snapshot) for problem in problems[:SHOWN_MAX]]


def _diagnostic(problem: Diagnostic, uri: str, snapshot: Snapshot) -> types.Diagnostic:
    related = [
        types.DiagnosticRelatedInformation(
            types.Location(uri, snapshot.places.range(other.span)), other.message
        )
        for other in problem.related
        if other.span is not None and other.source in (None, snapshot.source)
    ]
    data: dict[str, object] = {"key": problem.key}
    mark = mark_of(problem.within(snapshot.source))
    if mark is not None and mark.fix is not None:
        start, old, new = mark.fix
        row = snapshot.source.line(mark.row + 1)
        first = units(row[:start], snapshot.encoding)
        data["fix"] = [mark.row, first, first + units(old, snapshot.encoding), old, new]
    return types.Diagnostic(
        range=_range(problem.span, snapshot.places),
        message=problem.message + (f"\n{problem.hint}" if problem.hint else ""),
        severity=_SEVERITIES[problem.severity],
        code=problem.code,
        code_description=types.CodeDescription(PAGE.format(code=problem.code)),
        source="desire",
        related_information=related or None,
        data=data,
    )


def _range(span: Span | None, places: Places) -> types.Range:
    """Return a problem's place; one character at least, which editors underline."""
    if span is None:
        return types.Range(types.Position(0, 0), types.Position(0, 0))
    return places.range(span if span.end > span.start else Span(span.start, span.start + 1))


def fixes_of(diagnostics: Iterable[types.Diagnostic], uri: str) -> list[types.CodeAction]:
    """Return an action for each diagnostic whose hint is another word."""
    actions = []
    for diagnostic in diagnostics:
        data = diagnostic.data
        if not isinstance(data, dict) or "fix" not in data:
            continue
        row, start, end, old, new = data["fix"]
        where = types.Range(types.Position(row, start), types.Position(row, end))
        actions.append(
            types.CodeAction(
                title=f"Change '{old}' to '{new}'",
                kind=types.CodeActionKind.QuickFix,
                diagnostics=[diagnostic],
                is_preferred=True,
                edit=types.WorkspaceEdit(changes={uri: [types.TextEdit(where, new)]}),
            )
        )
    return actions
