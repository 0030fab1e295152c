"""Runs example programs in the background for their graphs: nothing is stored that could be stale.

A daemon thread with a session of its own. The newest wish counts: what runs for an older one is ended.
"""

from __future__ import annotations

import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.session.listener import Listener

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.session.session import Session
    from desire_tui.panes.example_catalogue import Example

LIMIT_S = 4.0
"""A program that takes longer is ended, and shown as far as it came. The slowest example takes 1.5 s."""
STOPS_MAX = 20
TEXT_MAX = 4000


@dataclass(frozen=True, eq=False)
class Preview:
    """What a program did: its last graph, None if it draws none, and what it printed."""

    example: Example
    graph: Graph | None
    printed: str
    problem: str = ""


class _PreviewListener(Listener):
    """Collects what is printed, types the answers that the program brings along, permits nothing."""

    def __init__(self, answers: list[str]) -> None:
        self._answers = iter(answers)
        self.printed = ""

    def console_text(self, text: str) -> None:
        """Keep the beginning."""
        if len(self.printed) < TEXT_MAX:
            self.printed += text

    def ask(self, prompt: str) -> str:
        """Answer, or break the program off."""
        from desire_tui.engine.interpreter.host import Interrupted

        answer = next(self._answers, None)
        if answer is None:
            raise Interrupted
        self.console_text(f"{prompt}{answer}\n")
        return answer


class Previewer:
    """`ask` for a program, and `report` is called with its preview in the previewer's thread."""

    def __init__(self, report: Callable[[Preview], object]) -> None:
        self._report = report
        self._condition = threading.Condition()
        self._wanted: Example | None = None
        self._session: Session | None = None
        self._closed = False
        self._thread: threading.Thread | None = None

    def ask(self, example: Example) -> None:
        """Run a program as soon as possible; an older wish is forgotten."""
        with self._condition:
            self._wanted = example
            self._end()
            self._condition.notify()
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, daemon=True, name="desire-preview")
            self._thread.start()

    def close(self) -> None:
        """End what runs; nothing is reported any more."""
        with self._condition:
            self._closed = True
            self._wanted = None
            self._end()
            self._condition.notify()

    def _end(self) -> None:
        if self._session is not None:
            self._session.end()

    def _work(self) -> None:
        while True:
            with self._condition:
                while self._wanted is None and not self._closed:
                    self._condition.wait()
                if self._closed or self._wanted is None:
                    return
                example, self._wanted = self._wanted, None
            preview = self._made(example)
            with self._condition:
                self._session = None
                superseded = self._is_superseded
            if not superseded:
                self._report(preview)

    @property
    def _is_superseded(self) -> bool:
        return self._closed or self._wanted is not None

    def _made(self, example: Example) -> Preview:
        from desire_tui.engine.diagnostics import DesireError
        from desire_tui.engine.interpreter.host import Interrupted
        from desire_tui.engine.session.session import Session

        listener = _PreviewListener(example.answers)
        with tempfile.TemporaryDirectory(prefix="desire-preview-", ignore_cleanup_errors=True) as folder:
            session = Session(listener, folder=Path(folder))
            with self._condition:
                self._session = session
                if self._is_superseded:
                    return Preview(example, None, "")
            alarm = threading.Timer(LIMIT_S, session.end)
            alarm.daemon = True
            alarm.start()
            problem = ""
            try:
                _perform(session, example)
            except (DesireError, Interrupted, OSError) as error:
                problem = "" if isinstance(error, Interrupted) else _sentence(error)
            finally:
                alarm.cancel()
            return Preview(example, session.graph, listener.printed.rstrip(), problem)


def _sentence(error: Exception) -> str:
    """Return why a program ended, in one line."""
    from desire_tui.engine.diagnostics import DesireError

    return error.message if isinstance(error, DesireError) else str(error)


def _perform(session: Session, example: Example) -> None:
    """Run a program to its end: every STOP is answered with `go`."""
    from desire_tui.engine.source import Source

    session.erun(Source(example.text, example.path.name))
    stops = 0
    while session.stopped_at is not None and stops < STOPS_MAX:
        stops += 1
        session.go()
