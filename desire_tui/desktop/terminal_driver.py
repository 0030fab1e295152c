"""Textual's driver for a terminal, with an end: what was lost is read no more, and written to no more.

Textual (pinned) reads for ever from a terminal that has gone, with a whole core, and ends its writing thread
at the first error, after which the desktop waits for it in the middle of a frame, or of its exit.
"""

from __future__ import annotations

import os
import signal
import threading
from codecs import getincrementaldecoder
from select import select
from typing import IO, TYPE_CHECKING, Any

from textual._xterm_parser import XTermParser
from textual.drivers.linux_driver import LinuxDriver
from textual.events import Key

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.message import Message

CONSOLE_KEYS = {f"f{12 + number}": f"shift+f{number}" for number in range(1, 9)}
"""The Linux console calls the function keys with Shift so; those from F9 on send nothing there."""
_TICK_S = 0.1
"""A lone Escape is told from the beginning of a sequence by the time that passes behind it."""


class TerminalDriver(LinuxDriver):
    """A terminal without anybody behind it sends SIGHUP, whether or not the operating system does."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._file: Any = _Output(self._file, self._lost)
        self._is_lost = False
        self._names = CONSOLE_KEYS if os.environ.get("TERM") == "linux" else {}
        self.exit_event: Any = _WakingEvent()

    def start_application_mode(self) -> None:
        """Take the terminal, perhaps again after an editor had it."""
        super().start_application_mode()  # type: ignore[no-untyped-call]
        if self._key_thread is None or not self._key_thread.is_alive():  # it could not be taken
            self._lost()

    def run_input_thread(self) -> None:
        """Read and send events until the driver, or the terminal, is at its end."""
        parser = XTermParser(self._debug)
        decode = getincrementaldecoder("utf-8")("replace").decode
        while True:
            is_last = self.exit_event.is_set()
            if self.fileno in select([self.fileno, self.exit_event], [], [], _TICK_S)[0]:
                data = _received(self.fileno)
                if not data:
                    self._lost()
                    return
                for event in parser.feed(decode(data)):
                    self.process_message(event)
            for event in parser.tick():
                self.process_message(event)
            if is_last:
                return

    def process_message(self, message: Message) -> None:
        """Pass a message on; a line feed is Enter: text that a script types ends its lines so."""
        if isinstance(message, Key) and message.key == "ctrl+j":
            message = Key("enter", "\r")
        elif isinstance(message, Key) and message.key in self._names:
            message = Key(self._names[message.key], None)
        super().process_message(message)

    def _lost(self) -> None:
        if not self._is_lost:
            self._is_lost = True
            os.kill(os.getpid(), signal.SIGHUP)


def _received(terminal: int) -> bytes:
    """Read what a terminal has sent; nothing means that it has gone."""
    try:
        return os.read(terminal, 4096)
    except OSError:
        return b""


class _WakingEvent(threading.Event):
    """An event that `select` can wait for: who reads from the terminal need not look for it now and then."""

    def __init__(self) -> None:
        super().__init__()
        self._reading, self._writing = os.pipe()

    def fileno(self) -> int:
        """Return what can be read as long as the event is set."""
        return self._reading

    def set(self) -> None:
        """Wake up whoever waits."""
        if not self.is_set():
            super().set()
            os.write(self._writing, b".")

    def clear(self) -> None:
        """Let whoever comes wait again."""
        if self.is_set():
            super().clear()
            os.read(self._reading, 1)

    def __del__(self) -> None:
        os.close(self._reading)
        os.close(self._writing)


class _Output:
    """A terminal as a file: what cannot be written is dropped, and told once."""

    def __init__(self, file: IO[str], lost: Callable[[], object]) -> None:
        self._file, self._lost = file, lost
        self._is_open = True

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)

    def write(self, text: str) -> None:
        """Write."""
        if self._is_open:
            self._try(self._file.write, text)

    def flush(self) -> None:
        """Send everything."""
        if self._is_open:
            self._try(self._file.flush)

    def _try(self, act: Callable[..., object], *arguments: object) -> None:
        try:
            act(*arguments)
        except (OSError, ValueError):
            self._is_open = False
            self._lost()
