"""Where a name is defined and used, and its change everywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

from desire_tui.engine.source import Span
from desire_tui.language.rename import RenameRefusedError, renamed

if TYPE_CHECKING:
    from desire_tui.language.names import Occurrence
    from desire_tui.lsp.documents import Snapshot


def _at(snapshot: Snapshot, position: types.Position) -> Occurrence | None:
    return snapshot.names.at(snapshot.places.offset(position))


def _range(snapshot: Snapshot, place: Occurrence) -> types.Range:
    return snapshot.places.range(Span(place.start, place.end))


def definition(snapshot: Snapshot, uri: str, position: types.Position) -> types.Location | None:
    """Return where the name at a place gets its meaning."""
    found = _at(snapshot, position)
    place = snapshot.names.definition(found.symbol) if found is not None else None
    return types.Location(uri, _range(snapshot, place)) if place is not None else None


def declaration(snapshot: Snapshot, uri: str, position: types.Position) -> types.Location | None:
    """Return where the script first gives it a value."""
    found = _at(snapshot, position)
    place = snapshot.names.first_value(found.symbol) if found is not None else None
    return (
        types.Location(uri, _range(snapshot, place))
        if place is not None
        else definition(snapshot, uri, position)
    )


def references(
    snapshot: Snapshot, uri: str, position: types.Position, *, with_declaration: bool
) -> list[types.Location]:
    """Return all places of the name at a place; without the one that defines it, if so wanted."""
    found = _at(snapshot, position)
    if found is None:
        return []
    defined = None if with_declaration else snapshot.names.definition(found.symbol)
    places = (place for place in snapshot.names.of(found.symbol) if place != defined)
    return [types.Location(uri, _range(snapshot, place)) for place in places]


def highlights(snapshot: Snapshot, position: types.Position) -> list[types.DocumentHighlight]:
    """Return the same for marks in the text: what gives it a value is marked as writing."""
    found = _at(snapshot, position)
    if found is None:
        return []
    read, write = types.DocumentHighlightKind.Read, types.DocumentHighlightKind.Write
    return [
        types.DocumentHighlight(_range(snapshot, place), read if place.use == "read" else write)
        for place in snapshot.names.of(found.symbol)
    ]


def renamable(snapshot: Snapshot, position: types.Position) -> types.PrepareRenamePlaceholder | None:
    """Return the name that would be changed; None: there is none of the program's own."""
    found = _at(snapshot, position)
    if found is None or not found.symbol.is_own:
        return None
    return types.PrepareRenamePlaceholder(range=_range(snapshot, found), placeholder=found.symbol.name)


def rename(snapshot: Snapshot, uri: str, position: types.Position, new: str) -> types.WorkspaceEdit:
    """Return the edits that give a name another one. JsonRpcInvalidParams: it cannot be, with the reason."""
    found = _at(snapshot, position)
    if found is None:
        raise JsonRpcInvalidParams("there is no name here")
    try:
        spans = renamed(snapshot.names, found.symbol, new)
    except RenameRefusedError as reason:
        raise JsonRpcInvalidParams(str(reason)) from None
    edits = [types.TextEdit(snapshot.places.range(span), new) for span in spans]
    return types.WorkspaceEdit(changes={uri: edits})
