"""What the driver makes of what a terminal sends."""

from __future__ import annotations

import asyncio
import os
import pty
import signal
import termios
import threading
from contextlib import contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING

from textual._xterm_parser import XTermParser
from textual.drivers.linux_driver import LinuxDriver

from desire_tui.desktop.terminal_driver import TerminalDriver, as_elsewhere

if TYPE_CHECKING:
    from collections.abc import Iterator

HANDLED = signal.SIGTSTP, signal.SIGCONT, signal.SIGWINCH, signal.SIGTTOU, signal.SIGTTIN


@contextmanager
def a_terminal(monkeypatch) -> Iterator[int]:
    """Lend a pseudo-terminal that takes the place of standard input and output; its modes can be read."""
    handlers = {number: signal.getsignal(number) for number in HANDLED}
    master, slave = pty.openpty()
    with os.fdopen(slave, "w", encoding="utf-8") as file:
        monkeypatch.setattr("sys.__stdin__", file)
        monkeypatch.setattr("sys.__stderr__", file)
        yield slave
    os.close(master)
    for number, handler in handlers.items():
        signal.signal(number, handler)


async def stopped_and_gone_on() -> tuple[int, bool]:
    """Let a driver start, go on behind a SIGSTOP, and end: how many threads read, whether it was drawn anew."""
    told = []

    async def post(message: object) -> None:
        told.append(message)

    driver = TerminalDriver(SimpleNamespace(_post_message=post), mouse=False)  # type: ignore[arg-type]
    driver.start_application_mode()
    os.kill(os.getpid(), signal.SIGCONT)
    for _ in range(20):
        await asyncio.sleep(0)  # the loop carries out what the signal asked for
    readers = sum(thread.name == "textual-input" for thread in threading.enumerate())
    for _ in range(20):
        await asyncio.sleep(0)
    driver.stop_application_mode()
    driver.close()
    return readers, any(isinstance(message, TerminalDriver.SignalResume) for message in told)


def test_a_program_that_goes_on_behind_a_sigstop_reads_in_one_thread_and_restores_the_modes(monkeypatch):
    """SIGSTOP, other than Ctrl+Z, tells a program nothing; two readers would take keys out of their order."""
    with a_terminal(monkeypatch) as terminal:
        before = termios.tcgetattr(terminal)
        assert asyncio.run(stopped_and_gone_on()) == (1, True)
        assert termios.tcgetattr(terminal) == before


def test_a_line_feed_is_enter(monkeypatch):
    keys = []
    monkeypatch.setattr(LinuxDriver, "process_message", lambda _self, message: keys.append(message.key))
    driver = TerminalDriver.__new__(TerminalDriver)
    for event in XTermParser().feed("a\nb\r"):
        driver.process_message(event)
    assert keys == ["a", "enter", "b", "enter"]


def test_the_linux_console_s_function_keys_with_shift_are_what_they_are_elsewhere():
    """Its keys by drivers/tty/vt/defkeymap.map; `[[E` is F5, which it sends without Shift."""
    sent = "".join(f"\x1b[{number}~" for number in (25, 26, 28, 29, 31, 32, 33, 34)) + "a\x1b[[E\x1b[21~"
    keys = [event.key for event in XTermParser().feed(as_elsewhere(sent))]
    assert keys == [*(f"shift+f{number}" for number in range(1, 9)), "a", "f5", "f10"]
