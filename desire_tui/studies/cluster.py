"""Chunks of a study on other processes and machines, by Dask's `distributed`: its scheduler, its workers."""

from __future__ import annotations

from contextlib import contextmanager
from logging import CRITICAL, getLogger, root
from time import perf_counter
from typing import TYPE_CHECKING, Any

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.thread_count import THREADS_MOST, runs_at_once
from desire_tui.studies.chunk import run_chunk, runs_together

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.studies.plan import Plan
    from desire_tui.studies.task import Chunk, Task

FIRST = 64
SECONDS = 2.0
"""How long a chunk should take: a thousand times what scheduling it costs."""
NUMBERS_MOST = 1 << 21
"""Numbers that one chunk may keep: 16 MB to be sent."""
WAITING_EACH = 3
"""Chunks for each thread of the cluster that are given out at a time."""
REPEATS_MOST = 8
"""So often a chunk runs again whose worker died."""
CONNECT_SECONDS = 10.0
_WORKER_PROCESS = "desire_tui.studies.worker_process"


@contextmanager
def cluster_of(given: Any, workers: int | None = None) -> Iterator[Any]:
    """Lend a `distributed.Client`: the one given, one at an address, or one with local worker processes.

    DesireError 510: both are given; 514: there is no scheduler at the address; 516: the library is not there.
    """
    if given is not None and workers is not None:
        facts = {
            "what": "workers are for a local cluster, beside another one",
            "remedy": "leave --workers (workers=) away, or --cluster (cluster=)",
        }
        raise DesireError(Diagnostic("study-form", None, facts))
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        facts = {"what": "a cluster", "library": "distributed"}
        raise DesireError(Diagnostic("study-library", None, facts)) from None
    if isinstance(given, Client):
        yield given
        return
    _silence()
    if given is None:
        with (  # its types are not written down
            LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                dashboard_address=None,
                silence_logs=50,
                preload=[_WORKER_PROCESS],
            ) as cluster,
            Client(cluster) as client,
        ):
            yield client
        return
    try:
        client = Client(given, timeout=CONNECT_SECONDS)
    except (OSError, TimeoutError, ValueError) as error:
        raise _unreachable(str(given), error) from None
    with client:
        yield client


def _silence() -> None:
    """Keep the library's logs from the terminal: what matters of them is an error's message here."""
    for name in list(root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            getLogger(name).setLevel(CRITICAL)


def chunks_by_cluster(plan: Plan, missing: Iterable[tuple[int, int]], cluster: Any) -> Iterator[Chunk]:
    """Yield what runs gave, in the order in which they come. DesireError 514: the scheduler has gone."""
    with cluster_of(cluster) as client:
        address = client.scheduler.address
        try:
            yield from _chunks(plan, missing, client)
        except _lost() as error:
            raise _unreachable(address, error) from None


def _chunks(plan: Plan, missing: Iterable[tuple[int, int]], client: Any) -> Iterator[Chunk]:
    from distributed import as_completed

    size, most = FIRST, max(1, NUMBERS_MOST // max(plan.kept.size, 1))
    together = runs_together(plan.task)
    stretches = list(missing)[::-1]
    coming = as_completed()
    under_way: dict[str, Any] = {}
    threads = max(sum(client.nthreads().values()), 1)
    while stretches or under_way:
        while stretches and len(under_way) < WAITING_EACH * threads:
            first, runs = stretches.pop()
            count = min(runs, size, -(-runs // threads) + FIRST)
            if count < runs:
                stretches.append((first + count, runs - count))
            rows = plan.design.rows(first, count)
            # the task goes with each chunk: what is scattered dies with the workers that hold it
            future = client.submit(timed_chunk, plan.task, first, rows, pure=False, retries=REPEATS_MOST)
            under_way[future.key] = future
            coming.add(future)
        future = next(coming)
        # one that was lost with the worker that held it is made again; nobody takes chunks back
        if future.status == "cancelled" or client.status != "running":
            raise ConnectionError("it has gone")
        chunk, seconds = future.result()
        del under_way[future.key]
        future.release()
        wanted = int(len(chunk.errors) * SECONDS / max(seconds, 1e-6))
        size = min(most, max(together, min(wanted, 16 * size) // together * together))
        yield chunk


def timed_chunk(task: Task, first: int, rows: NDArray[np.float64]) -> tuple[Chunk, float]:
    """Make some runs; return what they gave, and the seconds that took. Carried out on a worker.

    A chunk takes one thread, as the scheduler counts: others have the machine's other cores.
    """
    began = perf_counter()
    with runs_at_once(THREADS_MOST):
        return run_chunk(task, first, rows), perf_counter() - began


def _lost() -> tuple[type[BaseException], ...]:
    """Return what is raised where a scheduler has gone."""
    from concurrent.futures import CancelledError

    from distributed.client import ClosedClientError
    from distributed.comm import CommClosedError

    return ClosedClientError, CommClosedError, CancelledError, OSError, TimeoutError


def _unreachable(address: str, error: BaseException) -> DesireError:
    reason = str(error).splitlines()[0] if str(error) else type(error).__name__
    return DesireError(Diagnostic("study-cluster", None, {"address": address, "reason": reason}))
