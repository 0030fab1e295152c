"""Programs run through a session on one of the back ends."""

from __future__ import annotations

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import rules_of
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

RULES = rules_of("multistep")


class Silent(Listener):
    def __init__(self):
        self.text = ""

    def console_text(self, text):
        self.text += text


def run(text, backend="native"):
    """Run a program; return the session and what it wrote."""
    listener = Silent()
    session = Session(listener, backend=backend)
    session.erun(Source(text, "test.src"))
    return session, listener.text


def failure(text, backend="native"):
    """Return the session and the first diagnostic of a program that must fail."""
    listener = Silent()
    session = Session(listener, backend=backend)
    try:
        session.erun(Source(text, "test.src"))
    except DesireError as error:
        return session, error.diagnostics[0]
    raise AssertionError("the program did not fail")


def numbers(text, backend="native"):
    """The numbers that a program's last written line holds."""
    return [float(word) for word in run(text, backend)[1].split("\n")[-2].split()]
