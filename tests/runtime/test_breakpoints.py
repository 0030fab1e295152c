"""Breakpoints stop the script before a line, from the moment they are set."""

from __future__ import annotations

import threading
import time

from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept, value

LOOP = "x = 0\nfor i = 1 to 3\n  x = x + 1\n  y = x\nnext\nz = x\n"


def started(text: str, *lines: int) -> tuple[Session, Kept]:
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    session.set_breakpoints(lines)
    session.erun(Source(text, "test.src"))
    return session, kept


def stops(kept: Kept) -> list[int]:
    return [event[1] for event in kept.events if event[0] == "stopped"]


def test_each_time_the_line_is_reached():
    session, kept = started(LOOP, 4)
    seen = [value(session, "x")]
    while session.stopped_at is not None:
        session.go()
        seen.append(value(session, "x"))
    assert seen == [1, 2, 3, 3]
    assert stops(kept) == [4, 4, 4]
    assert value(session, "z") == 3


def test_one_set_while_stopped_counts_at_once_and_one_removed_no_longer():
    session, kept = started(LOOP, 4)
    session.set_breakpoints([4, 6])
    session.go()
    session.set_breakpoints([6])
    session.go()
    assert stops(kept) == [4, 4, 6]
    assert value(session, "x") == 3
    session.go()
    assert value(session, "z") == 3


def test_one_set_on_the_line_where_the_script_stands_does_not_hold_it():
    session, kept = started("x = 1\nSTOP\nx = 2\nx = 3\n")
    session.set_breakpoints([3, 4])
    session.go()
    assert stops(kept) == [3, 4]
    assert value(session, "x") == 2
    session.go()
    assert value(session, "x") == 3


def test_one_set_while_the_script_runs_stops_it():
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    done = threading.Thread(
        target=lambda: session.erun(Source("n = 0\nrepeat\n  n = n + 1\n  m = n\nuntil n < 0\n", "test.src")),
        daemon=True,
    )
    done.start()
    while session.values.find("m") is None:
        time.sleep(0.001)
    session.set_breakpoints([4])
    done.join(120)
    assert not done.is_alive()
    assert stops(kept) == [4]
    assert value(session, "n") == value(session, "m") + 1
    before = value(session, "n")
    session.go()
    assert value(session, "n") == before + 1


def test_inside_a_procedure_and_before_the_first_of_several_statements():
    text = "PROCEDURE add(a$)\n  b = a$ | c = b\nend\nx = 1 | call add(x)\nx = 2 | call add(x)\ny = c\n"
    session, kept = started(text, 2, 5)
    assert stops(kept) == [2]
    session.go()
    assert stops(kept) == [2, 5]
    assert (value(session, "x"), value(session, "c")) == (1, 1)
    session.go()
    assert stops(kept) == [2, 5, 2]
    assert (value(session, "x"), value(session, "b")) == (2, 1)
    session.go()
    assert value(session, "y") == 2


def test_none_where_no_statement_of_the_script_begins():
    session, kept = started("x = 1\n\n-- remark\ndrun\nDYNAMIC\ny = x\ndispt y\n", 2, 3, 5, 6, 99)
    assert stops(kept) == []
    assert len(session.runs) == 1


def test_together_with_trace():
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    session.accept(Source("a = 1\nb = 2\nc = 3\nd = 4\n", "test.src"))
    session.set_breakpoints([2, 4])
    session.execute("trace")
    session.run()
    session.go()
    session.go()
    session.execute("trace")
    session.go()
    assert stops(kept) == [1, 2, 3, 4]
    session.go()
    assert value(session, "d") == 4


def test_one_on_any_row_of_a_joined_statement_holds_before_it():
    joined = "x = 1\nx = x + _\n1_\n0 | y = x\nif x_\n > 5 then z = 3 | w = _\n4\nproceed\n"
    assert Session.script_lines(Source(joined)) == {1, 2, 3, 4, 5, 6, 7, 8}
    assert stops(started(joined, 3)[1]) == [2]
    assert stops(started(joined, 4)[1]) == [4]  # where `y = x` begins
    assert stops(started(joined, 6)[1]) == [6]  # z = 3 begins there, which the condition lets through
    session, kept = started(joined, 7)
    assert stops(kept) == [6]
    assert value(session, "z") == 3
    session.go()
    assert value(session, "w") == 4
