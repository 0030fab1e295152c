"""The garbage collector waits while a program's objects are made.

Parsing, lowering and writing code make a hundred thousand small objects that stay and hold no cycles. The
collector looks through the young ones again after every 700 new objects and finds nothing: half of the time
from the text to the first derivative call, as measured with 1401 equations. Reference counting frees what is
dropped meanwhile all the same.
"""

from __future__ import annotations

import gc
import threading
from contextlib import ContextDecorator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import TracebackType


class _UndisturbedAllocation(ContextDecorator):
    """Counts who is making objects, in any thread; the last one out lets the collector go on."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._was_enabled = False

    def __enter__(self) -> None:
        with self._lock:
            if not self._users:
                self._was_enabled = gc.isenabled()
                gc.disable()
            self._users += 1

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._lock:
            self._users -= 1
            if not self._users and self._was_enabled:
                gc.enable()


undisturbed_allocation = _UndisturbedAllocation()
"""`with` or decorator: for work that ends soon and makes many objects that stay. May be nested."""
