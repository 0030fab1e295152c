"""Days of edit and run in one process: what a program needed goes with it."""

from __future__ import annotations

import gc
import threading

import pytest

from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit.compiler import compile_text, module_text
from desire_tui.engine.lowered.segment import Segment
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.soak.programs import chain, small
from tests.soak.resources import resources

EDITS = 25
GROWTH_MB = 25


@pytest.fixture(autouse=True)
def _nothing_of_tests_before():
    """Leave what other tests made out of the garbage collections here: to look through it takes longest."""
    gc.freeze()


def living(kind):
    gc.collect()
    return sum(1 for thing in gc.get_objects() if isinstance(thing, kind))


def test_segments_go_with_their_program():
    session = Session()
    before = living(Segment)
    for number in range(20):
        session.erun(Source(small(number)))
    assert living(Segment) <= before + 5  # the present one, and those whose fast code is under way


def test_hundreds_of_edits_end_where_they_began():
    """Every line of 300 is another one after each edit: nothing that was kept helps."""
    session = Session()

    def edit_and_run(first):
        for number in range(first, first + EDITS):
            source = Source(chain(number).replace("* t)", f"* t + {number})"))
            session.check(source)
            session.erun(source)

    edit_and_run(0)
    before = resources()
    edit_and_run(EDITS)
    after = resources()
    assert after.memory < before.memory + GROWTH_MB
    assert after.open_files <= before.open_files
    assert after.exit_handlers <= before.exit_handlers


def test_compiling_leaves_nothing_behind():
    def compile_some(first):
        for number in range(first, first + 50):
            name = f"staying_up_{number}"
            text = f"define void @{name}(ptr %v) #0 {{\nstore double {number}.5, ptr %v\nret void\n}}"
            compile_text(module_text([text], ()), level=2, slp=True)

    compile_some(0)
    before = resources()
    compile_some(50)
    assert resources().memory < before.memory + 2


def test_code_is_bounded_in_bytes(monkeypatch):
    from desire_tui.engine.codegen.jit import cache

    state = CompilerState()
    code = state.code
    monkeypatch.setattr(cache, "_BYTES_MOST", 500_000)
    session = Session(compiler=state)
    for number in range(30):
        session.erun(Source(small(number)))
        assert code.bytes <= 500_000


def test_one_thread_watches_the_runs_of_all_sessions():
    sessions = [Session() for _ in range(5)]
    for number, session in enumerate(sessions):
        session.erun(Source(small(number)))
    assert sum(thread.name == "desire-heartbeat" for thread in threading.enumerate()) <= 1


def test_a_cache_keeps_what_was_asked_for_lately():
    cache = RecentlyUsed(10)
    for program in range(100):
        cache.age()
        for line in range(8):
            cache.keep((program, line), "kept")
        assert cache["always"] == ("kept" if program else None)
        cache.keep("always", "kept")
    assert cache.size < 50
    assert cache[0, 0] is None
    assert cache[99, 7] == "kept"


def test_a_program_larger_than_a_caches_room_finds_all_of_it_again():
    cache = RecentlyUsed(10)
    for turn in range(5):
        cache.age()
        for line in range(100):
            found = cache[line]
            assert (found is not None) == (turn > 0)
            if found is None:
                cache.keep(line, "kept")
