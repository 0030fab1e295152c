"""Chunks of a study on the threads of this process: native code runs on all of them at once."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue
from threading import Event, Lock, Semaphore
from time import perf_counter
from typing import TYPE_CHECKING

from desire_tui.engine.thread_count import runs_at_once
from desire_tui.studies.chunk import end_runs, run_chunk, runs_together

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.studies.plan import Plan
    from desire_tui.studies.task import Chunk

SECONDS, LEAST = 0.25, 0.002
"""How long a chunk takes, at most and at least: short enough to stop at, long enough to cost nothing."""
_WAITING = 2
"""Chunks for each thread that are being made or wait for whoever stores them."""
_GROWTH = 16
"""How many times as large as those before chunks become at once: their first runs may have ended early."""
NUMBERS_MOST = 1 << 22
"""Numbers that chunks under way may keep."""


def chunks_by_threads(plan: Plan, missing: Iterable[tuple[int, int]], workers: int) -> Iterator[Chunk]:
    """Yield what runs gave, in the order in which they end. DesireError: none of them can be made."""
    crew = _Crew(plan, missing, workers)
    with (
        runs_at_once(workers),
        ThreadPoolExecutor(workers, thread_name_prefix="desire-study") as pool,
    ):
        try:
            for _ in range(workers):
                pool.submit(crew.work)
            yield from crew.chunks()
        finally:
            crew.end()


class _Crew:
    """Threads that take the next runs as soon as they are done with those before: nobody hands them out."""

    def __init__(self, plan: Plan, missing: Iterable[tuple[int, int]], workers: int) -> None:
        self._plan, self._workers, self._working = plan, workers, workers
        self._sizes = _Sizes(plan, workers, runs_together(plan.task))
        self._jobs = self._sizes.jobs(missing)
        self._lock, self._stop = Lock(), Event()
        self._made: SimpleQueue[Chunk | BaseException | None] = SimpleQueue()
        """None: a thread has ended."""
        self._room = Semaphore(_WAITING * workers)

    def work(self) -> None:
        """Make runs until there are none left."""
        try:
            while (job := self._next()) is not None:
                self._made.put(self._chunk(*job))
        except BaseException as error:  # noqa: BLE001 - who waits for the chunks raises it
            self._made.put(error)
        self._made.put(None)

    def _next(self) -> tuple[int, int] | None:
        self._room.acquire()
        with self._lock:
            return None if self._stop.is_set() else next(self._jobs, None)

    def _chunk(self, first: int, count: int) -> Chunk:
        began = perf_counter()
        made = run_chunk(self._plan.task, first, self._plan.design.rows(first, count), self._stop.is_set)
        self._sizes.took(count, perf_counter() - began)
        return made

    def chunks(self) -> Iterator[Chunk]:
        """Yield what they make."""
        while self._working:
            made = self._made.get()
            if made is None:
                self._working -= 1
            elif isinstance(made, BaseException):
                raise made
            else:
                yield made
                self._room.release()

    def end(self) -> None:
        """Let them make no more."""
        self._stop.set()
        end_runs(self._plan.task)
        self._room.release(self._workers)


class _Sizes:
    """Cuts stretches of runs into chunks by the time that those before have taken.

    Chunks are whole groups of `together` runs, which take hardly longer than one of them. The first is one
    group: a result is seen at once.
    """

    def __init__(self, plan: Plan, workers: int, together: int) -> None:
        self._size, self._least = together, together
        self._workers, self._together = workers, together
        self._most = max(1, NUMBERS_MOST // max(plan.kept.size, 1))

    def took(self, runs: int, seconds: float) -> None:
        """Note how long a chunk took."""
        per_second = runs / max(seconds, 1e-6)
        self._size = max(1, min(int(per_second * SECONDS), _GROWTH * self._size))
        self._least = max(1, min(int(per_second * LEAST), self._size))

    def jobs(self, missing: Iterable[tuple[int, int]]) -> Iterator[tuple[int, int]]:
        """Yield chunks: the first run, how many."""
        for begin, runs in missing:
            first, left = begin, runs
            while left:
                count = min(left, self._most, self._next(left))
                yield first, count
                first, left = first + count, left - count

    def _next(self, left: int) -> int:
        """Return how many runs of those left are next."""
        count = self._size
        if self._workers > 1:
            # half of a fair share: what is left at the end is small, and no thread waits long for another
            count = min(count, max(self._least, left // (2 * self._workers)))
        return -(-count // self._together) * self._together
