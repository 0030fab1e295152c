"""What several programs say, passed on to our own output: each under its name, visible on a terminal."""

from __future__ import annotations

import codecs
import sys
from typing import IO

from desire_tui.engine.visible_text import visible, visible_line


class Voice:
    """Passes on what programs say; `headings` puts a program's name above what it writes, as `head` does.

    A terminal gets control characters visible unless `raw`, files and pipes every byte.
    """

    def __init__(self, *, headings: bool, raw: bool) -> None:
        self._headings, self._raw = headings, raw
        self._speaker: str | None = None
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._at_line_start = True

    def say(self, program: str, data: bytes, *, is_error: bool) -> None:
        """Pass on a piece. OSError: nobody reads our output any more."""
        if is_error:
            sys.stdout.flush()
            self._write(sys.stderr, data)
            return
        if self._headings and self._speaker != program:
            line_end = "" if self._at_line_start else "\n"
            sys.stdout.write(f"{line_end}==> {visible_line(program)} <==\n")
            self._decoder.reset()
        self._speaker = program
        self._at_line_start = data.endswith(b"\n")
        self._write(sys.stdout, data)

    def _write(self, stream: IO[str], data: bytes) -> None:
        if stream is sys.stdout and stream.isatty() and not self._raw:
            stream.write(visible(self._decoder.decode(data)))
        else:
            stream.flush()
            stream.buffer.write(data)  # type: ignore[attr-defined]  # of text streams on files
        stream.flush()
