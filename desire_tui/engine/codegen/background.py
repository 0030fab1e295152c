"""One thread that compiles fast code while quick code runs."""

from __future__ import annotations

import queue
import threading
import time
import weakref
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

_BREATH_SECONDS = 0.0005
"""Between two pieces: LLVM's lock is not fair, and somebody may wait with quick code."""


class Improvable(Protocol):
    """Something with fast code to come."""

    def improve(self) -> Iterator[None]:
        """Do the work, a step at a time."""
        ...


class Improver:
    """Works through what it was given, the newest first; what nobody holds any more is dropped."""

    def __init__(self) -> None:
        self._waiting: queue.LifoQueue[weakref.ref[Improvable]] = queue.LifoQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def add(self, work: Improvable) -> None:
        """Take up some work."""
        self._waiting.put(weakref.ref(work))
        with self._lock:
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="desire fast code", daemon=True)
                self._thread.start()

    def _run(self) -> None:
        while True:
            reference = self._waiting.get()
            work = reference()
            if work is None:
                continue
            steps = work.improve()
            del work
            for _ in steps:
                time.sleep(_BREATH_SECONDS)
