"""What a tab knows about its file."""

from __future__ import annotations

import re
from itertools import count
from pathlib import Path
from stat import S_ISCHR, S_ISFIFO
from typing import TYPE_CHECKING

from desire_tui.editor.line_ends import ends_of, kind, with_line_feeds
from desire_tui.engine import text_encoding
from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.text_encoding import UTF_8, TextEncoding, decode

if TYPE_CHECKING:
    from collections.abc import Container

_numbers = count(1)

SIZE_MAX = 64 << 20
"""Files larger than this (bytes) are not opened.

Nobody edits them, and a wrong file must not fill the memory.
"""


OTHER_SUFFIXES = frozenset(
    {
        ".bib", ".c", ".cfg", ".conf", ".css", ".csv", ".dat", ".diff", ".h", ".html", ".ini", ".jl", ".js",
        ".json", ".log", ".m", ".md", ".ode", ".patch", ".py", ".rst", ".sh", ".svg", ".tex", ".toml", ".tsv",
        ".xml", ".yaml", ".yml",
    }
)  # fmt: skip
"""Endings of files that hold no Desire program."""


class NotText(ValueError):  # noqa: N818 - a statement about a file
    """The file is no text."""


@dataclass(eq=False)
class Buffer:
    """A tab's file: where it is, what was last saved there, and the time stamp it then had."""

    path: Path | None = None
    saved_text: str = ""
    stamp: float | None = None
    told_stamp: float | None = None
    """The time stamp of a change by somebody else that the user was told of."""
    label: str = ""
    """Its name while it has no file."""
    encoding: TextEncoding = UTF_8
    ended_text: str = ""
    """The saved text with the line ends of the file."""
    line_ends: str = "LF"
    """What a user is told of them."""
    number: int = field(default_factory=lambda: next(_numbers))

    @property
    def name(self) -> str:
        """What the tab shows."""
        return self.path.name if self.path else self.label

    @property
    def is_program(self) -> bool:
        """Whether it is to be coloured, checked and run as a program; other files are only edited."""
        return Path(self.name).suffix.casefold() not in OTHER_SUFFIXES

    @property
    def shape(self) -> str:
        """Encoding and line ends, where they are not the usual ones."""
        if self.encoding == UTF_8 and self.line_ends == "LF":
            return ""
        named = self.encoding.name if self.encoding != UTF_8 else ""
        return f"{named} {self.line_ends if self.line_ends != 'LF' else ''}".strip()

    @classmethod
    def from_file(cls, path: Path) -> Buffer:
        """Read a file. Raises OSError, or NotText if it holds binary data or is too large."""
        path = path.expanduser().resolve()
        status = path.stat()
        if S_ISFIFO(status.st_mode) or S_ISCHR(status.st_mode):  # to read it might never end
            raise NotText(f"{path.name} is not an ordinary file")
        if status.st_size > SIZE_MAX:
            raise NotText(f"{path.name} is larger than {SIZE_MAX >> 20} MB")
        try:
            text, encoding = decode(path.read_bytes())
        except text_encoding.NotText:
            raise NotText(f"{path.name} is not a text file") from None
        buffer = cls()
        buffer.hold(path, text, encoding)
        buffer.stamp = status.st_mtime
        return buffer

    def changed_on_disk(self) -> bool:
        """Whether the file was changed, or removed, by somebody else since it was read or saved."""
        return self.path is not None and self.stamp is not None and self.stamp_on_disk() != self.stamp

    def stamp_on_disk(self) -> float | None:
        """Return the file's time stamp; None if there is no file."""
        try:
            return self.path.stat().st_mtime if self.path is not None else None
        except OSError:
            return None

    def hold(self, path: Path, text: str, encoding: TextEncoding) -> None:
        """Note that `text`, with its line ends, now stands in `path`."""
        self.path, self.ended_text, self.saved_text = path, text, with_line_feeds(text)
        self.stamp = self.stamp_on_disk()
        self.encoding = encoding
        self.line_ends = kind(ends_of(text))


def free_label(wanted: str, taken: Container[str]) -> str:
    """Return a name that no other tab has: `wanted`, else `wanted-2` …; without a wish `untitled-1` …."""
    if wanted and wanted not in taken:
        return wanted
    stem = re.sub(r"-\d+$", "", wanted) or "untitled"
    first = 1 if stem == "untitled" else 2
    return next(name for number in count(first) if (name := f"{stem}-{number}") not in taken)
