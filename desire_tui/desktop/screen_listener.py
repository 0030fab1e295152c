"""What the engine calls while it works: each call becomes a message to the screen."""

from __future__ import annotations

import queue
import threading
from typing import TYPE_CHECKING

from desire_tui.commands import BY_WORD
from desire_tui.desktop import engine_messages
from desire_tui.engine.session.listener import Listener, StoppedAt

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.permissions import PermissionRequest
    from desire_tui.engine.source import Source

WAITING_CHARS_MAX = 200_000
"""Console output the screen has not taken yet.

Above it the program waits, so that a flood cannot fill the memory.
"""


class ScreenListener(Listener):
    """Runs on the engine's thread; posts messages."""

    def __init__(self, post: Callable[[engine_messages.EngineMessage], object]) -> None:
        self._post = post
        self._text: list[str] = []
        self._waiting = 0
        self._lock = threading.Lock()
        self._taken = threading.Event()
        self._lines: queue.Queue[str | None] = queue.Queue()
        self.front: Source | None = None
        """What `erun` takes; set by the screen before it starts one."""

    def console_text(self, text: str) -> None:
        """Keep the text for the screen to take."""
        with self._lock:
            first = not self._text
            self._text.append(text)
            self._waiting += len(text)
            full = self._waiting > WAITING_CHARS_MAX
            if full:
                self._taken.clear()
        if first:
            self._post(engine_messages.ConsoleText())
        if full:
            self._taken.wait(0.25)

    def take_text(self) -> str:
        """Return the output since the last call (on the screen's thread)."""
        with self._lock:
            text = "".join(self._text)
            self._text.clear()
            self._waiting = 0
            self._taken.set()
        return text

    def ask(self, prompt: str) -> str:
        """Wait for a line from the command pane."""
        while not self._lines.empty():
            self._lines.get_nowait()
        self._post(engine_messages.InputRequested(prompt))
        line = self._lines.get()
        if line is None:
            from desire_tui.engine.interpreter.host import Interrupted

            raise Interrupted
        return line

    def answer(self, line: str | None) -> None:
        """Give the line that `ask` waits for; None breaks off."""
        self._lines.put(line)

    def permit(self, request: PermissionRequest) -> bool:
        """Wait for the user's yes or no."""
        answer = engine_messages.PermissionAnswer(threading.Event())
        self._post(engine_messages.PermissionRequested(request, answer))
        answer.done.wait()
        return answer.yes

    def program_accepted(self, program: Program, problems: Sequence[Diagnostic]) -> None:
        """Report to the screen."""
        del program
        self._post(engine_messages.ProgramAccepted(problems))

    def run_started(self, record: RunRecord) -> None:
        """Report to the screen."""
        self._post(engine_messages.RunStarted(record))

    def run_ended(self, record: RunRecord) -> None:
        """Report to the screen."""
        self._post(engine_messages.RunEnded(record))

    def problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Report to the screen."""
        self._post(engine_messages.ProblemsFound(diagnostics, stops=False))

    def stopped_at(self, place: StoppedAt) -> None:
        """Report to the screen."""
        self._post(engine_messages.Stopped(place))

    def graph_changed(self, graph: Graph) -> None:
        """Report to the screen, which reads the graph itself."""
        del graph
        self._post(engine_messages.GraphChanged())

    def quantities_cleared(self) -> None:
        """Report to the screen."""
        self._post(engine_messages.QuantitiesCleared())

    def noted(self, text: str) -> None:
        """Report to the screen."""
        self._post(engine_messages.NoteWritten(text))

    def line_wanted(self, row: int) -> None:
        """Report to the screen."""
        self._post(engine_messages.LineWanted(row))

    def front_source(self) -> Source | None:
        """Return the front tab's text."""
        return self.front

    def command(self, word: str, argument: str | None) -> bool:
        """Hand a command about editors and files to the screen."""
        if word not in BY_WORD:
            return False
        self._post(engine_messages.AppCommand(word, argument or ""))
        return True
