"""Waiting for one long NumPy operation in such a way that Ctrl-C gets through.

An elimination in blocks with looks between them would really end, but takes two to five times as long as
LAPACK's, which is left alone instead (`engine.exclusive_work`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from desire_tui.engine.exclusive_work import ExclusiveWork

if TYPE_CHECKING:
    from collections.abc import Callable

Result = TypeVar("Result")

LONG_WORK = 50_000_000
"""Multiplications from which on an operation is worth a thread: some hundredths of a second."""

_lapack = ExclusiveWork("linear-algebra")


def run_interruptibly(work: int, operation: Callable[[], Result], check: Callable[[], None]) -> Result:
    """Return what `operation` returns, or raise what it raises, or what `check` raises meanwhile.

    `work` is about how many multiplications it takes. It must not read what others may change.
    """
    if work < LONG_WORK:
        return operation()

    def quietly() -> Result:
        with np.errstate(all="ignore"):  # each thread has its own; the result is looked at
            return operation()

    return _lapack.run_aside(quietly, check)
