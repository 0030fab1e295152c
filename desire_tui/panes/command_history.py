"""Command lines of earlier sessions, kept on disk."""

from __future__ import annotations

import contextlib
import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

KEPT_MAX = 2_000


class CommandHistory:
    """Lines, oldest first. `previous` and `next` walk through those that begin with what was typed."""

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self.lines: list[str] = []
        self._at: int | None = None
        self._typed = ""
        if path is not None:
            with contextlib.suppress(OSError, ValueError):
                stored = json.loads(path.read_text(encoding="utf-8"))
                self.lines = [line for line in stored if isinstance(line, str)][-KEPT_MAX:]

    def add(self, line: str) -> None:
        """Append a line and save; a repeated line moves to the end.

        A folder that cannot be written is no error.
        """
        self._at = None
        if not line.strip():
            return
        with contextlib.suppress(ValueError):
            self.lines.remove(line)
        self.lines.append(line)
        del self.lines[:-KEPT_MAX]
        if self._path is not None:
            from desire_tui.engine.user_folders import write_private

            with contextlib.suppress(OSError):
                text = json.dumps(self.lines, ensure_ascii=False, indent=0)
                write_private(str(self._path), text.encode(errors="replace"))

    def previous(self, typed: str) -> str | None:
        """Return the line before, None if there is none."""
        if self._at is None:
            self._at, self._typed = len(self.lines), typed
        return self._walk(-1)

    def next(self) -> str | None:
        """Return the line after; behind the last one, what was typed."""
        return None if self._at is None else self._walk(1)

    def forget_place(self) -> None:
        """Start the next walk at the end."""
        self._at = None

    def _walk(self, step: int) -> str | None:
        assert self._at is not None
        at = self._at + step
        while 0 <= at < len(self.lines):
            if self.lines[at].startswith(self._typed):
                self._at = at
                return self.lines[at]
            at += step
        if step > 0:
            self._at = None
            return self._typed
        return None

    def search(self, part: str, *, older_than: int | None = None) -> tuple[int, str] | None:
        """Return number and text of the newest line that holds `part`."""
        last = len(self.lines) if older_than is None else older_than
        for at in range(last - 1, -1, -1):
            if part.casefold() in self.lines[at].casefold():
                return at, self.lines[at]
        return None
