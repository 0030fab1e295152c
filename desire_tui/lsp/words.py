"""What can be typed at a place, and what stands there: completion and hover."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.source import Span
from desire_tui.engine.values import SYSTEM_VARIABLES
from desire_tui.help.page_catalogue import find
from desire_tui.language.completion import OFFERED_MAX, OWN_NAME, around, offers
from desire_tui.language.descriptions import described
from desire_tui.language.file_columns import file_columns
from desire_tui.language.line_tokens import joined_word_at, word_before

if TYPE_CHECKING:
    from desire_tui.language.completion import Offer
    from desire_tui.lsp.documents import Snapshot


def completions(snapshot: Snapshot, position: types.Position) -> types.CompletionList:
    """Return what fits the beginning of a word before a place, the likeliest first."""
    row, column = _row_and_column(snapshot, position)
    prefix = word_before(snapshot.lines[row], column)
    lines = around(snapshot.lines, row)
    known = file_columns(lines, snapshot.source.path)
    known |= {name: f"= {value:.6g}" for name, value in snapshot.values.items()}
    found = offers(prefix, lines, known) if prefix or not _in_prose(snapshot, row, column) else []
    start = snapshot.places.offset(position) - len(prefix)
    where = types.Range(snapshot.places.position(start), position)
    items = [_item(offer, number, where) for number, offer in enumerate(found)]
    return types.CompletionList(is_incomplete=len(found) >= OFFERED_MAX, items=items)


def explained(item: types.CompletionItem) -> types.CompletionItem:
    """Return an offer with the help page of its word."""
    page = find(item.label)
    if page is not None and item.detail != OWN_NAME:
        item.documentation = types.MarkupContent(types.MarkupKind.Markdown, page.markdown)
    return item


def hover(snapshot: Snapshot, position: types.Position) -> types.Hover | None:
    """Return what is known of the word at a place: the program's own names first, then the help pages."""
    offset = snapshot.places.offset(position)
    found = snapshot.names.at(offset)
    if found is not None:
        text = described(snapshot.names, found, snapshot.values)
        where = snapshot.places.range(Span(found.start, found.end))
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text), where)
    row, column = _row_and_column(snapshot, position)
    if _in_prose(snapshot, row, column):
        return None
    page = find(joined_word_at(snapshot.lines, row, column))
    return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, page.markdown)) if page else None


def _row_and_column(snapshot: Snapshot, position: types.Position) -> tuple[int, int]:
    row, column = snapshot.source.position(snapshot.places.offset(position))
    return row - 1, column - 1


def _in_prose(snapshot: Snapshot, row: int, column: int) -> bool:
    """Whether a place is in a comment or a string."""
    from desire_tui.language.line_tokens import ANY_TEXT, tokens_of

    line = tokens_of(snapshot.lines[row])
    if any(start < column <= end for start, end in line.comments):
        return True
    tokens = (token for statement in line.statements for token in statement)
    return any(token.start < column < token.end and token.kind in ANY_TEXT for token in tokens)


def _item(offer: Offer, number: int, where: types.Range) -> types.CompletionItem:
    return types.CompletionItem(
        label=offer.word,
        kind=_kind(offer),
        detail=offer.about,
        sort_text=f"{number:03}",
        filter_text=offer.word,
        text_edit=types.TextEdit(where, offer.word),
    )


def _kind(offer: Offer) -> types.CompletionItemKind:
    if offer.word in LIBRARY:
        return types.CompletionItemKind.Function
    if offer.word in SYSTEM_VARIABLES:
        return types.CompletionItemKind.Constant
    is_own = offer.about == OWN_NAME or offer.about.startswith("= ")
    return types.CompletionItemKind.Variable if is_own else types.CompletionItemKind.Keyword
