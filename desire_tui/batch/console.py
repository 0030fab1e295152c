"""The console of a headless run."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.batch.progress import Progress


class Console:
    """Writes console text to a stream, unless `quiet`; a progress line is cleared before."""

    def __init__(self, stream: IO[str], *, quiet: bool) -> None:
        self._stream, self._quiet = stream, quiet
        self._at_line_start = True
        self.progress: Progress | None = None

    def write(self, text: str) -> None:
        """Write text."""
        if self._quiet or not text:
            return
        if self.progress is not None:
            self.progress.clear()
        self._stream.write(text)
        self._stream.flush()
        self._at_line_start = text.endswith("\n")

    def end_line(self) -> None:
        """End an open line, so that a message starts on a line of its own."""
        if self.progress is not None:
            self.progress.clear()
        if not self._at_line_start:
            self.write("\n")
