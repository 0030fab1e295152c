"""What sessions share: threads and handlers at exit belong to the process, not to each session."""

from __future__ import annotations

import atexit
import threading

from desire_tui.engine.codegen import compiler_state
from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.compiler_state import CompilerState, shared_state
from desire_tui.engine.codegen.jit.target_machine import load_llvm
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

DECAY = "x = 1 | TMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"


def threads():
    """All but the heartbeat, which ends soon after the last run."""
    return {thread for thread in threading.enumerate() if thread.name != "desire-heartbeat"}


def test_more_sessions_start_no_threads_and_add_no_handlers():
    first = Session(backend="native")
    first.erun(Source(DECAY))
    before, handlers = threads(), atexit._ncallbacks()
    for k in range(50):
        session = Session(backend="native")
        session.erun(Source(DECAY.replace("-x", f"-{k % 5 + 2}*x")))
        NativeBackend()
    assert threads() <= before
    assert atexit._ncallbacks() == handlers


def test_the_first_back_ends_of_several_threads_share_one_state(monkeypatch):
    made = []

    class Slow(CompilerState):
        def __init__(self, **how):
            made.append(self)
            threading.Event().wait(0.05)
            super().__init__(**how)

    monkeypatch.setattr(compiler_state, "CompilerState", Slow)
    compiler_state._shared_state.cache_clear()
    try:
        found = []
        asking = [threading.Thread(target=lambda: found.append(shared_state())) for _ in range(4)]
        for thread in asking:
            thread.start()
        for thread in asking:
            thread.join()
        assert len(made) == 1
        assert found == made * 4
    finally:
        compiler_state._shared_state.cache_clear()
        for state in made:
            state.close()


def test_a_state_of_ones_own_ends_when_it_is_closed(monkeypatch):
    registered = []
    shared_state()
    load_llvm()  # which has a handler of its own
    monkeypatch.setattr(atexit, "register", registered.append)
    monkeypatch.setattr(atexit, "unregister", registered.remove)
    before = threads()
    own = CompilerState()
    session = Session(compiler=own)
    session.erun(Source(DECAY))
    assert session.runs[-1].count == 3
    assert own.code is not shared_state().code
    assert len(threads() - before) > 0
    assert len(registered) == 1
    own.close()
    assert registered == []
    assert threads() <= before
