"""Waiting for one long NumPy operation in such a way that Ctrl-C gets through.

LAPACK inverts a large matrix in one call that nothing can break off. It lets other threads run meanwhile, so
it gets a thread of its own, and the interpreter waits for that, calling `check` twenty times a
second. What is broken off goes on unseen until LAPACK is done, and its result is dropped; the next long
operation waits for that, so that there is never more than one. A process that ends meanwhile must not wait
for LAPACK, nor run the clearing up of Python and BLAS beside it (that may hang): it is left at once. (An
elimination in blocks with looks between them really ends, but takes two to five times as long.)
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from threading import Lock, Thread
from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

Result = TypeVar("Result")

LONG_WORK = 50_000_000
"""Multiplications from which on an operation is worth a thread: some hundredths of a second."""
LOOK_SECONDS = 0.05

_one = Lock()


def leave_at_once(status: int) -> None:
    """End the process here and now if a broken-off operation still goes on; else do nothing."""
    if _one.locked():
        for stream in (sys.stdout, sys.stderr):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)


def run_interruptibly(work: int, operation: Callable[[], Result], check: Callable[[], None]) -> Result:
    """Return what `operation` returns, or raise what it raises, or what `check` raises meanwhile.

    `work` is about how many multiplications it takes. It must not read what others may change.
    """
    if work < LONG_WORK:
        return operation()
    while not _one.acquire(timeout=LOOK_SECONDS):
        check()
    results: list[Result] = []
    errors: list[BaseException] = []

    def carry_out() -> None:
        try:
            with np.errstate(all="ignore"):  # each thread has its own; the result is looked at
                results.append(operation())
        except BaseException as error:  # noqa: BLE001 - raised again by the thread that waits
            errors.append(error)
        finally:
            _one.release()

    thread = Thread(target=carry_out, name="linear-algebra", daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(LOOK_SECONDS)
        check()
    if errors:
        raise errors[0]
    return results[0]
