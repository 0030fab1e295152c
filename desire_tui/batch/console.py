"""The console of a headless run."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

from desire_tui.engine.visible_text import for_stream

if TYPE_CHECKING:
    from desire_tui.batch.progress import Progress


class Console:
    """Writes console text to a stream, unless `quiet`; a progress line is cleared before.

    A terminal gets it visible, unless `raw`.
    """

    def __init__(self, stream: IO[str], *, quiet: bool, raw: bool = False) -> None:
        self._stream, self._quiet, self._raw = stream, quiet, raw
        self._at_line_start = True
        self.progress: Progress | None = None

    def write(self, text: str) -> None:
        """Write text."""
        if self._quiet or not text:
            return
        if self.progress is not None:
            self.progress.clear()
        self._stream.write(text if self._raw else for_stream(text, self._stream))
        self._stream.flush()
        self._at_line_start = text.endswith("\n")

    def end_line(self) -> None:
        """End an open line, so that a message starts on a line of its own."""
        if self.progress is not None:
            self.progress.clear()
        if not self._at_line_start:
            self.write("\n")
