"""The one thread on which the engine works, and the listener that turns its calls into messages.

A daemon thread: a run in native code never holds up the app's exit.
"""

from __future__ import annotations

import contextlib
import queue
import threading
import traceback
from typing import TYPE_CHECKING

from desire_tui.commands import BY_WORD
from desire_tui.desktop import engine_messages
from desire_tui.desktop.start_up_gc import resume_gc
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.listener import Listener, StoppedAt

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.permissions import PermissionRequest, Permissions
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    Post = Callable[[engine_messages.EngineMessage], object]

WAITING_CHARS_MAX = 200_000
"""Console output the screen has not taken yet.

Above it the program waits, so that a flood cannot fill the memory.
"""
STOPPED_BY_USER = 301
WARM_UP = "TMAX = 1 | DT = 0.5 | NN = 3 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"


class ScreenListener(Listener):
    """Runs on the engine's thread; posts messages."""

    def __init__(self, post: Post) -> None:
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
        """Tell the screen."""
        del program
        self._post(engine_messages.ProgramAccepted(problems))

    def run_started(self, record: RunRecord) -> None:
        """Tell the screen."""
        self._post(engine_messages.RunStarted(record))

    def run_ended(self, record: RunRecord) -> None:
        """Tell the screen."""
        self._post(engine_messages.RunEnded(record))

    def problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Tell the screen."""
        self._post(engine_messages.ProblemsFound(diagnostics, stops=False))

    def stopped_at(self, place: StoppedAt) -> None:
        """Tell the screen."""
        self._post(engine_messages.Stopped(place))

    def graph_changed(self, graph: Graph) -> None:
        """Tell the screen; the graph itself is read there."""
        del graph
        self._post(engine_messages.GraphChanged())

    def quantities_cleared(self) -> None:
        """Tell the screen."""
        self._post(engine_messages.QuantitiesCleared())

    def noted(self, text: str) -> None:
        """Tell the screen."""
        self._post(engine_messages.NoteWritten(text))

    def front_source(self) -> Source | None:
        """Return the front tab's text."""
        return self.front

    def command(self, word: str, argument: str | None) -> bool:
        """Hand a command about editors and files to the screen."""
        if word not in BY_WORD:
            return False
        self._post(engine_messages.AppCommand(word, argument or ""))
        return True


class EngineThread:
    """Does one job after the other. What a job raises becomes a message.

    The engine is imported here, while the desktop is already seen.
    """

    def __init__(self, listener: ScreenListener, post: Post, permissions: Permissions | None = None) -> None:
        self._listener = listener
        self._post = post
        self._permissions = permissions
        self._jobs: queue.Queue[Callable[[], object]] = queue.Queue()
        self._pending = 0
        self._session: Session | None = None
        self._made = threading.Event()
        self._thread = threading.Thread(target=self._work, daemon=True, name="desire-engine")

    @property
    def is_ready(self) -> bool:
        """Whether the session is there."""
        return self._made.is_set()

    @property
    def session(self) -> Session:
        """The session; waits for it if it is just being made."""
        if self._thread.ident is None:
            self.start()  # a key that came before the first frame
        self._made.wait()
        assert self._session is not None
        return self._session

    @property
    def is_busy(self) -> bool:
        """Whether a job is going on or waits."""
        return self._pending > 0

    def start(self) -> None:
        """Begin to work, if it did not begin before."""
        if self._thread.ident is None:
            self._thread.start()

    def submit(self, job: Callable[[], object]) -> None:
        """Do a job after those that wait. Called on the screen's thread only."""
        self._pending += 1
        self._jobs.put(job)

    def forget_waiting(self) -> None:
        """Drop the jobs that were not begun."""
        while not self._jobs.empty():
            self._jobs.get_nowait()
            self._pending -= 1

    def _work(self) -> None:
        try:
            from desire_tui.engine.session.session import Session

            self._session = Session(self._listener, permissions=self._permissions)
        except Exception as error:  # noqa: BLE001 - an installation that lacks a part: the screen's thread ends the app
            self._post(engine_messages.EngineMissing(error))
            return
        self._made.set()
        self._post(engine_messages.EngineReady())
        threading.Thread(target=self._warm_up, daemon=True, name="desire-warm-up").start()
        while True:
            self._do(self._jobs.get())

    @staticmethod
    def _warm_up() -> None:
        with contextlib.suppress(Exception):  # whatever fails here fails again, and is told, when it matters
            warm_up()
        resume_gc()

    def _do(self, job: Callable[[], object]) -> None:
        from desire_tui.engine.interpreter.host import Interrupted

        failed = True
        try:
            job()
            failed = False
        except DesireError as error:
            self._post(engine_messages.ProblemsFound(error.diagnostics, stops=True))
        except Interrupted:
            pass
        except Exception as error:  # noqa: BLE001 - the last line: a fault of ours must not take the work down
            self._post(
                engine_messages.EngineFault(f"{type(error).__name__}: {error}", traceback.format_exc())
            )
        finally:
            self._pending -= 1
            self._post(engine_messages.EngineIdle(failed=failed))


def warm_up() -> None:
    """Compile and run a small program for nobody and frame its graph.

    What this imports, the first `zz` need not.
    """
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.incremental_drawing import Painter
    from desire_tui.engine.outputs.text_frame import text_frame
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    session = Session(Listener())
    session.erun(Source(WARM_UP, "<warm-up>"))
    if session.graph is not None:
        text_frame(session.graph, 40, 12)
        Painter(Canvas(40, 12), session.graph).update()
