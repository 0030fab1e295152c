"""Commands of the command line that need no desktop."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

PROGRAM = (
    "x = 1 | scale = 3 | irule 3\nTMAX = 1 | DT = 0.1 | NN = 11\ndrun\nSTOP\nDYNAMIC\nd/dt x = -x\ndispt x\n"
)


class Console(Listener):
    def __init__(self) -> None:
        self.text = ""

    def console_text(self, text: str) -> None:
        self.text += text

    def take(self) -> str:
        text, self.text = self.text, ""
        return text


@pytest.fixture
def session(tmp_path):
    made = Session(Console(), folder=tmp_path)
    made.console = made._listener
    made.accept(Source(PROGRAM, "model.src"))
    return made


def value(session: Session, name: str) -> float:
    quantity = session.values.find(name)
    assert quantity is not None
    return session.values.cells[quantity.slot]


@pytest.mark.parametrize("word", ["erun", "zz"])
def test_erun_clears_names_scale_and_rule(session, word):
    session.execute("left_over = 5 | scale = 9 | irule 2")
    session.execute(word)
    assert session.values.find("left_over") is None
    assert (value(session, "scale"), session.rule) == (3, 3)
    assert session.runs[-1].rule == 3


def test_run_keeps_scale_and_rule(session):
    session.accept(Source(PROGRAM.replace(" | scale = 3 | irule 3", ""), "model.src"))
    session.execute("scale = 7 | irule 2")
    session.execute("run")
    assert (value(session, "scale"), session.runs[-1].rule) == (7, 2)


def test_go_needs_a_stop_and_an_unchanged_program(session):
    session.execute("zz")
    session.execute("go")
    with pytest.raises(DesireError, match="43"):
        session.execute("go")
    session.execute("zz")
    session.accept(Source(PROGRAM + "-- edited\n", "model.src"))
    with pytest.raises(DesireError, match="43"):
        session.execute("go")


@pytest.mark.parametrize("word", ["new", "NEW"])
def test_new_forgets_everything(session, word):
    session.execute("zz")
    session.execute(word)
    assert session.program is None
    assert session.values.find("x") is None
    assert (value(session, "scale"), session.rule) == (1, 1)


def test_list_prints_the_program(session):
    session.execute("list")
    assert session.console.take() == PROGRAM
    session.execute("list+")
    assert session.console.take().splitlines()[1].split(None, 1) == ["220", "TMAX = 1 | DT = 0.1 | NN = 11"]


def test_a_bare_expression_prints_its_value(session):
    session.execute("1.5*4")
    assert session.console.take() == "6\n"


def test_a_loop_on_one_line(session):
    session.execute("for k = 1 to 3 | write k; | next")
    assert session.console.take().strip() == "123"


def test_help_shows_pages_and_the_list_of_topics(session):
    session.execute("help")
    assert "dispxy" in session.console.take()
    session.execute("help 'drun'")
    assert session.console.take().startswith("# drun")
    session.execute("help 200")
    assert session.console.take().startswith("# error 200")
    session.execute("help 'no such thing' | write 'goes on'")
    unknown, after = session.console.take().splitlines()
    assert "no such thing" in unknown
    assert after == "goes on"


def test_snapshot_writes_a_picture(session, tmp_path):
    session.execute("zz")
    session.execute("snapshot 'graph.svg'")
    assert "<svg" in (tmp_path / "graph.svg").read_text(encoding="utf-8")


def test_compare_tells_how_far_another_rule_is_off(session):
    session.execute("zz")
    session.console.take()
    session.execute("compare rule 1")
    assert "x" in session.console.take()


@pytest.mark.parametrize("text", ["STOP", "display 2", "label here", "input x", "PROCEDURE p(a; b)"])
def test_what_is_no_command_is_refused(session, text):
    with pytest.raises(DesireError):
        session.execute(text)
