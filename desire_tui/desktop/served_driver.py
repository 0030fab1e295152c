"""Textual's driver for a desktop in a browser, with an end: without a connection nothing goes on."""

from __future__ import annotations

import os
import signal
from typing import Any

from textual.drivers.web_driver import WebDriver


class ServedWebDriver(WebDriver):
    """A closed pipe is a lost connection, as a terminal's SIGHUP: the app keeps its work safe and ends."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._write: Any = self._send

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
