"""A program's outline, what folds, and its usual layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from desire_tui.engine.source import Span
from desire_tui.language.formatter import ends_whole, layout
from desire_tui.language.outline import folds, outline

if TYPE_CHECKING:
    from desire_tui.language.outline import Entry, EntryKind
    from desire_tui.lsp.documents import Snapshot

_KINDS: dict[EntryKind, types.SymbolKind] = {
    "segment": types.SymbolKind.Namespace, "state": types.SymbolKind.Field,
    "variable": types.SymbolKind.Variable, "parameter": types.SymbolKind.Constant,
    "array": types.SymbolKind.Array, "function": types.SymbolKind.Function,
    "definition": types.SymbolKind.Method, "label": types.SymbolKind.Key,
}  # fmt: skip


def symbols(snapshot: Snapshot) -> list[types.DocumentSymbol]:
    """Return the outline."""
    return [_symbol(snapshot, entry) for entry in outline(snapshot.names)]


def _symbol(snapshot: Snapshot, entry: Entry) -> types.DocumentSymbol:
    places = snapshot.places
    return types.DocumentSymbol(
        name=entry.name, kind=_KINDS[entry.kind], detail=entry.detail, range=places.range(entry.span),
        selection_range=places.range(entry.name_span),
        children=[_symbol(snapshot, child) for child in entry.children] or None,
    )  # fmt: skip


def folding(snapshot: Snapshot) -> list[types.FoldingRange]:
    """Return what can be folded."""
    comment = types.FoldingRangeKind.Comment
    return [
        types.FoldingRange(
            first, last, kind=comment if snapshot.lines[first].lstrip().startswith("--") else None
        )
        for first, last in folds(snapshot.names, snapshot.lines)
    ]


def formatting(snapshot: Snapshot, rows: types.Range | None = None) -> list[types.TextEdit]:
    """Return the edits that give a program, or those rows of it, the usual layout: cursors stay."""
    text, starts, lines = snapshot.source.text, snapshot.source.line_starts, snapshot.lines
    edits = []
    first, last = (0, len(lines)) if rows is None else (rows.start.line, rows.end.line)
    for part in layout(text):
        top, behind = part.rows.start, part.rows.stop
        if top < first or behind - 1 > last:
            continue
        if part.text is None:
            span = Span(starts[top], starts[behind] if behind < len(starts) else len(text))
            edits.append(types.TextEdit(snapshot.places.range(span), ""))
        elif part.text != "\n".join(lines[top:behind]):
            end = starts[behind - 1] + len(lines[behind - 1])
            edits.append(types.TextEdit(snapshot.places.range(Span(starts[top], end)), part.text))
    if rows is None and lines[-1].strip() and ends_whole(text):
        last_place = snapshot.places.position(len(text))
        edits.append(types.TextEdit(types.Range(last_place, last_place), "\r\n" if "\r\n" in text else "\n"))
    return edits
