"""Restores the terminal after an end that this process cannot see: SIGKILL, or a crash in native code.

A copy of the process, made before anything large is imported, sleeps until the pipe between the two closes.
"""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager, suppress
from select import select
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_MODES = (1000, 1003, 1015, 1006, 1004, 2004, 2048, 2026)
"""Mouse, focus, paste, size, whole frames: what Textual's driver switches on."""
RESET = b"".join(
    (
        *(b"\x1b[?%dl" % mode for mode in _MODES),
        b"\x1b[<u",  # the keyboard
        b"\x1b[?1049l",  # the screen of the shell
        b"\x1b[?7h\x1b[?25h\x1b[0m",  # line wrap, cursor, colours
    )
)
_WELL = b"."
QUIET_S = 2.0
"""The watchdog gets ready when the desktop has started."""
PATIENCE_S = 10


@contextmanager
def watched() -> Iterator[None]:
    """Have a watchdog while the desktop is open; none where the system refuses another process."""
    import termios

    try:
        modes = termios.tcgetattr(sys.stdin.fileno())
        reading, writing = os.pipe()
        owner, dog = os.getpid(), os.fork()
    except (OSError, termios.error):  # which is no OSError
        yield
        return
    if dog == 0:
        os.close(writing)
        _wait(reading, owner, modes)
    os.close(reading)
    try:
        yield
    finally:
        with suppress(BrokenPipeError, ChildProcessError):  # somebody has ended the watchdog
            os.write(writing, _WELL)
            os.waitpid(dog, 0)


def _wait(reading: int, owner: int, modes: list[Any]) -> NoReturn:
    """Sleep until the desktop ends; restore the terminal if it did not end well. Never returns."""
    try:
        os.setsid()  # what the keyboard and the terminal's end send is not for this process
        select([reading], [], [], QUIET_S)
        from desire_tui.editor.recovery import recovery_file

        kept = recovery_file(owner)
        if os.read(reading, 1) != _WELL:
            _restore(kept, modes)
    finally:
        os._exit(0)


def _restore(kept: Path, modes: list[Any]) -> None:
    """Write all at once: the shell is about to write its prompt."""
    import signal
    import termios

    signal.alarm(PATIENCE_S)  # a terminal that takes nothing is not waited for until it goes
    where = f" Unsaved work is kept in {kept}; the next start offers it." if kept.exists() else ""
    with suppress(termios.error):
        termios.tcsetattr(sys.stdout.fileno(), termios.TCSANOW, modes)
    os.write(sys.stdout.fileno(), RESET + f"Desire was killed, or crashed.{where}\r\n".encode())
