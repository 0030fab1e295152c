"""Fast code is begun when runs have lasted for a moment, alone or together; short ones cost no second thread's work."""

from __future__ import annotations

import functools
import threading
import time

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit import background, compiler, target_machine
from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

SHORT = "TMAX = 1 | DT = 0.1 | NN = 3\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
ENOUGH = 60.0


class Work:
    def __init__(self, kind=None):
        self.begun = threading.Event()
        self.kind = kind

    def improve(self):
        self.begun.set()
        yield


def busy(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def begun_in_a_run(improver, work):
    """Run, using the processor, until the work is begun."""
    end = time.monotonic() + ENOUGH
    with improver.running(work):
        while not work.begun.is_set() and time.monotonic() < end:
            busy(0.001)
    return work.begun.is_set()


@pytest.fixture
def improver():
    made = Improver()
    yield made
    made.close()


def test_not_without_a_run(improver):
    work = Work()
    improver.add(work)
    busy(0.01)
    assert not work.begun.is_set()
    assert improver._thread is None


def test_not_for_a_run_that_is_over(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", ENOUGH)
    work = Work()
    improver.add(work)
    with improver.running(work):
        busy(0.01)
    assert not work.begun.is_set()


def test_while_its_run_goes_on(improver):
    work, other = Work(), Work()
    improver.add(other)
    improver.add(work)
    assert begun_in_a_run(improver, work)
    assert not other.begun.is_set()


def test_a_run_that_does_not_get_the_processor_is_not_long(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", 0.05)
    work = Work()
    improver.add(work)
    with improver.running(work):
        assert not work.begun.wait(0.15)


def test_short_runs_add_up(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", 0.02)
    work = Work()
    improver.add(work)
    end = time.monotonic() + ENOUGH
    while not work.begun.is_set() and time.monotonic() < end:
        with improver.running(work):
            busy(0.001)
    assert work.begun.is_set()


def test_the_second_thread_is_not_woken_for_each_short_run(improver, monkeypatch):
    woken = []
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", ENOUGH)
    monkeypatch.setattr(improver, "_wake", lambda: (woken.append(1), Improver._wake(improver)))
    work = Work()
    improver.add(work)
    for _ in range(1000):
        with improver.running(work):
            pass
    assert 1 <= len(woken) < 100  # again where it has looked in vain


def test_the_next_run_begins_what_earlier_ones_were_enough_for(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", 0.02)
    improver.looks = True  # it does not: it is not there
    work = Work()
    improver.add(work)
    for _ in range(2):
        with improver.running(work):
            busy(0.015)
    assert improver._thread is None
    with improver.running(work):
        assert work.begun.wait(ENOUGH)


def test_what_nobody_holds_is_dropped(improver):
    dropped, work = Work(), Work()
    begun = dropped.begun
    improver.add(dropped)
    del dropped
    improver.add(work)
    assert begun_in_a_run(improver, work)
    assert not begun.is_set()
    assert not improver._waiting


def test_at_once_where_that_is_asked_for(improver):
    work = Work()
    improver.add_now(work)
    assert work.begun.wait(ENOUGH)


def run(improver, work, seconds):
    improver.add(work)
    with improver.running(work):
        busy(seconds)


def test_runs_of_earlier_models_of_the_same_kind_count(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", 0.02)
    monkeypatch.setattr(background, "_WORTH_IT_SECONDS", 0.01)
    improver.looks = True  # it does not: it is not there
    works = [Work(kind) for kind in (7, 8, 7)]
    for work in works:
        run(improver, work, 0.015)
    assert improver._thread is None
    for work in (Work(), Work(8), Work(7)):
        improver.add(work)
        with improver.running(work):
            assert (improver._thread is not None) == (work.kind == 7)
    assert work.begun.wait(ENOUGH)


def test_runs_that_are_not_worth_it_do_not_count_for_the_next(improver, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_SECONDS", 0.02)
    monkeypatch.setattr(background, "_WORTH_IT_SECONDS", 0.019)
    works = [Work(7) for _ in range(10)]
    for work in works:
        run(improver, work, 0.004)
    assert not any(work.begun.is_set() for work in works)


class WantsLlvm(Work):
    """Work whose code is not on disk."""

    def __init__(self, kind=None):
        super().__init__(kind)
        self.attempts = 0

    def improve(self):
        self.attempts += 1
        target_machine.require_llvm()
        self.begun.set()
        yield


def _forget_llvm(monkeypatch):
    anew = functools.cache(target_machine.llvm_library.__wrapped__)
    for module in (target_machine, compiler):
        monkeypatch.setattr(module, "llvm_library", anew)


@pytest.fixture
def no_llvm(monkeypatch):
    compiler.machine()  # may load it
    _forget_llvm(monkeypatch)


def test_longer_where_llvm_must_be_loaded_first(improver, no_llvm, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_WITHOUT_LLVM_SECONDS", 0.05)
    work, began = WantsLlvm(), time.process_time()
    improver.add(work)
    assert begun_in_a_run(improver, work)
    assert time.process_time() - began >= 0.05
    assert work.attempts == 2
    assert not improver.faults()


def test_llvm_is_loaded_for_models_of_a_kind_together(improver, no_llvm, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_WITHOUT_LLVM_SECONDS", 0.05)
    works = []
    end = time.monotonic() + ENOUGH
    while not (works and works[-1].begun.is_set()) and time.monotonic() < end:
        works.append(WantsLlvm(7))
        run(improver, works[-1], 0.01)
    assert any(work.begun.is_set() for work in works)
    assert len(works) > 4


def test_never_for_a_run_that_is_not_worth_it(improver, no_llvm, monkeypatch):
    monkeypatch.setattr(background, "_PATIENCE_WITHOUT_LLVM_SECONDS", ENOUGH)
    work = WantsLlvm()
    improver.add(work)
    end = time.monotonic() + ENOUGH
    with improver.running(work):
        while not (work.attempts and improver._waiting) and time.monotonic() < end:
            busy(0.001)
        busy(0.01)
    assert work.attempts == 1
    assert not work.begun.is_set()


def test_at_once_with_llvm_too(improver, no_llvm):
    work = WantsLlvm()
    improver.add_now(work)
    assert work.begun.wait(ENOUGH)
    assert work.attempts == 1


def test_code_on_disk_needs_no_llvm(tmp_path, monkeypatch, no_llvm):
    monkeypatch.setattr(disk_cache, "_path", lambda name: str(tmp_path / "cache" / name))
    text = "define void @nothing() {\nret void\n}"
    with target_machine.loading_llvm(allowed=False), pytest.raises(target_machine.LlvmNotLoadedError):
        compiler.compile_text(text, level=0, keep=True)
    compiler.compile_text(text, level=0, keep=True)
    _forget_llvm(monkeypatch)
    with target_machine.loading_llvm(allowed=False):
        assert compiler.compile_text(text, level=0, keep=True).address("nothing")


def model_of(session):
    (model,) = (known[2] for known in session._workspace.segments._backend._models.values())
    return model


def test_models_wait_for_it():
    """A program's short run is over on quick code; a long one goes over to fast code, and then the next, too."""
    state = CompilerState()
    try:
        session, again = Session(compiler=state), Session(compiler=state)
        session.erun(Source(SHORT))
        model = model_of(session)
        assert not model.improved
        assert state.improver._waiting
        end = time.monotonic() + ENOUGH
        with state.improver.running(model):
            while not model.improved and time.monotonic() < end:
                busy(0.001)
        assert model.improved
        again.erun(Source(SHORT))
        while not model_of(again).improved and time.monotonic() < end:
            busy(0.001)
        assert model_of(again).improved
    finally:
        state.close()
