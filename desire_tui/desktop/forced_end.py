"""Once it is asked to end from outside, the process ends, whatever its threads wait for or compute.

A desktop whose terminal has gone ends by itself in most cases; this is for those nobody thought of.
"""

from __future__ import annotations

import faulthandler
import os
import threading
from typing import TYPE_CHECKING

from desire_tui.engine.session.process_groups import end_all

if TYPE_CHECKING:
    from collections.abc import Callable

ORDERLY_S = 1.5
"""So long it may take to leave once the work is kept."""
KEEPING_S = 20.0
"""So long it may take to keep the work: texts of many MB, a slow disk, a machine with much to do."""

_begun = threading.Event()


def end_soon(keep_work: Callable[[], object]) -> None:
    """Keep the work in a thread of its own, then leave no more than a moment for an orderly end."""
    if not _begun.is_set():
        _begun.set()
        _exit_in(KEEPING_S)
        threading.Thread(target=_end, args=(keep_work,), daemon=True, name="desire-end").start()


def is_begun() -> bool:
    """Whether the process was asked to end from outside."""
    return _begun.is_set()


def _end(keep_work: Callable[[], object]) -> None:
    try:
        keep_work()
    except Exception:  # noqa: BLE001 - the main thread may be at the same text: it keeps it, and gets the time for it
        end_all()
        return
    end_all()
    _exit_in(ORDERLY_S)


def _exit_in(seconds: float) -> None:
    """Have a thread of C end the process: it needs no turn among Python's, which one may hold for ever."""
    faulthandler.dump_traceback_later(seconds, exit=True, file=_nowhere())


def _nowhere() -> int:
    """Return where what the threads did is written: nobody is there to read it."""
    return os.open(os.devnull, os.O_WRONLY)
