"""Runs whole programs on the reference back end, silently."""

from __future__ import annotations

from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source


def run(text: str, *, backend: str = "reference", go: int = 0) -> Session:
    session = Session(backend=backend)
    program = "\n".join(line.strip() for line in text.strip().splitlines())
    problems = session.accept(Source(program, "t.src"))
    assert not problems, [d.message for d in problems]
    session.erun()
    for _ in range(go):
        session.go()
    return session


def value(session: Session, name: str) -> float:
    return session.values.cells[session.values.find(name).slot]


def array(session: Session, name: str):
    return session.values.view(session.values.find(name)).copy()
