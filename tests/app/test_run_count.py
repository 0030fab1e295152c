"""`run 3 of 5`: how many runs a script will make, told while it makes them."""

from __future__ import annotations

import io

import pytest

from desire_tui.batch import progress
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.panes.run_summary import run_text

SEGMENT = "\nDYNAMIC\nd/dt x = -x\ndispt x\n"
START = "TMAX = 1 | DT = 0.5 | NN = 3\n"


class Watcher(Listener):
    """Asks for the status at the start of each run."""

    def __init__(self) -> None:
        self.session: Session | None = None
        self.seen: list[int | None] = []
        self.said: list[str] = []

    def run_started(self, record) -> None:
        status = self.session.status
        self.seen.append(status.runs)
        self.said.append(run_text(status, 999).partition(" ·")[0])


def watched(script: str) -> Watcher:
    watcher = Watcher()
    session = watcher.session = Session(watcher, backend="reference")
    session.erun(Source(START + script + SEGMENT, "count.src"))
    return watcher


@pytest.mark.parametrize(
    "script",
    [
        "for i = 1 to 5\ndrunr\nnext",
        "n = 2\nfor i = 1 to n + 1\nfor k = 0 to 1 step 0.5\nx = i | drunr\nnext\nnext",
        "drun\ndrun\ndrun",
        "drun\nfor i = 1 to 3\ndrun\ndrun\nnext\ndrun",
        "for i = 1 to 2\ndrun\nnext\nfor k = 1 to 3\ndrun\nnext",
        "for i = 1 to 2\ndrun\nfor k = 3 to 1 step -1\ndrun\nnext\nnext",
        "PROCEDURE two(a)\nx = a | drun\nx = a + 1 | drun\nend\nfor i = 1 to 3\ncall two(i)\nnext\ncall two(7)",
        "for i = 1 to 4\nif i > 2 then\nwrite i\nelse\nx = 1\nproceed\ndrun\nnext",
        "if 1 > 0 then\nx = 0.5\nproceed\ndrun",
    ],
)
def test_every_run_knows_how_many_there_will_be(script):
    watcher = watched(script)
    assert watcher.seen
    assert set(watcher.seen) == {len(watcher.seen)}


@pytest.mark.parametrize(
    "script",
    [
        "i = 0\nrepeat\ni = i + 1 | drun\nuntil i > 2",
        "i = 0\nwhile i < 3\ni = i + 1 | drun\nend while",
        "for i = 1 to 3\nif i > 1 then\ndrun\nproceed\nnext",
        "for i = 1 to 9\ndrun\nif i > 2 then\nexit\nproceed\nnext",
        "for i = 1 to 3\nfor k = 1 to i\ndrun\nnext\nnext",
        "for i = 1 to 3\nn = 4 - i\nfor k = 1 to n\ndrun\nnext\nnext",
        "PROCEDURE some(n)\nfor k = 1 to n\ndrun\nnext\nend\nfor i = 1 to 3\ncall some(i)\nnext",
    ],
)
def test_where_it_hangs_on_what_is_not_known_yet_nothing_is_said(script):
    watcher = watched(script)
    assert len(watcher.seen) > 1
    assert set(watcher.seen) == {None}


def test_the_status_row_says_so():
    assert watched("for i = 1 to 3\ndrun\nnext").said == [
        "running 1 of 3",
        "running 2 of 3",
        "running 3 of 3",
    ]
    assert watched("drun").said == ["running 1"]
    assert watched("repeat\ndrun\nuntil x < 0.1").said[0] == "running 1"


def test_the_progress_line_of_a_headless_run_says_so(monkeypatch):
    monkeypatch.setattr(progress, "_SHOW_AFTER_SECONDS", -1.0)
    terminal = io.StringIO()

    class Shows(Watcher):
        def run_started(self, record) -> None:
            progress.Progress(self.session, terminal)()

    listener = Shows()
    listener.session = Session(listener, backend="reference")
    listener.session.erun(Source(START + "for i = 1 to 2\ndrun\nnext" + SEGMENT, "count.src"))
    assert "run 1 of 2 " in terminal.getvalue()
    assert "run 2 of 2 " in terminal.getvalue()
