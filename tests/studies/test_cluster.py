"""Studies on worker processes: the same results, whatever dies."""

from __future__ import annotations

import os
import signal

import pytest

import desire_tui
from desire_tui import DesireError
from desire_tui.engine import thread_count
from desire_tui.studies import cluster

NOISY = """k = 1 | DT = 0.01 | TMAX = 1 | NN = 101 | x = 1 | n = 0
drun
DYNAMIC
d/dt x = n - k*x^3
OUT
n = gauss(0)
dispt x
"""
SETTINGS = {"sample": {"k": "uniform(-0.6, 1)"}, "runs": 500, "seed": 7, "keep": "x[end], x@0:1:0.5"}


def test_a_worker_that_dies_costs_its_chunk_only_and_what_is_stored_outlives_a_scheduler(tmp_path):
    alone = desire_tui.study(NOISY, **SETTINGS)
    with cluster.cluster_of(None, 2) as client:
        told = []
        workers = client.run(os.getpid)
        handlers = client.run(signal.getsignal, signal.SIGINT)
        assert set(handlers.values()) == {signal.SIG_IGN}, "Ctrl-C is the study's"

        def kill_one(progress):
            if not told:
                os.kill(next(iter(workers.values())), signal.SIGKILL)
            told.append(progress)

        found = desire_tui.study(NOISY, **SETTINGS, cluster=client, progress=kill_one)
        path = tmp_path / "s.zarr"
        with pytest.raises(
            DesireError, match=r"scheduler .* cannot be reached"
        ):  # in the middle of another study
            desire_tui.study(
                NOISY, **SETTINGS, cluster=client, store=path, progress=lambda _: client.cluster.close()
            )
    assert desire_tui.study(NOISY, **SETTINGS, store=path, resume=True)["x[end]"].equals(alone["x[end]"])
    assert len(told) > 1, "it died in the middle"
    assert found.identical(alone)
    assert 0 < found.attrs["failed"] < 500


def test_a_scheduler_that_is_not_there(monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.3)
    with pytest.raises(DesireError) as error:
        desire_tui.study(NOISY, **SETTINGS, cluster="tcp://127.0.0.1:9")
    problem = error.value.diagnostics[0]
    assert problem.code == 514
    assert "tcp://127.0.0.1:9 cannot be reached" in problem.message


def test_workers_are_for_a_local_cluster():
    with pytest.raises(DesireError, match="workers are for a local cluster"):
        desire_tui.study(NOISY, **SETTINGS, cluster="tcp://127.0.0.1:9", workers=2)


def test_a_chunk_takes_one_thread(monkeypatch):
    threads = []
    monkeypatch.setattr(thread_count, "cores", lambda: 8)
    monkeypatch.setattr(cluster, "run_chunk", lambda *_: threads.append(thread_count.thread_count()))
    cluster.timed_chunk(None, 0, None)
    assert threads == [1]
