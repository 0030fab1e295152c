"""What a tab knows about its file."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Container
    from pathlib import Path

_numbers = count(1)

SIZE_MAX = 64 << 20
"""Files larger than this (bytes) are not opened.

Nobody edits them, and a wrong file must not fill the memory.
"""


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
    crlf: bool = False
    number: int = field(default_factory=lambda: next(_numbers))

    @property
    def name(self) -> str:
        """What the tab shows."""
        return self.path.name if self.path else self.label

    @classmethod
    def from_file(cls, path: Path) -> Buffer:
        """Read a file. Raises OSError, or NotText if it holds binary data or is too large."""
        path = path.expanduser().resolve()
        if path.stat().st_size > SIZE_MAX:
            raise NotText(f"{path.name} is larger than {SIZE_MAX >> 20} MB")
        data = path.read_bytes()
        if b"\0" in data:
            raise NotText(f"{path.name} is not a text file")
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        crlf = "\r\n" in text
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        return cls(path, text, path.stat().st_mtime, crlf=crlf)

    def changed_on_disk(self) -> bool:
        """Whether the file was changed, or removed, by somebody else since it was read or saved."""
        return self.path is not None and self.stamp is not None and self.stamp_on_disk() != self.stamp

    def stamp_on_disk(self) -> float | None:
        """Return the file's time stamp; None if there is no file."""
        try:
            return self.path.stat().st_mtime if self.path is not None else None
        except OSError:
            return None

    def saved(self, path: Path, text: str) -> None:
        """Note that `text` now stands in `path`."""
        self.path, self.saved_text = path, text
        self.stamp = self.stamp_on_disk()


def free_label(wanted: str, taken: Container[str]) -> str:
    """Return a name that no other tab has: `wanted`, else `wanted-2` …; without a wish `untitled-1` …."""
    if wanted and wanted not in taken:
        return wanted
    stem = re.sub(r"-\d+$", "", wanted) or "untitled"
    first = 1 if stem == "untitled" else 2
    return next(name for number in count(first) if (name := f"{stem}-{number}") not in taken)
