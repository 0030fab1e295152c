"""What pictures the terminal can show: asked once, of the terminal itself, while the app runs.

Textual's input thread would swallow the answers, so it is stopped for the moment of the question. The last
question is one that every terminal answers (primary device attributes): when its answer is there, the others
have come or never will.
"""

from __future__ import annotations

import os
import re
import sys
from select import select
from threading import Thread
from time import monotonic
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from textual.driver import Driver

Kind = Literal["sixel", "kitty", "none"]
WAIT_S = 1.5
"""Over a slow connection the answer takes its time."""
_KITTY = "\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\"
"""Asks about a picture of one dot without showing it (kitty's graphics protocol)."""
_CELL_SIZE, _ATTRIBUTES = "\x1b[16t", "\x1b[c"
_SAYS_KITTY = re.compile(rb"\x1b_Gi=31;OK")
_SAYS_SIZE = re.compile(rb"\x1b\[6;(\d+);(\d+)t")
_SAYS_ATTRIBUTES = re.compile(rb"\x1b\[\?([\d;]*)c")


@dataclass(frozen=True, slots=True)
class Graphics:
    """How pictures are sent, and the size of a character in dots."""

    kind: Kind = "none"
    cell: tuple[int, int] = (10, 20)


def graphics(driver: Driver | None) -> Graphics:
    """Ask the terminal behind a Textual driver. Some tenths of a second; never twice at once."""
    if driver is None or driver.is_headless or driver.is_web or not getattr(driver, "input_tty", False):
        return Graphics()
    from textual.drivers.linux_driver import LinuxDriver

    return _meaning(_asked(driver)) if isinstance(driver, LinuxDriver) else Graphics()


def _asked(driver: object) -> bytes:
    """Return everything that arrives up to the answer to the last question."""
    from textual.drivers.linux_driver import LinuxDriver

    assert isinstance(driver, LinuxDriver)
    thread = driver._key_thread  # noqa: SLF001 - Textual is pinned; it has no public way
    if thread is None:
        return b""
    driver._disable_mouse_support()  # noqa: SLF001 - as above: a mouse on the move would talk into the answer
    driver.exit_event.set()
    thread.join()
    driver.exit_event.clear()
    try:
        driver.write(_KITTY + _CELL_SIZE + _ATTRIBUTES)
        driver.flush()
        return _read(driver.fileno)
    finally:
        driver._key_thread = Thread(target=driver._run_input_thread, name="textual-input")  # noqa: SLF001 - as above
        driver._key_thread.start()  # noqa: SLF001 - as above
        driver._enable_mouse_support()  # noqa: SLF001 - as above


def _read(terminal: int) -> bytes:
    answer, until = b"", monotonic() + WAIT_S
    while (left := until - monotonic()) > 0 and not _SAYS_ATTRIBUTES.search(answer):
        if select([terminal], [], [], left)[0]:
            try:
                data = os.read(terminal, 4096)
            except OSError:
                data = b""
            if not data:  # it has gone
                break
            answer += data
    return answer


def _meaning(answer: bytes) -> Graphics:
    attributes = _SAYS_ATTRIBUTES.search(answer)
    kind: Kind = "none"
    # Some terminals know sixel well and kitty's protocol badly; kitty itself does not know sixel
    if attributes is not None and b"4" in attributes[1].split(b";"):
        kind = "sixel"
    elif _SAYS_KITTY.search(answer):
        kind = "kitty"
    size = _SAYS_SIZE.search(answer)
    cell = _pixels_of_window() or ((int(size[2]), int(size[1])) if size is not None else (0, 0))
    return Graphics(kind, cell if min(cell) > 0 else (10, 20))


def _pixels_of_window() -> tuple[int, int] | None:
    """Return a character's size as the operating system knows it, if it does."""
    from array import array
    from fcntl import ioctl
    from termios import TIOCGWINSZ

    size = array("H", [0, 0, 0, 0])
    try:
        ioctl(sys.__stdout__.fileno() if sys.__stdout__ else 1, TIOCGWINSZ, size)
    except OSError:
        return None
    rows, columns, width, height = size
    return (width // columns, height // rows) if rows and columns and width and height else None
