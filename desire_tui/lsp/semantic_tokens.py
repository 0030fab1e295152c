"""Colours of a program's words, from the parser's own tokens (LSP 3.17, "Semantic Tokens")."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.syntax.highlighting import highlight
from desire_tui.engine.syntax.logical_lines import logical_lines
from desire_tui.lsp.positions import units

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.syntax.highlighting import Class
    from desire_tui.lsp.documents import Snapshot

LEGEND = types.SemanticTokensLegend(
    token_types=["keyword", "function", "variable", "string", "comment", "number", "operator"],
    token_modifiers=["defaultLibrary"],
)
_OF_THE_LANGUAGE = 1
_TYPES: dict[Class, tuple[int, int]] = {
    "keyword": (0, 0), "function": (1, _OF_THE_LANGUAGE), "system": (2, _OF_THE_LANGUAGE), "name": (2, 0),
    "string": (3, 0), "comment": (4, 0), "number": (5, 0), "operator": (6, 0),
}  # fmt: skip
ROOM = 2_000_000
"""Characters of lines whose tokens are kept."""

Token = tuple[int, int, int, int, int]
"""Row within its line, column, length, type, modifiers."""
_kept: RecentlyUsed[tuple[str, str], tuple[Token, ...]] = RecentlyUsed(
    ROOM, cost=lambda key: len(key[0]) + 100
)


def semantic_tokens(snapshot: Snapshot, first: int = 0, last: int | None = None) -> list[int]:
    """Return the tokens of the rows `first` … `last`, each by five numbers that count from the one before."""
    data: list[int] = []
    row_before = column_before = 0
    for top, text in _lines(snapshot, first, last):
        for row, column, length, kind, modifiers in _tokens(text, snapshot.encoding):
            if top + row != row_before:
                column_before = 0
            data += (top + row - row_before, column - column_before, length, kind, modifiers)
            row_before, column_before = top + row, column
    _kept.age()
    return data


def _lines(snapshot: Snapshot, first: int, last: int | None) -> Iterator[tuple[int, str]]:
    """Yield the rows of each line with the number of its first; those that go on are one text."""
    lines = snapshot.lines
    end = len(lines) if last is None else min(last + 1, len(lines))
    joined = {rows.start: rows.stop for _, _, _, rows in logical_lines(snapshot.source.text) if len(rows) > 1}
    row = 0
    while row < end:
        stop = joined.get(row, row + 1)
        if stop > first:
            yield row, lines[row] if stop == row + 1 else "\n".join(lines[row:stop])
        row = stop


def _tokens(text: str, encoding: str) -> tuple[Token, ...]:
    known = _kept[text, encoding]
    if known is None:
        known = tuple(_made(text, encoding))
        _kept.keep((text, encoding), known)
    return known


def _made(text: str, encoding: str) -> Iterator[Token]:
    """Yield the tokens of a line; one that `_` carries into the next row is two."""
    rows = text.split("\n")
    starts = [0]
    for before in rows[:-1]:
        starts.append(starts[-1] + len(before) + 1)
    for start, end, name in highlight(text):
        kind, modifiers = _TYPES[name]
        for number, (row, at) in enumerate(zip(rows, starts, strict=True)):
            a, b = max(start - at, 0), min(end - at, len(row))
            if a < b:
                column = units(row[:a], encoding)
                yield number, column, units(row[a:b], encoding), kind, modifiers
