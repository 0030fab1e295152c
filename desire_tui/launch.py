"""Opening the desktop, quickly: what is imported, and what Python does meanwhile."""

from __future__ import annotations

import io
import os
import sys
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from desire_tui.desktop.start_up_gc import pause_gc
from desire_tui.desktop.watchdog import watched

if TYPE_CHECKING:
    from collections.abc import Iterator


GIVE_WAY_S = 0.001
"""Whoever wants to compute in Python waits so long for another thread: a key passes through several waits
until it is answered. Python's own 5 ms made that 0.1 s beside a long program that is being compiled."""


def is_possible() -> bool:
    """Whether there is a terminal to open it in, or a browser: `desire serve` speaks to it through pipes."""
    return is_served() or (sys.stdin.isatty() and sys.stdout.isatty())


def is_served() -> bool:
    """Whether this process was started by `desire serve` for a browser."""
    return os.environ.get("TEXTUAL_DRIVER", "").endswith("WebDriver")


def open_desktop(files: tuple[str, ...], *, allow_shell: bool = False, allow_write: bool = False) -> NoReturn:
    """Open the desktop with files in tabs; ends the process.

    In a browser nobody is asked for permissions: what is not allowed here is refused.
    """
    _speak_utf8()
    pause_gc()
    sys.setswitchinterval(GIVE_WAY_S)
    with nullcontext() if is_served() else watched():
        with _without("ssl"):
            import asyncio  # noqa: F401 - here it must do without
        from desire_tui.app import DesireApp

        app = DesireApp([Path(file) for file in files])
        if is_served():
            app.limit_to_visitors(Path.cwd(), allow_shell=allow_shell, allow_write=allow_write)
        app.run()
        app.engine.settle()
    _leave(app.return_code or 0)


def _leave(status: int) -> NoReturn:
    """End the process; what is to be kept is kept.

    Python's own way takes apart, object by object, what a long program was compiled from (0.3 s for 10,000
    equations), waits for LLVM, and writes to a terminal that may have gone.
    """
    from desire_tui.engine.session.process_groups import end_all

    end_all()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def _speak_utf8() -> None:
    """Write UTF-8 whatever the locale says: Textual reads nothing else, few terminals are what it says."""
    for stream in (sys.__stdout__, sys.__stderr__):
        if isinstance(stream, io.TextIOWrapper) and stream.encoding.lower() != "utf-8":
            stream.reconfigure(encoding="utf-8")


@contextmanager
def _without(module: str) -> Iterator[None]:
    """Import something that can do without a module, without it; later it can be imported as always.

    asyncio loads OpenSSL for connections that nobody opens here: 20 ms of the 0.6 s to the first key.
    """
    if module in sys.modules:
        yield
        return
    sys.modules[module] = None  # type: ignore[assignment]  # Python's own way to say "there is none"
    try:
        yield
    finally:
        del sys.modules[module]
