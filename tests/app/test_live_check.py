"""When texts are checked while somebody types: a quick check at once, a closer look when it is quiet."""

from __future__ import annotations

import queue
import threading

import pytest

from desire_tui.editor.buffer import Buffer
from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.language import live_check
from desire_tui.language.live_check import LiveChecker

from .conftest import desktop

PATIENCE = 120.0
QUICK, CLOSER = (Diagnostic("no-run"),), (Diagnostic("no-run"), Diagnostic("jacobian-wrong"))


@pytest.fixture
def reports(monkeypatch):
    monkeypatch.setattr(live_check, "QUIET_SECONDS", 0.01)
    return queue.Queue()


def checker(reports, closer):
    return LiveChecker(lambda _: QUICK, lambda *report: reports.put(report), reports.put, closer)


def buffer(number):
    made = Buffer(label="a.src")
    made.number = number
    return made


def test_a_closer_look_follows_and_tells_more(reports):
    checker(reports, lambda _: CLOSER).ask(buffer(7), 3, "x = 1\n")
    assert reports.get(timeout=PATIENCE) == (7, 3, QUICK)
    assert reports.get(timeout=PATIENCE) == (7, 3, CLOSER)


def test_a_closer_look_that_finds_the_same_is_not_told(reports):
    texts = iter((QUICK, CLOSER))
    made = checker(reports, lambda _: next(texts))
    made.ask(buffer(1), 1, "x = 1\n")
    assert reports.get(timeout=PATIENCE) == (1, 1, QUICK)
    made.ask(buffer(2), 1, "x = 2\n")  # whether or not the first was looked at by then
    seen = [reports.get(timeout=PATIENCE), reports.get(timeout=PATIENCE)]
    assert [problems for _, _, problems in seen] == [QUICK, CLOSER]
    assert reports.empty()


def test_a_newer_text_takes_the_place_of_one_that_waits(reports, monkeypatch):
    monkeypatch.setattr(live_check, "QUIET_SECONDS", 1e9)  # it never gets quiet
    looked = []
    made = checker(reports, looked.append)
    for version in (1, 2):
        made.ask(buffer(5), version, f"x = {version}\n")
        assert reports.get(timeout=PATIENCE) == (5, version, QUICK)
    assert looked == []
    assert len(made._checked) == 1
    assert made._checked[5][0] == 2


def test_a_fault_does_not_end_all_checking(reports):
    def fails(_):
        raise ZeroDivisionError

    made = checker(reports, fails)
    made.ask(buffer(1), 1, "x = 1\n")
    assert reports.get(timeout=PATIENCE) == (1, 1, QUICK)
    assert isinstance(reports.get(timeout=PATIENCE), ZeroDivisionError)
    made.ask(buffer(1), 2, "x = 2\n")
    assert reports.get(timeout=PATIENCE) == (1, 2, QUICK)


def test_a_text_that_is_edited_while_it_is_checked_is_left(reports):
    """The first text's check would never end."""
    begun = threading.Event()

    def check(source):
        begun.set()
        while source.text == "x = 1\n":
            cancellation_point()
        return QUICK

    made = LiveChecker(check, lambda *report: reports.put(report), reports.put)
    made.ask(buffer(1), 1, "x = 1\n")
    assert begun.wait(PATIENCE)
    made.ask(buffer(1), 2, "x = 2\n")
    assert reports.get(timeout=PATIENCE) == (1, 2, QUICK)
    assert reports.empty()


def test_a_text_that_is_not_checked_is_said(reports, monkeypatch):
    monkeypatch.setattr(live_check, "CHECKED_MAX", 10)
    made = checker(reports, lambda _: CLOSER)
    made.ask(buffer(1), 1, "x = 1\n" * 3)
    number, version, problems = reports.get(timeout=PATIENCE)
    assert (number, version, [(d.code, d.severity) for d in problems]) == (1, 1, [(476, "warning")])
    assert "10 characters" in problems[0].message


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_checking_thread_that_ended_is_followed_by_another(reports):
    """SystemExit ends a thread without a word; here even the report of the fault fails."""

    def fails(_):
        raise SystemExit

    made = LiveChecker(fails, lambda *report: reports.put(report), fails)
    made.ask(buffer(1), 1, "x = 1\n")
    made._thread.join(PATIENCE)
    made._check = lambda _: QUICK
    made.ask(buffer(1), 2, "x = 2\n")
    assert reports.get(timeout=PATIENCE) == (1, 2, QUICK)


async def test_each_tab_has_a_check_of_its_own_to_come(program, monkeypatch):
    """An edit in a second tab a moment later does not put off the first one's check for ever."""
    async with desktop(program("x = 1\n")) as desk:
        editor = desk.app.editor
        first = editor.front
        second = await editor.add(Buffer(), "y = 1\n")
        await desk.idle()
        asked: list[int] = []
        monkeypatch.setattr(
            desk.app.checker, "ask", lambda buffer, _version, _text: asked.append(buffer.number)
        )
        first.insert("z = ")
        await desk.pilot.pause()
        second.insert("z = ")
        await desk.until(lambda: second.buffer.number in asked)
        await desk.until(lambda: first.buffer.number in asked)
