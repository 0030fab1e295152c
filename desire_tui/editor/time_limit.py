"""A limit for work that Python cannot otherwise be asked to break off, such as matching an expression."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


RINGS_EVERY_S = 0.05


class TookTooLong(Exception):  # noqa: N818 - a statement about the work
    """The time was over before the work was done."""


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Break off what is inside after a time, raising TookTooLong.

    By the alarm of the operating system: `re` looks for signals while it matches, and for nothing else. Only
    the main thread gets them; elsewhere there is no limit. The alarm goes on ringing until the work ends:
    Python drops what is raised while an object is cleared away.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    is_over = False

    def ring(*_: object) -> None:
        if not is_over:
            raise TookTooLong

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds, RINGS_EVERY_S)
    try:
        try:
            yield
        finally:  # where it may ring, too
            is_over = True
    finally:
        is_over = True
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
