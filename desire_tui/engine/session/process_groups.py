"""The processes that `sh` started and that go on: none of them outlives this process."""

from __future__ import annotations

import atexit
import os
import signal
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

_running: set[int] = set()


@contextmanager
def ended_at_exit(group: int) -> Iterator[None]:
    """Have a process group ended if this process exits before the block does."""
    _running.add(group)
    try:
        yield
    finally:
        _running.discard(group)


def end_all() -> None:
    """End all groups at once: this process is about to exit. From any thread, or a signal's handler."""
    for group in tuple(_running):
        send(group, signal.SIGKILL)


def send(group: int, number: int) -> None:
    """Send a signal to a group; one that is over does not get it."""
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(group, number)


atexit.register(end_all)
