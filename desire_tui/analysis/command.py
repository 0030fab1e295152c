"""An analysis from the command line: a program and a request in, tables and files out."""

from __future__ import annotations

import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from desire_tui.analysis.files import check_ending, write
from desire_tui.analysis.subject import Subject
from desire_tui.batch.cli_commands import DONE, FAILED, LIMIT, report, source_named
from desire_tui.batch.status_line import StatusLine, bar
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source

if TYPE_CHECKING:
    from types import FrameType
    from typing import IO, Self

    from desire_tui.analysis.registry import Analysis
    from desire_tui.analysis.result import Result


def analyse_file(analysis: Analysis, name: str, request: str, options: dict[str, Any]) -> int:
    """Do an analysis; returns the exit status: 0 done, 1 nothing was found, 3 stopped."""
    outputs = [Path(output) for output in options["output"]]
    watch = _Watch(sys.stderr if sys.stderr.isatty() and not options["quiet"] else None)
    try:
        for output in outputs:
            check_ending(output)
        subject = _subject(name, options)
        with watch:
            result = analysis.run(subject, request, watch)
        for output in outputs:
            write(result, output, subject.name)
    except DesireError as error:
        report(error.diagnostics)
        return FAILED
    if not options["quiet"]:
        sys.stdout.write("".join(f"{line}\n" for line in result.lines()))
    return LIMIT if result.is_partial else DONE


def _subject(name: str, options: dict[str, Any]) -> Subject:
    answers = options["answers"]
    return Subject(
        source_named(name),
        settings=options["settings"],
        segment=options["segment"],
        answers=() if answers is None else tuple(read_source(Path(answers)).text.splitlines()),
        backend=options["backend"],
        data=tuple(map(Path, options["data"])),
        allow_shell=options["allow_shell"],
        allow_write=options["allow_write"],
    )


class _Watch:
    """Shows on a terminal how far it is. Ctrl-C ends it with what is found by then, a second one at once."""

    def __init__(self, terminal: IO[str] | None) -> None:
        self._line = None if terminal is None else StatusLine(terminal)
        self._is_stopped = False
        self._before: Any = None

    def __enter__(self) -> Self:
        """Take note of Ctrl-C."""
        self._before = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the line empty."""
        signal.signal(signal.SIGINT, self._before)
        if self._line is not None:
            self._line.clear()

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self._is_stopped:
            signal.default_int_handler(number, frame)
        self._is_stopped = True

    def __call__(self, part: float | None, told: str, so_far: Result | None = None) -> bool:
        """Redraw it; see `Progress`."""
        del so_far
        if self._line is not None and self._line.is_due:
            self._line.show(told if part is None else f"{bar(part)} {told}")
        return not self._is_stopped
