"""Programs run through a whole session, with everything it said kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic

BACKEND = "reference"
"""Set by the fixture: every test here runs on both back ends."""


class Kept(Listener):
    """Keeps what it hears."""

    def __init__(self, answers=()):
        self.text = ""
        self.events: list[tuple] = []
        self.problems_shown: list[Diagnostic] = []
        self.answers = iter(answers)
        self.at_run_start = None

    def console_text(self, text):
        self.text += text

    def ask(self, prompt):
        self.text += prompt
        try:
            return next(self.answers)
        except StopIteration:
            raise EOFError from None

    def run_started(self, record):
        self.events.append(("started", record.number))
        if self.at_run_start is not None:
            self.at_run_start()

    def run_ended(self, record):
        self.events.append(("ended", record.number, record.ended))

    def stopped_at(self, place):
        self.events.append(("stopped", place.source.position(place.placed.at).row))

    def problems(self, diagnostics):
        self.problems_shown += diagnostics
        self.events.append(("problems", [d.key for d in diagnostics]))

    def graph_changed(self, graph):
        self.events.append(("graph", graph.number))


def session_for(text, *, folder=None, answers=(), backend=None):
    """Return a session that has run a program."""
    session, _ = ran(text, folder=folder, answers=answers, backend=backend)
    return session


def ran(text, *, folder=None, answers=(), backend=None):
    """Return a session that has run a program, and its listener."""
    kept = Kept(answers)
    session = Session(kept, backend=backend or BACKEND, folder=folder)
    session.erun(Source(text, "test.src"))
    return session, kept


def value(session, name):
    """Return the final value of a scalar."""
    quantity = session.values.find(name)
    assert quantity is not None, name
    assert session.values.is_defined(quantity), name
    return session.values.cells[quantity.slot]


def failure(text, *, folder=None, answers=()):
    """Return the diagnostics of a program that fails."""
    try:
        session_for(text, folder=folder, answers=answers)
    except DesireError as error:
        return error.diagnostics
    raise AssertionError("the program did not fail")
