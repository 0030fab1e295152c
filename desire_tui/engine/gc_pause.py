"""The garbage collector waits while a program's objects are made, and does not look through them afterwards.

Parsing, lowering and writing code make a hundred thousand small objects that stay and hold no cycles. The
collector looks through the young ones again after every 700 new objects and finds nothing: half of the time
from the text to the first derivative call, as measured with 1401 equations. Once more at the end is a
twentieth of it, with 40,001 equations a third: so they become old unseen. Reference counting frees what is
dropped all the same.
"""

from __future__ import annotations

import gc
import threading
from contextlib import ContextDecorator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import TracebackType

_WORTH_IT = 5_000
"""Young objects that are better not looked through; it takes some 40 ns for each."""
_UNSEEN_MOST = 1_000_000
"""Objects that may become old unseen before the collector looks through all old ones once.

Each time its counts begin anew, and cycles among the young ones become old too: else, of an editor that
checks its text at every key, they would be kept for ever.
"""


class _UndisturbedAllocation(ContextDecorator):
    """Counts who is making objects, in any thread; the last one out lets the collector go on."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._was_enabled = False
        self._unseen = 0
        self._full_collections = 0
        self._nobody_freezes = True

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
                young = gc.get_count()[0]
                if young > _WORTH_IT and self._nobody_freezes:
                    self._grow_old(young)
                gc.enable()

    def _grow_old(self, young: int) -> None:
        """Make all young objects old ones, unless very many have become so since all were looked through."""
        if gc.get_freeze_count():  # these are to stay so; to count them takes its time
            self._nobody_freezes = False
            return
        collections = gc.get_stats()[2]["collections"]
        if collections != self._full_collections:
            self._full_collections, self._unseen = collections, 0
        if self._unseen <= _UNSEEN_MOST:
            self._unseen += young
            gc.freeze()  # joins lists, whatever their lengths
            gc.unfreeze()


undisturbed_allocation = _UndisturbedAllocation()
"""`with` or decorator: for work that ends soon and makes many objects that stay. May be nested."""
