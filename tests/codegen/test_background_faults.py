"""Fast code that cannot be made for one model: the thread goes on, the fault is reported, the numbers are right."""

from __future__ import annotations

import threading
import time

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.codegen.native_model import NativeModel
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

PROGRAM = "TMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"


class Work:
    def __init__(self, fault=None):
        self.fault, self.done = fault, threading.Event()

    def improve(self):
        yield
        self.done.set()
        if self.fault is not None:
            raise self.fault


def test_the_thread_outlives_a_fault():
    improver = Improver()
    try:
        bad, good = Work(ValueError("bad")), Work()
        improver.add_now(bad)
        assert bad.done.wait(60)
        improver.add_now(good)
        assert good.done.wait(60)
        assert [str(fault) for fault in improver.faults()] == ["bad"]
        assert improver.faults() == []
    finally:
        improver.close()


def test_a_dead_thread_is_followed_by_another(monkeypatch):
    ended_by = []
    monkeypatch.setattr(threading, "excepthook", lambda end: ended_by.append(end.exc_type))
    improver = Improver()
    try:
        last = Work(SystemExit())  # ends a thread without a word
        improver.add_now(last)
        assert last.done.wait(60)
        improver._thread.join(60)
        assert not improver._thread.is_alive()
        assert ended_by == [SystemExit]
        good = Work()
        improver.add_now(good)
        assert good.done.wait(60)
    finally:
        improver.close()


class _Told(Listener):
    def __init__(self):
        self.found = []

    def problems(self, diagnostics):
        self.found.extend(diagnostics)


def test_the_user_is_told_once(monkeypatch):
    def fails(_self):
        raise KeyError("no register")
        yield

    advance = NativeModel.advance

    def advance_after_the_fault(model, memory):
        end = time.monotonic() + 60
        with state.improver.running(model):
            while not state.improver._faults and time.monotonic() < end:
                pass  # a run that waits is no long run
        return advance(model, memory)

    monkeypatch.setattr(NativeModel, "improve", fails)
    monkeypatch.setattr(NativeModel, "advance", advance_after_the_fault)
    told, state = _Told(), CompilerState()
    session = Session(told)
    session._workspace.segments._backend = NativeBackend(state)
    try:
        session.erun(Source(PROGRAM))
        assert [(d.code, d.severity) for d in told.found] == [(474, "warning")]
        assert "no register" in told.found[0].message
        assert session.runs[-1].ended == "tmax"
    finally:
        state.close()
