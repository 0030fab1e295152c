"""One round of what a user does in a day, at full speed."""

from __future__ import annotations

import shutil
from contextlib import suppress
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.soak import programs

if TYPE_CHECKING:
    from pathlib import Path

_KINDS = (programs.chain, programs.small, programs.vectors, programs.stiff)
_SLIDER_RUNS = 10
_LOOPS_EVERY, _SNAPSHOTS_EVERY, _REFERENCE_EVERY = 5, 4, 7


class Work:
    """A session that lives as long as the process, and others that come and go."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "work"
        self._folder.mkdir()
        self._session = Session(folder=self._folder)
        self.rounds = self.runs = self.checks = 0

    def round(self) -> None:
        """Edit, check, run; move a slider; now and then a loop, pictures, a notebook, other sessions."""
        number = self.rounds
        self.rounds += 1
        kind = _KINDS[number % len(_KINDS)]
        self._edit_and_run(self._session, kind(number))
        self._check(programs.misspelt(number))
        self._slide(number)
        if number % _LOOPS_EVERY == 0:
            self._run(self._session, programs.loop(number))
        if number % _SNAPSHOTS_EVERY == 0:
            self._run(self._session, programs.small(number))
            for ending in ("png", "svg", "pdf"):
                self._session.snapshot(self._folder / f"page.{ending}")
            self._with_notebook(number)
        self._other_session(number)

    def tidy(self) -> None:
        """Delete the files that the user asked for."""
        for file in self._folder.iterdir():
            if file.is_dir():
                shutil.rmtree(file)
            else:
                file.unlink()

    def _check(self, text: str) -> None:
        self._session.check(Source(text, "edited"))
        self.checks += 1

    def _edit_and_run(self, session: Session, text: str) -> None:
        for _ in range(2):
            self._check(text)
            self._run(session, text)
            text = text.replace("DT = 0.0", "DT = 0.00", 1)

    def _run(self, session: Session, text: str) -> None:
        session.erun(Source(text, "program"))
        self.runs += session.status.run

    def _slide(self, number: int) -> None:
        text = programs.small(number)
        for step in range(_SLIDER_RUNS):
            self._session.override({"w": 1.0 + step / 7})
            self._run(self._session, text)
        self._session.override({})

    def _with_notebook(self, number: int) -> None:
        self._session.execute(f"notebook 'book{number}.md'")
        self._run(self._session, programs.small(number))
        self._session.execute("write x^2")
        self._session.execute("notebook off")

    def _other_session(self, number: int) -> None:
        reference = number % _REFERENCE_EVERY == 0
        other = Session(backend="reference" if reference else "native", folder=self._folder)
        self._run(other, programs.small(number))
        with suppress(DesireError):
            self._run(other, "write undefined\n")
        other.new()
