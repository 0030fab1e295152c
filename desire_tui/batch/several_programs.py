"""`desire run A.src B.src … -j N`: each program in a process of its own, what they say in their order.

The processes are forked from one that has imported everything (multiprocessing's fork server), so that a
program costs no start of its own. The first program that has not ended is heard as it speaks, the others
when their turn comes.
"""

from __future__ import annotations

import multiprocessing
import os
import selectors
import shutil
import signal
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from desire_tui.batch.cli_commands import DONE, FAILED, LIMIT, report, run_file
from desire_tui.batch.output_names import named_for
from desire_tui.batch.program_voice import Voice
from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import internal_error
from desire_tui.engine.thread_count import runs_at_once
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

    from desire_tui.batch.output_files import OutputFiles
    from desire_tui.batch.runner import RunOptions

_PIECE = 65536  # bytes read at once
_ENDING_SECONDS = 5.0
"""How long programs may take to end after Ctrl-C; a run's own limit is shorter."""
_IMPORTED = (
    "desire_tui.batch.several_programs", "desire_tui.engine.session.session",
    "desire_tui.engine.codegen.backend", "desire_tui.engine.codegen.jit.compiler",
)  # fmt: skip


@dataclass(frozen=True)
class HowToRun:
    """What all programs have in common."""

    options: RunOptions
    outputs: OutputFiles
    answers: str | None
    quiet: bool
    raw: bool
    at_once: int = 1
    """Programs that run side by side."""


@dataclass
class _Program:
    """One program: its process, the ends of its pipes that are open, what it said and nobody heard yet."""

    process: BaseProcess
    pipes: dict[int, bool]
    """Descriptors; True: standard error."""
    unheard: list[tuple[bool, bytes]] = field(default_factory=list)
    has_ended: bool = False


def run_files(programs: Sequence[str], how: HowToRun, jobs: int) -> int:
    """Run programs, `jobs` at once; return the exit status: 1 if one failed, else 3 if one met a limit.

    Standard input is nobody's: `input` reads the file of answers, or finds no more lines.
    """
    pool = _Pool(programs, how, jobs)
    with _ending_with_us(pool):
        try:
            statuses = pool.run()
        except KeyboardInterrupt:
            pool.end()
            raise
    words = (("failed", {FAILED}), ("stopped by a limit or Ctrl-C", {LIMIT}))
    told = []
    for word, which in words:
        names = [
            visible_line(name) for name, status in zip(programs, statuses, strict=True) if status in which
        ]
        told += [f"{len(names)} {word} ({', '.join(names)})"] if names else []
    if told:
        sys.stderr.write(f"{len(programs)} programs: {'; '.join(told)}\n")
    return FAILED if FAILED in statuses else max(statuses, default=DONE)


class _Pool:
    def __init__(self, programs: Sequence[str], how: HowToRun, jobs: int) -> None:
        self._names, self._how, self._jobs = programs, how, max(jobs, 1)
        self._programs: list[_Program] = []
        self._selector = selectors.DefaultSelector()
        self._voice = Voice(headings=not how.quiet, raw=how.raw)
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload(list(_IMPORTED))

    def run(self) -> list[int]:
        """Run all; return their exit statuses in order."""
        heard = 0
        while heard < len(self._names):
            while len(self._programs) < len(self._names) and self._running() < self._jobs:
                self._start(self._names[len(self._programs)])
            self._listen()
            while heard < len(self._programs):
                program = self._programs[heard]
                for is_error, data in program.unheard:
                    self._voice.say(self._names[heard], data, is_error=is_error)
                program.unheard.clear()
                if not program.has_ended:
                    break
                heard += 1
        return [self._status(number) for number in range(len(self._names))]

    def end(self) -> None:
        """End every process: they are asked first, which Ctrl-C in a terminal has done already."""
        for ask in (signal.SIGINT, signal.SIGKILL):
            alive = [program.process for program in self._programs if program.process.is_alive()]
            for process in alive:
                if process.pid is not None:
                    os.kill(process.pid, ask)
            for process in alive:
                process.join(_ENDING_SECONDS / max(len(alive), 1))

    def _running(self) -> int:
        return sum(not program.has_ended for program in self._programs)

    def _start(self, name: str) -> None:
        readers, writers = zip(*(self._context.Pipe(duplex=False) for _ in range(2)), strict=True)
        how = HowToRun(
            self._how.options,
            named_for(self._how.outputs, name),
            self._how.answers,
            self._how.quiet,
            self._how.raw,
            min(self._jobs, len(self._names)),
        )
        terminal = tuple(shutil.get_terminal_size()) if sys.stdout.isatty() else None
        process = self._context.Process(target=_run_here, args=(name, how, *writers, terminal), daemon=True)
        with _only_our_folders():
            process.start()
        for writer in writers:
            writer.close()
        pipes = {
            os.dup(reader.fileno()): is_error for reader, is_error in zip(readers, (False, True), strict=True)
        }
        for reader in readers:
            reader.close()
        program = _Program(process, pipes)
        self._programs.append(program)
        for descriptor in (*pipes, process.sentinel):
            self._selector.register(descriptor, selectors.EVENT_READ, program)

    def _listen(self) -> None:
        """Wait for something that a program says, or for its end; what it said before that is read first."""
        for key, _ in self._selector.select():
            program, descriptor = key.data, key.fd
            if descriptor != program.process.sentinel:
                self._read(program, descriptor)
                continue
            for pipe in list(program.pipes):  # a process that it left behind may keep them open for ever
                os.set_blocking(pipe, False)
                while pipe in program.pipes and self._read(program, pipe):
                    pass
                self._close(program, pipe)
            self._selector.unregister(descriptor)
            program.process.join()
            program.has_ended = True

    def _read(self, program: _Program, pipe: int) -> bool:
        if pipe not in program.pipes:
            return False
        try:
            data = os.read(pipe, _PIECE)
        except BlockingIOError:
            return False
        if data:
            program.unheard.append((program.pipes[pipe], data))
        else:
            self._close(program, pipe)
        return bool(data)

    def _close(self, program: _Program, pipe: int) -> None:
        if program.pipes.pop(pipe, None) is not None:
            self._selector.unregister(pipe)
            os.close(pipe)

    def _status(self, number: int) -> int:
        status = self._programs[number].process.exitcode
        if status is not None and status >= 0:
            return status
        what = f"its process was ended by signal {-(status or 0)}"
        report([internal_error(f"{self._names[number]} ran", RuntimeError(what))])
        return FAILED


def _run_here(
    name: str, how: HowToRun, out: Connection, err: Connection, terminal: tuple[int, int] | None
) -> None:
    """Run a program in this process, its output into pipes; ends the process."""
    for number, pipe in ((1, out), (2, err)):
        os.dup2(pipe.fileno(), number)
        pipe.close()
    if terminal is not None:
        os.environ["COLUMNS"], os.environ["LINES"] = map(str, terminal)
    with runs_at_once(how.at_once):
        sys.exit(run_file(name, how.options, how.outputs, how.answers, quiet=how.quiet, raw=how.raw))


@contextmanager
def _only_our_folders() -> Iterator[None]:
    """Start Python without the current folder in its path: a program's `numpy.py` is not ours."""
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["PYTHONSAFEPATH"]
        else:
            os.environ["PYTHONSAFEPATH"] = before


@contextmanager
def _ending_with_us(pool: _Pool) -> Iterator[None]:
    """Leave no process behind when we are told to end."""

    def leave(number: int, _: Any) -> None:
        pool.end()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    before = {
        number: signal.signal(number, leave)
        for number in (signal.SIGTERM, signal.SIGHUP)
        if signal.getsignal(number) != signal.SIG_IGN
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
