"""Chunks of a study on the threads of this process: native code runs on all of them at once."""

from __future__ import annotations

from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from threading import Event
from time import perf_counter
from typing import TYPE_CHECKING

from desire_tui.engine.thread_count import runs_at_once
from desire_tui.studies.chunk import end_runs, run_chunk

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.studies.plan import Plan
    from desire_tui.studies.task import Chunk

FIRST = 64
"""Runs of the first chunks: a result is seen at once."""
SECONDS = 0.25
"""How long a chunk should take: short enough to stop at, long enough to cost nothing."""
NUMBERS_MOST = 1 << 22
"""Numbers that chunks under way may keep."""


def chunks_by_threads(plan: Plan, missing: Iterable[tuple[int, int]], workers: int) -> Iterator[Chunk]:
    """Yield what runs gave, in the order in which they end. DesireError: none of them can be made."""
    stop, sizes = Event(), _Sizes(plan, workers)
    waiting: set[Future[Chunk]] = set()
    jobs = sizes.jobs(missing)

    def work(first: int, count: int) -> Chunk:
        began = perf_counter()
        made = run_chunk(plan.task, first, plan.design.rows(first, count), stop.is_set)
        sizes.took(count, perf_counter() - began)
        return made

    with (
        runs_at_once(workers),
        ThreadPoolExecutor(workers, thread_name_prefix="desire-study") as pool,
    ):
        try:
            while True:
                while len(waiting) <= workers:
                    job = next(jobs, None)
                    if job is None:
                        break
                    waiting.add(pool.submit(work, *job))
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    yield future.result()
        finally:
            stop.set()
            end_runs(plan.task)
            for future in waiting:
                future.cancel()


class _Sizes:
    """Cuts stretches of runs into chunks that take about SECONDS each."""

    def __init__(self, plan: Plan, workers: int) -> None:
        self._size = FIRST
        self._workers = workers
        self._most = max(1, NUMBERS_MOST // max(plan.kept.size, 1))

    def took(self, runs: int, seconds: float) -> None:
        """Note how long a chunk took."""
        wanted = int(runs * SECONDS / max(seconds, 1e-6))
        self._size = max(1, min(self._most, wanted, 16 * self._size))

    def jobs(self, missing: Iterable[tuple[int, int]]) -> Iterator[tuple[int, int]]:
        """Yield chunks: the first run, how many."""
        for begin, runs in missing:
            first, left = begin, runs
            while left:
                # half of a fair share: what is left at the end is small, and no thread waits long for another
                count = min(left, self._size, -(-left // (2 * self._workers)) + FIRST)
                yield first, count
                first, left = first + count, left - count
