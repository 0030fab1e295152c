"""The one thread on which the engine works.

A daemon thread: a run in native code never holds up the app's exit.
"""

from __future__ import annotations

import contextlib
import queue
import threading
import traceback
from functools import cache
from typing import TYPE_CHECKING

from desire_tui.desktop import engine_messages
from desire_tui.desktop.start_up_gc import resume_gc
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.listener import Listener

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.desktop.screen_listener import ScreenListener
    from desire_tui.engine.session.permissions import Permissions
    from desire_tui.engine.session.session import Session

    Post = Callable[[engine_messages.EngineMessage], object]

STOPPED_BY_USER = 301
SETTLE_S = 0.2
"""A run or a script that was ended is over by then, and what it wrote is in its files."""
WARM_UP = "TMAX = 1 | DT = 0.5 | NN = 3 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"


class EngineThread:
    """Does one job after the other. What a job raises becomes a message.

    The engine is imported here, while the desktop is already seen.
    """

    def __init__(self, listener: ScreenListener, post: Post, permissions: Permissions | None = None) -> None:
        self._listener = listener
        self._post = post
        self.permissions = permissions
        self._jobs: queue.Queue[Callable[[], object] | None] = queue.Queue()
        """None: there will be no more."""
        self._pending = 0
        self._counting = threading.Condition()
        self._session: Session | None = None
        self._made = threading.Event()
        self._starting = threading.Lock()
        self._thread = threading.Thread(target=self._work, daemon=True, name="desire-engine")

    @property
    def is_ready(self) -> bool:
        """Whether the session is there."""
        return self._made.is_set()

    @property
    def session(self) -> Session:
        """The session; waits for it if it is just being made."""
        self.start()  # if a key came before the first frame
        self._made.wait()
        assert self._session is not None
        return self._session

    @property
    def is_busy(self) -> bool:
        """Whether a job is going on or waits."""
        return self._pending > 0

    def start(self) -> None:
        """Begin to work, if it did not begin before; whichever thread asks first, and at the same time."""
        with self._starting:  # Python starts a thread twice that two ask to, and takes it for dead
            if self._thread.ident is None:
                self._thread.start()

    def submit(self, job: Callable[[], object]) -> None:
        """Do a job after those that wait. Called on the screen's thread only."""
        self._count(1)
        self._jobs.put(job)
        if self.is_ready and not self._thread.is_alive():
            reason = "the engine's thread had ended; another has taken its place"
            self._post(engine_messages.EngineFault(reason, reason))
            self._thread = threading.Thread(target=self._go_on, daemon=True, name="desire-engine")
            self._thread.start()

    def forget_waiting(self) -> None:
        """Drop the jobs that were not begun."""
        while not self._jobs.empty():
            if self._jobs.get_nowait() is not None:
                self._count(-1)

    def end(self) -> None:
        """Do what waits and no more: the process goes on, and a thread keeps all that it knows."""
        self._jobs.put(None)

    def settle(self) -> None:
        """Wait for what was ended before the process goes; not for what goes on all the same."""
        with self._counting:
            self._counting.wait_for(lambda: not self._pending, SETTLE_S)

    def _count(self, by: int) -> None:
        with self._counting:
            self._pending += by
            self._counting.notify_all()

    def _work(self) -> None:
        try:
            from desire_tui.engine.session.session import Session

            self._session = Session(self._listener, permissions=self.permissions)
        except Exception as error:  # noqa: BLE001 - an installation that lacks a part: the screen's thread ends the app
            self._post(engine_messages.EngineMissing(error))
            return
        self._made.set()
        self._post(engine_messages.EngineReady())
        threading.Thread(target=self._warm_up, daemon=True, name="desire-warm-up").start()
        self._go_on()

    def _go_on(self) -> None:
        while (job := self._jobs.get()) is not None:
            self._do(job)

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
        except BaseException as error:  # noqa: BLE001 - the last line: a fault of ours must not take the work down
            self._post(
                engine_messages.EngineFault(f"{type(error).__name__}: {error}", traceback.format_exc())
            )
        finally:
            self._count(-1)
            self._post(engine_messages.EngineIdle(failed=failed))


@cache
def warm_up() -> None:
    """Compile and run a small program for nobody, frame its graph, compile loops of the other rules: once.

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
    from desire_tui.engine.codegen.compiler_state import shared_state

    shared_state().prepare_loops()
