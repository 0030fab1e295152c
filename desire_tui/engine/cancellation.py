"""Long work that can be broken off: it passes cancellation points, and its caller says whether to go on.

A parser, a lowering or a compiler does not know who waits for it: somebody who may press Esc, or the editor,
which checks a text for a limited time. Whoever calls it says so for the calls of its own thread.
"""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Check = Callable[[], object]


class _OfThread(threading.local):
    check: Check | None = None


_of_thread = _OfThread()


@contextmanager
def cancellable(check: Check) -> Iterator[None]:
    """Let what is called in here be broken off: `check` raises at its next cancellation point."""
    before, _of_thread.check = _of_thread.check, check
    try:
        yield
    finally:
        _of_thread.check = before


@contextmanager
def uncancellable() -> Iterator[None]:
    """Let what is called in here come to its end."""
    before, _of_thread.check = _of_thread.check, None
    try:
        yield
    finally:
        _of_thread.check = before


def is_cancellable() -> bool:
    """Whether somebody may break this work off."""
    return _of_thread.check is not None


def cancellation_point() -> None:
    """Raise what the caller wants raised, if this work is to be broken off."""
    if _of_thread.check is not None:
        _of_thread.check()
