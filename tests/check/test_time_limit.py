"""Checks that take too long stop, and say how far they came. The clock is counted, not waited for."""

from __future__ import annotations

from math import inf

import pytest

from desire_tui.engine import cancellation
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

# two statements a line: lines with one are read together, and the clock is not looked at between them
LINES = [f"a{k} = {k} | b{k} = 0" for k in range(100)]
LINES[20] = "a20 = ("
LINES[70] = "a70 = nowhere"
SEGMENT = [f"d/dt y{k} = a{k}*t | z{k} = t" for k in range(100)]
SEGMENT[50] = "d/dt y50 = missing"
TEXT = "\n".join((*LINES, "TMAX = 1", "drun", "DYNAMIC", *SEGMENT))


@pytest.fixture
def clock(monkeypatch):
    """The thread's, which goes on by a second at each look; that on the wall is far ahead."""
    looks = 0

    def look():
        nonlocal looks
        looks += 1
        return float(looks)

    monkeypatch.setattr(cancellation, "thread_time", look)
    monkeypatch.setattr(cancellation, "perf_counter", lambda: inf)
    return lambda: looks


def codes(problems):
    return [(d.code, d.source.position(d.span.start).row) for d in problems]


def test_a_check_that_is_stopped_tells_what_it_found_and_where_it_stopped(clock):
    whole = codes(Session().check(Source(TEXT)))
    assert [row for _, row in whole] == [21, 71, 154]
    Session().check(Source(TEXT), seconds=1e9)
    needed = clock()
    stopped_at, most = [], 0
    for seconds in range(12, needed, needed // 50):
        problems = Session().check(Source(TEXT), seconds=float(seconds), quick=True)
        *found, stopped = sorted(problems, key=lambda d: d.code == 476)
        if stopped.code != 476:
            continue
        assert stopped.severity == "warning"
        stopped_at.append(stopped.facts["line"])
        assert f"line {stopped.facts['line']}" in stopped.message
        assert set(codes(found)) <= set(whole)
        most = max(most, len(found))
    assert len(stopped_at) > 30
    assert most == 2  # of the segment that was left, too; the script's names come last
    assert stopped_at[:3] == sorted(stopped_at[:3])
    assert 5 <= stopped_at[0] < 21


def test_syntax_errors_above_the_place_are_there(clock):
    problems = Session().check(Source(TEXT), seconds=60.0, quick=True)
    assert [code for code, _ in codes(problems)] == [whole_code(TEXT, 21), 476]
    row = codes(problems)[1][1]
    assert 21 < row < 71


def whole_code(text, row):
    return next(code for code, at in codes(Session().check(Source(text))) if at == row)


def test_a_check_that_was_stopped_is_no_answer_to_who_has_time(clock):
    session = Session()
    source = Source(TEXT)
    assert codes(session.check(source, seconds=60.0))[-1][0] == 476
    assert [row for _, row in codes(session.check(source))] == [21, 71, 154]


def test_processor_time_counts_and_is_asked_for_when_it_can_be_over(monkeypatch):
    wall, processor = 0.0, 0.0
    asked = []
    monkeypatch.setattr(cancellation, "perf_counter", lambda: wall)
    monkeypatch.setattr(cancellation, "thread_time", lambda: asked.append(wall) or processor)
    with cancellation.time_limit(10.0):
        for wall, processor in ((5.0, 5.0), (10.5, 6.0), (14.0, 6.0), (14.5, 9.5), (14.9, 9.9), (15.0, 10.0)):  # noqa: B007 - read by the clocks
            cancellation.cancellation_point()
        assert asked == [0.0, 10.5, 14.5, 15.0]
        wall, processor = 15.1, 10.1
        with pytest.raises(cancellation.OutOfTime):
            cancellation.cancellation_point()
