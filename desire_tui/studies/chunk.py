"""Some runs of a study as a function of its arguments alone: what threads and clusters carry out."""

from __future__ import annotations

from collections import OrderedDict
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING

from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.parse import parse
from desire_tui.studies.keep import kept
from desire_tui.studies.prepared_program import PreparedProgram
from desire_tui.studies.script_program import ScriptProgram
from desire_tui.studies.way import is_one_run

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.studies.task import Chunk, Task

    StudyProgram = PreparedProgram | ScriptProgram

_TASKS_MOST = 4
"""Of so many studies a process keeps compiled programs."""


def run_chunk(
    task: Task, first: int, rows: NDArray[np.float64], stopped: Callable[[], bool] = lambda: False
) -> Chunk:
    """Make the runs `first`, `first` + 1, … with the values in `rows`, (runs, names): what is kept of each.

    A run that fails is a hole with its error's number. DesireError: none of them can be made.
    """
    with _PROGRAMS.one(task) as program:
        return program.chunk(first, rows, stopped)


def program_of(task: Task) -> StudyProgram:
    """Return a program made ready. DesireError: it cannot run, a name cannot vary."""
    parsed = parse(task.source)
    if is_one_run(parsed, structure(parsed), kept(task.keep)):
        return PreparedProgram(task)
    return ScriptProgram(task)


class _Programs:
    """Programs made ready, for each study and thread; who takes one has it alone."""

    def __init__(self) -> None:
        self._idle: OrderedDict[Task, list[StudyProgram]] = OrderedDict()
        self._busy: list[tuple[Task, StudyProgram]] = []
        self._lock = Lock()

    @contextmanager
    def one(self, task: Task) -> Iterator[StudyProgram]:
        """Lend a program, the one that was given back last."""
        with self._lock:
            idle = self._idle.setdefault(task, [])
            self._idle.move_to_end(task)
            while len(self._idle) > _TASKS_MOST:
                self._idle.popitem(last=False)
            program = idle.pop() if idle else None
        if program is None:
            program = program_of(task)
        with self._lock:
            self._busy.append((task, program))
        try:
            yield program
        finally:
            with self._lock:
                self._busy.remove((task, program))
                idle.append(program)

    def end(self, task: Task) -> None:
        """End the runs of a study that go on now; from any thread."""
        with self._lock:
            busy = [program for own, program in self._busy if own is task]
        for program in busy:
            program.end()


_PROGRAMS = _Programs()


def prepare(task: Task) -> str:
    """Make a program ready and keep it for `run_chunk`; say in words how its runs are made. DesireError."""
    with _PROGRAMS.one(task) as program:
        return program.way_taken


def runs_together(task: Task) -> int:
    """Return how many runs take hardly longer than one: those that lanes of vector code make side by side."""
    with _PROGRAMS.one(task) as program:
        return program.runs_together


def end_runs(task: Task) -> None:
    """End the runs of a study that go on in this process; from any thread."""
    _PROGRAMS.end(task)
