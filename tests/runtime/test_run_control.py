"""Pausing and ending from another thread; what a session says meanwhile."""

from __future__ import annotations

import threading
from time import monotonic, sleep

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.session.session import Session
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept

LONG = "TMAX = 1.0E+06 | DT = 0.001 | NN = {nn}\ndrun\nn = 1\nDYNAMIC\nd/dt x = cos(t)\ndispt x\n"
PATIENCE = 120.0


class Worker:
    """A session at work on its own thread: runs a program or, in a session there is, carries out a command."""

    def __init__(self, text, session=None):
        self.kept = Kept() if session is None else session._listener
        self.started = threading.Event()
        self.kept.at_run_start = self.started.set
        work = Session(self.kept, backend=running.BACKEND) if session is None else session
        self.session = work
        self.error = None
        task = (
            (lambda: work.erun(Source(text, "test.src"))) if session is None else (lambda: work.execute(text))
        )
        self.thread = threading.Thread(target=self._work, args=(task,), daemon=True)
        self.thread.start()

    def _work(self, task):
        try:
            task()
        except DesireError as error:
            self.error = error

    def wait_for(self, condition):
        deadline = monotonic() + PATIENCE
        while not condition():
            assert monotonic() < deadline, self.session.status
            sleep(0.005)

    def wait_until_held(self, look):
        """Wait until a number stands still for 0.2 s; one that a run moves never does."""
        seen = []

        def held():
            seen.append(look())
            return len(seen) > 40 and len(set(seen[-40:])) == 1

        self.wait_for(held)
        return seen[-1]

    def join(self):
        self.thread.join(PATIENCE)
        assert not self.thread.is_alive()


@pytest.mark.parametrize("nn", [2, 100_000], ids=["few samples", "many samples"])
def test_pause_resume_and_end(nn):
    worker = Worker(LONG.format(nn=nn))
    session = worker.session
    assert worker.started.wait(PATIENCE)
    worker.wait_for(lambda: session.status.t > 0)
    assert session.status.state is State.RUNNING
    session.pause()
    worker.wait_for(lambda: session.status.state is State.PAUSED)
    held = worker.wait_until_held(lambda: session.status.t)
    session.resume()
    worker.wait_for(lambda: session.status.t > held)
    session.end()
    worker.join()
    assert worker.error.diagnostics[0].code == 301
    record = session.runs[0]
    assert record.ended == "stopped"
    assert record.count >= 1  # the samples stay
    assert session.values.find("n") is None  # the script ended too
    assert session.status.state is State.IDLE


def test_the_clock_of_a_paused_run_stands_still():
    began = monotonic()
    worker = Worker(LONG.format(nn=2))
    assert worker.started.wait(PATIENCE)
    worker.wait_for(lambda: worker.session.status.t > 0)
    worker.session.pause()
    worker.wait_until_held(lambda: worker.session.status.t)
    paused = monotonic()
    assert worker.wait_until_held(lambda: worker.session.status.steps_per_second) > 0
    held = monotonic() - paused
    worker.session.end()
    worker.join()
    assert worker.session.runs[-1].seconds < monotonic() - began - held


def test_end_while_paused():
    worker = Worker(LONG.format(nn=1000))
    assert worker.started.wait(PATIENCE)
    worker.session.pause()
    worker.session.end()
    worker.join()
    assert worker.error.diagnostics[0].code == 301


def test_a_script_without_runs_can_be_paused_and_ended():
    worker = Worker("n = 0\nwhile 1 > 0\nn = n + 1\nend while\n")
    n = lambda: worker.session.values.find("n")  # noqa: E731
    worker.wait_for(lambda: n() is not None and worker.session.values.cells[n().slot] > 100)
    worker.session.pause()
    worker.wait_for(lambda: worker.session.status.state is State.PAUSED)
    worker.wait_until_held(lambda: worker.session.values.cells[n().slot])
    worker.session.end()
    worker.join()
    assert worker.error.diagnostics[0].code == 301


def test_an_idle_session_ignores_pause_and_end():
    session = running.session_for("x = 1\n")
    session.pause()
    session.end()
    session.execute("y = x + 1")
    assert running.value(session, "y") == 2


def test_stop_and_go():
    session, kept = running.ran("x = 1\nSTOP\nx = x + 1\nSTOP\nx = 10 * x\n")
    assert [e[0] for e in kept.events] == ["stopped"]
    assert session.status.state is State.STOPPED
    session.execute("x = 5")
    session.execute("go")
    assert running.value(session, "x") == 6
    session.go()
    assert running.value(session, "x") == 60
    assert session.stopped_at is None
    with pytest.raises(DesireError) as caught:
        session.go()
    assert caught.value.diagnostics[0].code == 43


def test_go_after_an_edit_is_refused():
    session, _ = running.ran("x = 1\nSTOP\nx = 2\n")
    session.accept(Source("x = 1\nSTOP\nx = 3\n", "test.src"))
    with pytest.raises(DesireError) as caught:
        session.execute("go")
    assert caught.value.diagnostics[0].code == 43
    assert "changed" in caught.value.diagnostics[0].message


def test_trace_steps_through_the_script():
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    session.accept(Source("a = 1\nb = 2\nc = 3\n", "test.src"))
    session.execute("trace")
    session.execute("run")
    assert session.stopped_at is not None
    rows = []
    while session.stopped_at is not None:
        rows.append(kept.events[-1][1])
        session.execute("go")
    assert rows == [1, 2, 3]
    assert running.value(session, "c") == 3


def test_run_keeps_rule_and_scale_but_erun_does_not():
    session, _ = running.ran("x = scale\n")
    session.execute("scale = 7 | irule 3 | y = 1")
    session.execute("run")
    assert running.value(session, "x") == 7
    assert session.rule == 3
    assert session.values.find("y") is None  # names are cleared all the same
    session.execute("erun")
    assert running.value(session, "x") == 1
    assert session.rule == 1


def test_memory_of_ended_runs_is_given_back():
    session = running.session_for(
        "TMAX = 1 | NN = 1.0E+06 | DT = 1.0E-06 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\nterm x - 0.001\n"
    )
    assert session.runs[0].rows.nbytes < 1 << 16


def test_many_long_runs_do_not_fill_the_memory(monkeypatch):
    from desire_tui.engine.session import runs

    monkeypatch.setattr(runs, "RUNS_BYTES_MAX", 1_000_000)
    monkeypatch.setattr(runs, "THINNED_ROWS", 100)
    session = running.session_for(
        "TMAX = 1 | NN = 10001 | DT = 0.0001\ndisplay 2\nfor k = 1 to 12\nx = k | drunr\nnext\n"
        "DYNAMIC\nd/dt x = 1\ndispt x\n"
    )
    assert sum(r.rows.nbytes for r in session.runs) < 1_400_000
    assert len(session.runs) < 12
    assert session.status.run == 12
    curves = session.graph.curves
    assert len(curves) == 12  # the page shows them all, the old ones from fewer samples
    assert curves[0].count <= 100
    x, y = curves[0].samples()
    assert y == pytest.approx(1 + x, abs=1e-9)


def test_blocks_that_the_heartbeat_ends_become_shorter(monkeypatch):
    """The first sample takes no step, so the second block is far too long: curves must not go on by its beats."""
    from desire_tui.engine.codegen.native_model import NativeModel

    now, asked = [0.0], []
    advance = NativeModel.advance

    def by_beats(model, memory):
        wanted, limit = int(memory.row_limit - memory.row), memory.row_limit
        asked.append(wanted)
        rows = min(wanted, 50)
        memory.row_limit = memory.row + rows
        ended = advance(model, memory)
        memory.row_limit = limit
        now[0] += 1e-3 * rows if len(asked) > 1 else 0.0
        return Ended.STOPPED if rows < wanted and ended is Ended.RUNNING else ended

    monkeypatch.setattr(NativeModel, "advance", by_beats)
    monkeypatch.setattr("desire_tui.engine.runtime.simulator.perf_counter", lambda: now[0])
    session = Session()
    session.erun(Source("x = 1 | DT = 0.01 | TMAX = 10 | NN = 501\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"))
    assert session.runs[0].count == 501
    assert asked[1] > 50
    assert max(asked[2:]) <= 25  # BLOCK_SECONDS of 1 ms a sample: 20
