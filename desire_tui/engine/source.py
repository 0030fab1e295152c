"""A program's text and places in it.

Offsets count characters from the start of the whole text. Rows and columns are for people: both start at 1.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from pathlib import Path

_LONE_RETURN = re.compile(r"\r(?!\n)")
_JOINT = r"(?:_[ \t\r]*\n)?"
"""What may stand between any two characters: `_` joins rows."""
_WORD = re.compile(rf"(?:{_JOINT}\S)+")


class Span(NamedTuple):
    """The characters `start` … `end - 1` of a source text."""

    start: int
    end: int


class Position(NamedTuple):
    """A place for people: row and column, both from 1."""

    row: int
    column: int


@dataclass(frozen=True)
class Source:
    """A text with the name it is shown under (a path, `<command>`, `<untitled>`).

    A carriage return alone ends a line, as on old Macintoshes; it becomes a line feed.
    """

    text: str
    name: str = "<text>"
    path: Path | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        """Give all lines ends that are looked for elsewhere; no offset changes."""
        if "\r" in self.text:
            object.__setattr__(self, "text", _LONE_RETURN.sub("\n", self.text))

    @property
    def file_name(self) -> str:
        """Its name without folders."""
        return self.name.replace("\\", "/").rpartition("/")[2]

    @cached_property
    def line_starts(self) -> list[int]:
        """Offset of each line's first character."""
        starts = [0]
        find = self.text.find
        at = find("\n")
        while at >= 0:
            starts.append(at + 1)
            at = find("\n", at + 1)
        return starts

    def position(self, offset: int) -> Position:
        """Row and column of an offset; offsets past the end give the end."""
        offset = min(max(offset, 0), len(self.text))
        row = bisect_right(self.line_starts, offset) - 1
        return Position(row + 1, offset - self.line_starts[row] + 1)

    def name_within(self, span: Span, name: str) -> Span:
        """Place of a name's first occurrence inside a statement; the statement's where it is not found."""
        letters = _JOINT.join(map(re.escape, name))
        found = re.compile(rf"(?<![\w$]){letters}(?![\w$])").search(self.text, span.start, span.end)
        return Span(*found.span()) if found else span

    def word(self, at: int) -> str:
        """Return the word that begins at an offset, up to the next blank."""
        found = _WORD.match(self.text, at)
        return re.sub(r"_[ \t\r]*\n", "", found[0]) if found else ""

    def line(self, row: int) -> str:
        """Text of a row (from 1) without its line end; empty for a row that does not exist."""
        if not 1 <= row <= len(self.line_starts):
            return ""
        start = self.line_starts[row - 1]
        end = self.line_starts[row] - 1 if row < len(self.line_starts) else len(self.text)
        return self.text[start:end].removesuffix("\r")
