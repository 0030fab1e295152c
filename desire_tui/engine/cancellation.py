"""Long work that can be broken off: it passes cancellation points, and its caller says whether to go on.

A parser, a lowering or a compiler does not know who waits for it: somebody who may press Esc, or the editor,
which checks a text for a limited time. Whoever calls it says so for the calls of its own thread.
"""

from __future__ import annotations

import threading
from contextlib import contextmanager
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Check = Callable[[], object]


class _OfThread(threading.local):
    check: Check | None = None


_of_thread = _OfThread()


@contextmanager
def cancellable(check: Check) -> Iterator[None]:
    """Let what is called in here be broken off: `check` raises at its next cancellation point.

    What an outer caller wants goes on to hold.
    """
    before = _of_thread.check

    def both() -> None:
        assert before is not None
        before()
        check()

    _of_thread.check = check if before is None else both
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


class OutOfTime(Exception):  # noqa: N818 - a limit, not an error
    """The time that a caller allowed is over. Takes along what was found until then."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[Any] = []
        self.reached: int | None = None
        """Where in the text the work was."""


@contextmanager
def time_limit(seconds: float | None) -> Iterator[None]:
    """Raise `OutOfTime` at a cancellation point after so many seconds of this thread's processor time."""
    if seconds is None:
        yield
        return
    until = thread_time() + seconds
    ask_at = perf_counter() + seconds

    def check() -> None:
        nonlocal ask_at
        if perf_counter() < ask_at:  # the thread's clock is never ahead, and takes ten times longer to read
            return
        left = until - thread_time()
        if left < 0:
            raise OutOfTime
        ask_at = perf_counter() + left

    with cancellable(check):
        yield


@contextmanager
def handing_over(found: list[Any], place: Callable[[], int] | None = None) -> Iterator[None]:
    """Hand what was found so far over to whoever set the time limit, and the place that was reached."""
    try:
        yield
    except OutOfTime as end:
        end.found.extend(found)
        if end.reached is None and place is not None:
            end.reached = place()
        raise
