"""`desire run` and `desire check`: files in, exit status out."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import IO, TYPE_CHECKING

from desire_tui.batch.headless_listener import BatchListener
from desire_tui.batch.progress import Progress
from desire_tui.batch.runner import RunOptions, Work
from desire_tui.engine.diagnostics import DesireError, render_all
from desire_tui.engine.files import decoded, read_source
from desire_tui.engine.interpreter import interruptible
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.batch.output_files import OutputFiles
    from desire_tui.engine.diagnostics import Diagnostic

DONE, FAILED, LIMIT = 0, 1, 3  # 2 is wrong usage, which click tells
_EXIT = {"done": DONE, "stopped": DONE, "failed": FAILED, "limit": LIMIT}
_STANDARD_INPUT = "-"


def source_named(name: str) -> Source:
    """Read a program; `-` is standard input. DesireError 38."""
    if name == _STANDARD_INPUT:
        return Source(decoded(sys.stdin.buffer.read(), "<stdin>"), "<stdin>")
    return read_source(Path(name))


def check_files(names: Sequence[str]) -> int:
    """Report the problems of programs on standard error; 1 if any is an error or cannot be read."""
    from desire_tui.engine.session.session import Session

    session, status = Session(), DONE
    for name in names:
        try:
            problems = session.check(source_named(name))
        except DesireError as error:
            complain(error.diagnostics)
            status = FAILED
            continue
        complain(problems)
        if any(p.severity == "error" for p in problems):
            status = FAILED
    return status


def run_file(name: str, orders: RunOptions, wanted: OutputFiles, answers: str | None, *, quiet: bool) -> int:
    """Run a program and write what was asked for; returns the exit status."""
    try:
        source = source_named(name)
        lines = _answers(answers)
    except DesireError as error:
        complain(error.diagnostics)
        return FAILED
    console = _Console(sys.stderr if wanted.takes_stdout else sys.stdout, quiet=quiet)

    def show_problems(problems: Sequence[Diagnostic]) -> None:
        console.settle()
        complain(problems)

    echo = answers is not None or not sys.stdin.isatty()
    listener = BatchListener(console.write, lines, show_problems, echo=echo)
    work = Work(source, orders, listener)
    if sys.stderr.isatty() and not quiet:
        console.progress = Progress(work.session, sys.stderr)
    try:
        work.run(console.progress)
        console.settle()
        complain(work.problems)
        status = _EXIT[work.status]
        wanted.write(work.session, work.result)
    except DesireError as error:
        complain(error.diagnostics)
        status = FAILED
    if work.session.stopped_at is not None and not quiet and work.status == "stopped":
        place = work.session.stopped_at
        row = place.source.position(place.placed.at).row
        sys.stderr.write(f"{place.source.name}:{row}: stopped at STOP; --go continues\n")
    if work.abandoned or listener.reading.is_set():
        _leave_at_once(status)
    interruptible.leave_at_once(status)
    return status


def complain(problems: Sequence[Diagnostic]) -> None:
    """Write problems to standard error."""
    if problems:
        sys.stdout.flush()
        sys.stderr.write(render_all(problems) + "\n")
        sys.stderr.flush()


def _answers(name: str | None) -> Iterator[str]:
    if name in (None, _STANDARD_INPUT):
        return iter(sys.stdin.readline, "")
    return iter(read_source(Path(name)).text.splitlines())


def _leave_at_once(status: int) -> None:
    """Exit although a thread still runs or waits for input: the ordinary way would wait for it."""
    import os

    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


class _Console:
    """Console text on its way out; the progress line gives way to it."""

    def __init__(self, stream: IO[str], *, quiet: bool) -> None:
        self._stream, self._quiet = stream, quiet
        self._at_line_start = True
        self.progress: Progress | None = None

    def write(self, text: str) -> None:
        if self._quiet or not text:
            return
        if self.progress is not None:
            self.progress.clear()
        self._stream.write(text)
        self._stream.flush()
        self._at_line_start = text.endswith("\n")

    def settle(self) -> None:
        """End an open line, so that a message starts its own."""
        if self.progress is not None:
            self.progress.clear()
        if not self._at_line_start:
            self.write("\n")
