"""`desire run`: a program in, exit status out."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.batch.console import Console
from desire_tui.batch.ending import giving_up_files
from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.progress import Progress
from desire_tui.batch.runner import Runner, RunOptions
from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, internal_error, render_all
from desire_tui.engine.files import decoded, read_source
from desire_tui.engine.session import process_groups
from desire_tui.engine.source import Source
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.batch.output_files import OutputFiles
    from desire_tui.engine.diagnostics import Diagnostic

DONE, FAILED, LIMIT = 0, 1, 3  # 2 is wrong usage, which click reports
_EXIT = {"done": DONE, "stopped": DONE, "failed": FAILED, "limit": LIMIT}
STANDARD_INPUT = "-"


def source_named(name: str) -> Source:
    """Read a program; `-` is standard input. DesireError 38."""
    if name == STANDARD_INPUT:
        return Source(decoded(sys.stdin.buffer.read(), "<stdin>"), "<stdin>")
    return read_source(Path(name))


def run_file(
    name: str, options: RunOptions, outputs: OutputFiles, answers: str | None, *, quiet: bool, raw: bool
) -> int:
    """Run a program and write its output files; returns the exit status."""
    try:
        source = source_named(name)
        lines = _answers(answers)
    except DesireError as error:
        report(error.diagnostics)
        return FAILED
    console = Console(sys.stderr if outputs.takes_stdout else sys.stdout, quiet=quiet, raw=raw)

    def show_problems(problems: Sequence[Diagnostic]) -> None:
        console.end_line()
        report(problems)

    echo = answers is not None or not sys.stdin.isatty()
    listener = HeadlessListener(console.write, lines, show_problems, echo=echo)
    runner = Runner(source, replace(options, has_folder=source.path is not None), listener)
    if sys.stderr.isatty() and not quiet:
        console.progress = Progress(runner.session, sys.stderr)
    try:
        runner.run(console.progress)
        console.end_line()
        report(runner.problems)
        status = _EXIT[runner.status]
        known = len(runner.problems)
        with giving_up_files():
            problems = [problem.within(source) for problem in outputs.write(runner.session, runner.result)]
        report([*runner.problems[known:], *problems])
        status = _EXIT[runner.status]
        if status == DONE and any(problem.severity == "error" for problem in problems):
            status = FAILED
    except DesireError as error:
        report(error.diagnostics)
        status = FAILED
    except (OSError, KeyboardInterrupt):
        raise
    except Exception as error:  # noqa: BLE001 - a fault of ours is a message too
        report([internal_error("results were written", error)])
        status = FAILED
    if runner.session.stopped_at is not None and not quiet and runner.status == "stopped":
        place = runner.session.stopped_at
        row = place.source.position(place.placed.at).row
        sys.stderr.write(f"{visible_line(place.source.name)}:{row}: stopped at STOP; --go continues\n")
    process_groups.end_all()
    if runner.abandoned or listener.reading.is_set():
        _leave_at_once(status)
    return status


def report(problems: Sequence[Diagnostic]) -> None:
    """Write problems to standard error."""
    if problems:
        sys.stdout.flush()
        sys.stderr.write(render_all(problems) + "\n")
        sys.stderr.flush()


def _answers(name: str | None) -> Iterator[str]:
    if name in (None, STANDARD_INPUT):
        return iter(sys.stdin.readline, "")
    return iter(read_source(Path(name)).text.splitlines())


def _leave_at_once(status: int) -> None:
    """Exit although a thread still runs or waits for input: `sys.exit` would wait for it."""
    import os

    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
