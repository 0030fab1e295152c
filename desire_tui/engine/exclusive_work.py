"""Long calls of libraries that nothing can break off: one at a time, and who waits for one may leave.

LAPACK inverts a large matrix, LLVM compiles a module in one call. Both let other threads run meanwhile, so
such a call gets a thread of its own, and whoever wants its result looks twenty times a second whether to go
on waiting. What is left alone goes on unseen until it is done, and its result is dropped; the next waits for
that, so that there is never more than one. A process that ends meanwhile must not wait for it, nor run the
clearing up of Python and the libraries beside it (that hangs, or fails an assertion): it is left at once.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from threading import Lock, Thread
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

Result = TypeVar("Result")

LOOK_SECONDS = 0.05

_kinds: list[ExclusiveWork] = []


class ExclusiveWork:
    """Calls of which one at a time goes on in this process."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._turn = Lock()
        _kinds.append(self)

    @property
    def is_going_on(self) -> bool:
        """Whether a call goes on, waited for or not."""
        return self._turn.locked()

    def run(self, operation: Callable[[], Result], check: Callable[[], object]) -> Result:
        """Return what `operation` returns or raise what it, or `check` before it begins, raises."""
        self._begin(check)
        try:
            return operation()
        finally:
            self._turn.release()

    def run_aside(self, operation: Callable[[], Result], check: Callable[[], object]) -> Result:
        """As `run`, in a thread of its own: `check` is also called, and may raise, while it goes on.

        The operation must not read what others may change after that.
        """
        self._begin(check)
        results: list[Result] = []
        errors: list[BaseException] = []

        def carry_out() -> None:
            try:
                results.append(operation())
            except BaseException as error:  # noqa: BLE001 - raised again by the thread that waits
                errors.append(error)
            finally:
                self._turn.release()

        thread = Thread(target=carry_out, name=self._name, daemon=True)
        try:
            thread.start()
        except RuntimeError:  # the system gives no more threads
            self._turn.release()
            raise
        while thread.is_alive():
            thread.join(LOOK_SECONDS)
            check()
        if errors:
            raise errors[0]
        return results[0]

    def run_if_free(self, operation: Callable[[], object]) -> bool:
        """Do something short if nothing goes on; return whether it was done."""
        if not self._turn.acquire(blocking=False):
            return False
        try:
            operation()
        finally:
            self._turn.release()
        return True

    def wait(self, seconds: float) -> None:
        """Wait until what goes on is done, not longer than so many seconds."""
        if self._turn.acquire(timeout=seconds):
            self._turn.release()

    def _begin(self, check: Callable[[], object]) -> None:
        while not self._turn.acquire(timeout=LOOK_SECONDS):
            check()


def leave_at_once(status: int) -> None:
    """End the process here and now if a call goes on; else do nothing."""
    if any(kind.is_going_on for kind in _kinds):
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)
