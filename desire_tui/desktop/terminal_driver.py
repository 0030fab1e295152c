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

_CONSOLE_KEYS = {
    "\x1b[25~": "\x1b[1;2P", "\x1b[26~": "\x1b[1;2Q", "\x1b[28~": "\x1b[13;2~", "\x1b[29~": "\x1b[1;2S",
    "\x1b[31~": "\x1b[15;2~", "\x1b[32~": "\x1b[17;2~", "\x1b[33~": "\x1b[18;2~", "\x1b[34~": "\x1b[19;2~",
}  # fmt: skip
"""What the Linux console sends for Shift with F1 to F8, and what other terminals do. For Shift with F9 and on
it sends nothing; Textual (pinned) takes the eight for characters of those numbers."""
_TICK_S = 0.1
"""A lone Escape is told from the beginning of a sequence by the time that passes behind it."""


class TerminalDriver(LinuxDriver):
    """A terminal without anybody behind it sends SIGHUP, whether or not the operating system does."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._file: Any = _Output(self._file, self._lost)
        self._is_lost = False
        self.exit_event: Any = _WakingEvent()

    def start_application_mode(self) -> None:
        """Take the terminal, perhaps again after an editor had it."""
        super().start_application_mode()  # type: ignore[no-untyped-call]
        if self._key_thread is None or not self._key_thread.is_alive():  # it could not be taken
            self._lost()

    def _sigcont_application(self, *signal_and_frame: Any) -> None:
        """Go on. What was stopped by SIGSTOP did not leave the terminal before: it does so first.

        Textual (pinned) would read in two threads, which disorder keys, and take the modes that
        it has set for those to leave behind.
        """
        if self._auto_restart and self._key_thread is not None and self._key_thread.is_alive():
            self._loop.call_soon_threadsafe(self._take_again)  # what a signal interrupts may hold locks
        else:
            super()._sigcont_application(*signal_and_frame)

    def _take_again(self) -> None:
        """Set the terminal's modes again, and draw all of the screen: a shell may have had it meanwhile."""
        before = self.attrs_before
        self.exit_event.set()
        if self._key_thread is not None:
            self._key_thread.join()
        self.exit_event.clear()
        self.close()
        self._must_signal_resume = True
        self.start_application_mode()
        self.attrs_before = before

    def run_input_thread(self) -> None:
        """Read and send events until the driver, or the terminal, is at its end."""
        parser = XTermParser(self._debug)
        decode = getincrementaldecoder("utf-8")("replace").decode
        is_console = os.environ.get("TERM") == "linux"
        while True:
            is_last = self.exit_event.is_set()
            if self.fileno in select([self.fileno, self.exit_event], [], [], _TICK_S)[0]:
                data = _received(self.fileno)
                if not data:
                    self._lost()
                    return
                text = decode(data)
                for event in parser.feed(as_elsewhere(text) if is_console else text):
                    self.process_message(event)
            for event in parser.tick():
                self.process_message(event)
            if is_last:
                return

    def process_message(self, message: Message) -> None:
        """Pass a message on; a line feed is Enter: text that a script types ends its lines so."""
        if isinstance(message, Key) and message.key == "ctrl+j":
            message = Key("enter", "\r")
        super().process_message(message)

    def _lost(self) -> None:
        if not self._is_lost:
            self._is_lost = True
            os.kill(os.getpid(), signal.SIGHUP)


def as_elsewhere(text: str) -> str:
    """Return what the Linux console sends as what other terminals send for the same keys."""
    for sent, known in _CONSOLE_KEYS.items():
        text = text.replace(sent, known)
    return text


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
