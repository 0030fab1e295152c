"""Runs one program on a thread of its own, so that Ctrl-C and time limits take effect at once."""

from __future__ import annotations

import os
import signal
import threading
from contextlib import contextmanager
from math import inf
from time import monotonic
from typing import TYPE_CHECKING, Any

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import DesireError, Diagnostic, internal_error
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.process_groups import end_all
from desire_tui.engine.session.session import Session
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from desire_tui.batch.headless_listener import HeadlessListener
    from desire_tui.engine.outputs.results import Result, StatusWord
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.session import BackendName
    from desire_tui.engine.source import Source

POLL_SECONDS = 0.1
ENDING_SECONDS = 2.0
"""How long a program may take to end."""
PAGES_MAX = 10_000
_USER_ENDED = 301


@dataclass(frozen=True)
class RunOptions:
    """How to run a program."""

    settings: Mapping[str, float] = field(default_factory=dict)
    answer_stops: bool = False
    timeout: float | None = None
    backend: BackendName = "native"
    folder: Path | None = None
    allow_shell: bool = False
    allow_write: bool = False
    has_folder: bool = True
    """False: the program came through a pipe."""


def _leave(number: int, _: object) -> None:
    """End what `sh` started, then do what the signal does without a handler."""
    end_all()
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


class Runner:
    """Runs one program. `status`, `problems` and `result()` say how it went, whatever happened."""

    def __init__(self, source: Source, options: RunOptions, listener: HeadlessListener) -> None:
        self._source, self._options, self._listener = source, options, listener
        permissions = Permissions(
            shell=options.allow_shell, files=options.allow_write, has_folder=options.has_folder
        )
        self.session = Session(
            listener, backend=options.backend, folder=options.folder, permissions=permissions
        )
        self.session.graphs.pages_max = PAGES_MAX
        self.session.override(options.settings)
        self.problems: list[Diagnostic] = []
        self.status: StatusWord = "done"
        self._crash: BaseException | None = None
        self._interrupted = threading.Event()
        self.interrupted = False
        """Ctrl-C ended the program."""
        self.abandoned = False
        """The program did not end when asked to; its thread still runs."""

    @property
    def was_interrupted(self) -> bool:
        """Whether Ctrl-C was pressed while it ran, even if the program ended by itself."""
        return self._interrupted.is_set()

    def run(self, watch: Callable[[], None] | None = None) -> None:
        """Run the program, calling `watch` now and then; Ctrl-C in the main thread ends it."""
        thread = threading.Thread(target=self._run_script, name="desire-batch", daemon=True)
        began = monotonic()
        limit = inf if self._options.timeout is None else began + self._options.timeout
        with self._interrupts():
            thread.start()
            while thread.is_alive():
                thread.join(POLL_SECONDS)
                if watch is not None:
                    watch()
                if self._interrupted.is_set():
                    self.interrupted = True
                    self._end(thread, "stopped-by-user")
                    break
                if monotonic() > limit and thread.is_alive():
                    self._end(thread, "time-limit", seconds=self._options.timeout)
                    break

        if self._crash is not None:
            raise self._crash

    @contextmanager
    def _interrupts(self) -> Iterator[None]:
        """Take Ctrl-C as a request, not as an exception in the middle of something."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        handlers: dict[int, Any] = {signal.SIGTERM: _leave, signal.SIGHUP: _leave}
        handlers[signal.SIGINT] = lambda *_: self._interrupted.set()
        before = {
            number: signal.signal(number, handler)
            for number, handler in handlers.items()
            if signal.getsignal(number) != signal.SIG_IGN  # `nohup`; a shell's jobs in the background
        }
        try:
            yield
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def _end(self, thread: threading.Thread, key: str, **facts: object) -> None:
        """Ask the program to end until it does; one that waits for input is left alone."""
        deadline = monotonic() + ENDING_SECONDS
        while thread.is_alive() and monotonic() < deadline and not self._listener.reading.is_set():
            self.session.end()
            thread.join(POLL_SECONDS)
        self.abandoned = thread.is_alive()
        self.status = "limit"
        self.problems = [p for p in self.problems if p.code != _USER_ENDED]
        self.problems.append(Diagnostic(key, facts=facts, source=self._source))

    def _run_script(self) -> None:
        session = self.session
        try:
            self._check_settings()
            session.erun(self._source)
            while session.stopped_at is not None and self._options.answer_stops:
                session.go()
            if session.stopped_at is not None:
                self.status = "stopped"
            if session.faulty:
                facts = {"count": len(session.faulty)}
                note = Diagnostic("errors-not-reached", None, facts, self._source, "warning")
                self._listener.problems((note,))
        except DesireError as error:
            self.problems.extend(error.diagnostics)
            ended = any(d.code == _USER_ENDED for d in error.diagnostics)
            self.status = "limit" if ended or self.status == "limit" else "failed"
        except Exception as error:  # noqa: BLE001 - a fault of ours is a result too
            if error is self._listener.lost:  # the reader of the output has left
                self._crash = error
            else:
                self.failed("the program ran", error)
        except BaseException as error:  # noqa: BLE001 - Ctrl-C while modules are loaded: raised on the main thread
            self._crash = error

    def failed(self, what: str, error: BaseException) -> None:
        """Note a fault of ours as a problem."""
        self.problems.append(internal_error(what, error))
        self.status = "failed"

    def _check_settings(self) -> None:
        """DesireError 409: settings of names that the program does not have."""
        if not self._options.settings:
            return
        from desire_tui.engine.session.overrides import problems_of
        from desire_tui.engine.structure.structure import structure
        from desire_tui.engine.syntax.parse import parse

        program = parse(self._source)
        problems = problems_of(program, structure(program), self._options.settings)
        if problems:
            raise DesireError(*problems)

    def result(self) -> Result:
        """Return everything the program produced so far; without the data if they cannot be gathered."""
        session = self.session
        try:
            produced = produced_by(session, list(session.runs))
        except DesireError as error:
            self.problems.extend(error.diagnostics)
            self.status, produced = "failed", {}
        except Exception as error:  # noqa: BLE001 - what the program said must not be lost for it
            self.failed("results were gathered", error)
            produced = {}
        return result_of(self._source, self.status, self._listener, self.problems, produced)


def produced_by(session: Session, runs: Sequence[RunRecord]) -> dict[str, Any]:
    """Return what a session holds, as the fields of a `Result`. DesireError 40: it would fill the memory."""
    from desire_tui.engine.outputs import results

    return {
        "runs": tuple(results.run_data(record) for record in runs),
        "plots": results.plot_points(session.graphs),
        "quantities": results.final_quantities(session.values),
        "timings": results.timings(session.parse_seconds, runs),
    }


def result_of(
    source: Source,
    status: StatusWord,
    listener: HeadlessListener,
    problems: Sequence[Diagnostic],
    produced: dict[str, Any],
) -> Result:
    """Return everything together."""
    from desire_tui.engine.outputs import results

    errors = [problem for problem in problems if problem.severity == "error"]
    return results.Result(
        desire=__version__, program=source.name, status=status,
        problems=tuple(results.problem_data(p) for p in [*listener.warnings, *problems]),
        console=listener.console, **produced, error=DesireError(*errors) if errors else None,
    )  # fmt: skip
