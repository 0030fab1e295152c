"""Textual's driver for a desktop in a browser, with an end: without a connection nothing goes on."""

from __future__ import annotations

import os
import signal

from textual.drivers.web_driver import WebDriver


class ServedWebDriver(WebDriver):
    """A closed input is a lost connection, as a terminal's SIGHUP: the app keeps its work safe and ends."""

    def run_input_thread(self) -> None:
        """Read until the server closes the pipe, or ends in any way."""
        super().run_input_thread()
        if not self.exit_event.is_set():
            os.kill(os.getpid(), signal.SIGHUP)
