"""A study: planned, made run by run, and what it gave."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.thread_count import cores
from desire_tui.studies.chunk import prepare
from desire_tui.studies.dataset import check_names
from desire_tui.studies.keep import kept
from desire_tui.studies.local_threads import chunks_by_threads
from desire_tui.studies.plan import Plan
from desire_tui.studies.stores import MemoryStore, ZarrStore

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from desire_tui.studies.design import Design
    from desire_tui.studies.stores import Store
    from desire_tui.studies.task import Chunk, Task


class Progress(NamedTuple):
    """How far a study is: runs made, of how many, failed ones among them; seconds so far and to come."""

    made: int
    runs: int
    failed: int
    seconds: float
    seconds_left: float | None


class Study:
    """One study. DesireError: it cannot be made; that is found before its first run."""

    def __init__(
        self, task: Task, design: Design, *, store: Path | None = None, resume: bool = False
    ) -> None:
        _check_libraries(store)
        self.plan = Plan(task, design, kept(task.keep))
        check_names(self.plan)
        for name, _ in task.fixed:
            if name in design.names:
                raise DesireError(Diagnostic("study-twice", None, {"name": name}))
        self.way = prepare(task)
        """How its runs are made, in words."""
        self.plan.check_memory(keeps_results=store is None)
        if store is not None:
            self.plan.check_disk(store)
        self.made = 0
        """Runs made so far, by earlier studies that went on too."""
        self.store: Store = (
            MemoryStore(self.plan) if store is None else ZarrStore(self.plan, store, resume=resume)
        )

    def run(
        self,
        threads: int | None = None,
        cluster: Any = None,
        progress: Callable[[Progress], object] | None = None,
    ) -> None:
        """Make all runs that are missing; `progress` is called now and then, and ends the study by False.

        `threads` threads make them (None: one for each core), or the `cluster`. DesireError 514: its
        scheduler cannot be reached. What was made stays, whatever happens.
        """
        began = perf_counter()
        missing = list(self.store.missing())
        to_make = sum(count for _, count in missing)
        before = self.plan.runs - to_make
        made = 0
        self.made = before
        chunks = self._chunks(missing, threads, cluster)
        try:
            for chunk in chunks:
                self.store.put(chunk)
                made += len(chunk.errors)
                self.made = before + made
                seconds = perf_counter() - began
                left = seconds / made * (to_make - made)
                told = Progress(before + made, self.plan.runs, self.store.failures.count, seconds, left)
                if progress is not None and progress(told) is False:
                    return
        finally:
            chunks.close()  # type: ignore[attr-defined]  # a generator: ends what is under way

    def _chunks(self, missing: list[tuple[int, int]], threads: int | None, cluster: Any) -> Iterator[Chunk]:
        if cluster is None:
            return chunks_by_threads(self.plan, missing, threads or cores())
        from desire_tui.studies.cluster import chunks_by_cluster

        return chunks_by_cluster(self.plan, missing, cluster)

    def result(self) -> Any:
        """Return what was made so far, an xarray Dataset."""
        return self.store.result()


def _check_libraries(store: Path | None) -> None:
    from importlib.util import find_spec

    for library in ("xarray", "scipy", *(("zarr",) if store is not None else ())):
        if find_spec(library) is None:
            facts = {"what": "a study" if library != "zarr" else "a .zarr folder", "library": library}
            raise DesireError(Diagnostic("study-library", None, facts))
