"""The texts that a client has open, as they stand in its editor, saved or not."""

from __future__ import annotations

import re
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.uris import to_fs_path

from desire_tui.engine.source import Source
from desire_tui.language.names import ProgramNames
from desire_tui.lsp.positions import Places, column_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_ROW = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+\Z")
"""A row with its end; no other characters end one, as `str.splitlines` believes (LSP 3.17)."""
_numbers = count(1)


class Snapshot:
    """A text at one moment; it stays as it is while the client goes on typing."""

    def __init__(self, source: Source, encoding: str, values: Mapping[str, float]) -> None:
        self.source = source
        self.places = Places(source, encoding)
        self.encoding = encoding
        self.values = values
        """Quantities after the last run, by their names."""

    @cached_property
    def names(self) -> ProgramNames:
        """Every name of it."""
        return ProgramNames(self.source)

    @cached_property
    def lines(self) -> list[str]:
        """Its rows without their ends."""
        return [row.removesuffix("\r") for row in self.source.text.split("\n")]


class Document:
    """A text that is being edited. `number` tells it from others, `revision` counts its edits."""

    def __init__(self, uri: str, text: str, encoding: str, version: int | None = None) -> None:
        self.uri = uri
        self.version = version
        """The client's own count."""
        self.number = next(_numbers)
        self.revision = 0
        found = to_fs_path(uri) if uri.startswith("file:") else None
        self.path = Path(found) if found else None
        self.values: Mapping[str, float] = {}
        self._encoding = encoding
        self._rows = _ROW.findall(text)
        self._snapshot: Snapshot | None = None

    @property
    def name(self) -> str:
        """What messages call it."""
        return str(self.path) if self.path is not None else self.uri

    @property
    def snapshot(self) -> Snapshot:
        """The text as it is now."""
        if self._snapshot is None:
            source = Source("".join(self._rows), self.name, self.path)
            self._snapshot = Snapshot(source, self._encoding, self.values)
        return self._snapshot

    def know(self, values: Mapping[str, float]) -> None:
        """Keep what quantities were after a run."""
        self.values = self.snapshot.values = values

    def change(
        self, edits: Sequence[types.TextDocumentContentChangeEvent], version: int | None = None
    ) -> None:
        """Carry out edits one after the other, each in the text that the one before has left."""
        for edit in edits:
            if isinstance(edit, types.TextDocumentContentChangePartial):
                self._replace(edit.range, edit.text)
            else:
                self._rows = _ROW.findall(edit.text)
        self.revision += 1
        self.version = version
        self._snapshot = None

    def _replace(self, where: types.Range, text: str) -> None:
        """Replace a part; only its rows are touched, so that thousands of edits at once cost no time."""
        rows = self._rows
        top, before = self._before(where.start)
        bottom, _ = self._before(where.end)
        if (bottom, where.end.character) < (top, where.start.character):
            bottom, end = top, before
        else:
            end = self._before(where.end)[1]
        tail = rows[bottom][end:] if bottom < len(rows) else ""
        piece = (rows[top][:before] if top < len(rows) else "") + text + tail
        if top and rows[top - 1].endswith("\r") and piece.startswith("\n"):
            top -= 1
            piece = rows[top] + piece
        rows[top : bottom + 1] = _ROW.findall(piece)

    def _before(self, place: types.Position) -> tuple[int, int]:
        """Return a place's row and column; the end of what is there for one that is beyond."""
        if place.line >= len(self._rows):
            if self._rows and not self._rows[-1].endswith(("\n", "\r")):
                return len(self._rows) - 1, len(self._rows[-1])
            return len(self._rows), 0  # the empty row behind the last end
        row = self._rows[place.line]
        return place.line, column_of(row.rstrip("\r\n"), place.character, self._encoding)
