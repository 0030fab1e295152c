"""Textual's driver for a desktop in a browser, with an end: without a connection nothing goes on."""

from __future__ import annotations

import base64
import os
import signal
from typing import TYPE_CHECKING, Any

from textual.drivers.web_driver import WebDriver

if TYPE_CHECKING:
    from pathlib import Path

FILE_MOST = 20_000_000
"""Larger files (bytes) stay where the desktop runs."""


class ServedWebDriver(WebDriver):
    """A closed pipe is a lost connection, as a terminal's SIGHUP: the app keeps its work safe and ends."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._write: Any = self._send

    _told_unsaved = False

    def tell_unsaved(self, unsaved: bool) -> None:
        """Let the page ask before it goes, or not."""
        if unsaved != self._told_unsaved:
            self._told_unsaved = unsaved
            self.write_meta({"type": "unsaved", "unsaved": unsaved})

    def hand_over(self, path: Path) -> bool:
        """Give the visitor a copy of a file that was written for him; False if it is too large."""
        if path.stat().st_size > FILE_MOST:
            return False
        content = base64.b64encode(path.read_bytes()).decode()
        self.write_meta({"type": "file", "name": path.name, "base64": content})
        return True

    def run_input_thread(self) -> None:
        """Read until the server closes the pipe, or ends in any way."""
        super().run_input_thread()
        if not self.exit_event.is_set():
            os.kill(os.getpid(), signal.SIGHUP)

    def _send(self, data: bytes) -> None:
        """Write a packet; without anybody who takes it, drop it."""
        try:
            os.write(self.fileno, data)
        except OSError:
            if not self.exit_event.is_set():
                self.exit_event.set()
                os.kill(os.getpid(), signal.SIGHUP)
