"""Who may call LLVM: one thread at a time, and who waits for it may be told to leave.

llvmlite holds a lock of its own in every call; a thread that waits for that one can be reached by nobody.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, TypeVar

from desire_tui.engine.cancellation import cancellation_point, is_cancellable
from desire_tui.engine.exclusive_work import ExclusiveWork

if TYPE_CHECKING:
    from collections.abc import Callable

Result = TypeVar("Result")

LONG_TEXT = 20_000
"""Characters of IR that take LLVM some ten milliseconds, and are worth a thread."""

_llvm = ExclusiveWork("desire compiles")
_to_clear: deque[Callable[[], object]] = deque()


def in_turn(operation: Callable[[], Result], length: int) -> Result:
    """Do something with LLVM to a text of this length, or leave at a cancellation point."""
    aside = length > LONG_TEXT and is_cancellable()
    run = _llvm.run_aside if aside else _llvm.run
    try:
        return run(operation, cancellation_point)
    finally:
        clear_later()


def clear_later(clear: Callable[[], object] | None = None) -> None:
    """Clear something up with LLVM, now if nobody is at it."""
    if clear is not None:
        _to_clear.append(clear)
    _llvm.run_if_free(_clear)


def wait(seconds: float) -> None:
    """Wait until LLVM is done with what it is at."""
    _llvm.wait(seconds)


def _clear() -> None:
    while _to_clear:
        _to_clear.popleft()()
