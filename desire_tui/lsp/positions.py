"""Places in a text as the protocol counts them: rows from 0, and columns in units of the client's encoding.

LSP 3.17, "Position": a character beyond the Basic Multilingual Plane is two units of UTF-16, which clients
use unless they have agreed on UTF-8 or UTF-32.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from desire_tui.engine.source import Source, Span

_CODECS = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
"""Each encoding with the bytes of a unit."""


def units(text: str, encoding: str) -> int:
    """Return how many units a text is long."""
    if text.isascii() or encoding == "utf-32":
        return len(text)
    codec, size = _CODECS[encoding]
    return len(text.encode(codec, "surrogatepass")) // size


def column_of(row: str, character: int, encoding: str) -> int:
    """Return the column that so many units make in a row; its end for more, a character's start within it."""
    if row.isascii() or encoding == "utf-32":
        return min(character, len(row))
    codec, size = _CODECS[encoding]
    left = character * size
    for column, char in enumerate(row):
        left -= len(char.encode(codec, "surrogatepass"))
        if left < 0:
            return column
    return len(row)


class Places:
    """Turns offsets of one text into the protocol's places, and back."""

    def __init__(self, source: Source, encoding: str) -> None:
        self._source, self._encoding = source, encoding

    def position(self, offset: int) -> types.Position:
        """Return an offset's place."""
        source = self._source
        row, column = source.position(offset)
        start = source.line_starts[row - 1]
        return types.Position(row - 1, units(source.text[start : start + column - 1], self._encoding))

    def range(self, span: Span) -> types.Range:
        """Return a span's place."""
        return types.Range(self.position(span[0]), self.position(span[1]))

    def offset(self, position: types.Position) -> int:
        """Return a place's offset; of one that does not exist, that of the row's or the text's end."""
        starts = self._source.line_starts
        if position.line >= len(starts):
            return len(self._source.text)
        row = self._source.line(position.line + 1)
        return starts[position.line] + column_of(row, position.character, self._encoding)
