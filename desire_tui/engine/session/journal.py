"""The notebook: a session's commands, programs, results and pictures, as Markdown [B 5.5.3; form X]."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.engine.runtime.record import RunRecord
    from desire_tui.engine.source import Source


class Journal:
    """Writes to one file at a time, always appending; every entry is on the disk when the call returns."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.is_on = False
        self._program_text: str | None = None

    def open(self, path: Path) -> None:
        """Start or go on with a notebook. DesireError 106 where it cannot be written."""
        self.path, self.is_on, self._program_text = path, True, None
        self._append(f"\n# {datetime.now().astimezone():%Y-%m-%d %H:%M}\n")

    def switch(self, *, on: bool) -> None:
        """`notebook on`, `notebook off`."""
        self.is_on = on and self.path is not None

    def command(self, text: str) -> None:
        """Keep a command line."""
        self._append(f"\n`> {text}`\n")

    def program(self, source: Source) -> None:
        """Keep the program's text, if it changed since it was kept last."""
        if self.is_on and source.text != self._program_text:
            self._program_text = source.text
            self._append(f"\n**{source.name}**\n\n```desire\n{source.text.rstrip()}\n```\n")

    def run_ended(self, record: RunRecord) -> None:
        """Keep a run's settings and why it ended."""
        if not self.is_on:
            return
        name = f" {record.segment}" if record.segment else ""
        why = f": {record.message}" if record.message else ""
        self._append(
            f"\nRun {record.number}{name}: rule {record.rule}, t = {record.t0:g} … {record.end_time:g}, "
            f"DT = {record.dt:g}, {record.steps} steps, {record.ended}{why}\n"
        )

    def note(self, text: str) -> None:
        """Keep a line of the user's own."""
        self._append(f"\n{text}\n")

    def picture(self, path: Path) -> None:
        """Show a picture file."""
        self._append(f"\n![{path.name}]({path})\n")

    def _append(self, text: str) -> None:
        if not self.is_on or self.path is None:
            return
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(text)
        except OSError as reason:
            self.is_on = False
            facts = {"path": self.path, "reason": reason.strerror or reason}
            raise DesireError(Diagnostic("file-unwritable", facts=facts)) from None
