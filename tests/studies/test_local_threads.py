"""Chunks on the threads of this process: how runs are cut, who waits for whom."""

from __future__ import annotations

from threading import Event, Thread

import numpy as np
import pytest

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.studies import local_threads
from desire_tui.studies.chunk import runs_together
from desire_tui.studies.design import Design
from desire_tui.studies.keep import kept
from desire_tui.studies.local_threads import LEAST, SECONDS, chunks_by_threads
from desire_tui.studies.plan import Plan
from desire_tui.studies.task import Chunk, Task

RUNS = 100_000
RATE = 1e6


@pytest.fixture
def plan():
    task = Task("k = 0\ndrun\nDYNAMIC\nx = k\ndispt x\n", "<text>", None, "x[end]", ("k",))
    return Plan(task, Design({"k": np.arange(float(RUNS))}), kept(task.keep))


def cut(plan, workers, together=1, rate=RATE, runs=RUNS):
    """The chunks if each group of runs that go together takes together/rate seconds."""
    sizes = local_threads._Sizes(plan, workers, together)
    made = []
    for first, count in sizes.jobs([(0, runs)]):
        made.append((first, count))
        sizes.took(count, -(-count // together) * together / rate)
    return made


@pytest.mark.parametrize("together", [1, 32])
@pytest.mark.parametrize("workers", [1, 2, 5])
def test_chunks_follow_each_other_and_none_is_too_short_or_too_long(plan, workers, together):
    made = cut(plan, workers, together)
    assert [first for first, _ in made] == [0, *np.cumsum([count for _, count in made])[:-1]]
    assert sum(count for _, count in made) == RUNS
    assert made[0] == (0, together)
    assert all(LEAST * RATE <= count <= SECONDS * RATE for _, count in made[3:-1])


@pytest.mark.parametrize("together", [1, 32])
@pytest.mark.parametrize("workers", [1, 2])
def test_slow_runs_come_one_by_one_and_lanes_are_filled(plan, workers, together):
    """Each takes 10 seconds: progress is told as often as can be, and no lane of a group is left empty."""
    made = cut(plan, workers, together, together / 10, 10 * together)
    assert [count for _, count in made] == 10 * [together]


def test_a_study_in_lock_step_knows_how_many_runs_go_together(plan):
    assert runs_together(plan.task) > 1
    assert runs_together(replace(plan.task, lanes=False)) == 1


def test_the_last_chunks_of_several_threads_are_short(plan):
    left = RUNS
    for _, count in cut(plan, 2):
        assert count <= max(left / 4, LEAST * RATE)
        left -= count


def test_threads_wait_for_whoever_stores_what_they_make_and_can_be_ended_there(plan, monkeypatch):
    made, all_wait = [], Event()

    def run(task, first, rows, stopped):
        made.append(first)
        if len(made) == 2 * local_threads._WAITING:
            all_wait.set()
        return Chunk.empty(first, len(rows), 1)

    monkeypatch.setattr(local_threads, "run_chunk", run)
    chunks = chunks_by_threads(plan, [(0, RUNS)], 2)
    next(chunks)
    assert all_wait.wait(60)
    ended = Thread(target=chunks.close, daemon=True)
    ended.start()
    ended.join(60)
    assert not ended.is_alive()
    assert len(made) == 2 * local_threads._WAITING


def test_an_error_of_one_thread_ends_all(plan, monkeypatch):
    def run(task, first, rows, stopped):
        if first:
            raise DesireError(Diagnostic("stopped-by-user"))
        return Chunk.empty(first, len(rows), 1)

    monkeypatch.setattr(local_threads, "run_chunk", run)
    with pytest.raises(DesireError):
        list(chunks_by_threads(plan, [(0, RUNS)], 3))
