"""A program whose script is one run: that run made again and again, each time with other values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.api.instance import Instance, LoadOptions
from desire_tui.api.settings import way_of
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.passes.replication import LockStepError
from desire_tui.engine.session.prepared_run import RunStart
from desire_tui.studies.keep import kept
from desire_tui.studies.lock_step import LockStep
from desire_tui.studies.reductions import reduce
from desire_tui.studies.settable import computed_anyway, elements_beyond, known_shapes
from desire_tui.studies.streams import first_state, stream, streams
from desire_tui.studies.task import Chunk

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.studies.keep import Kept
    from desire_tui.studies.task import Task

    Floats = NDArray[np.float64]


_GATHERED_MOST, _RUNS_MOST = 1 << 17, 256
"""Numbers, runs whose samples wait at most."""


class PreparedProgram:
    """Lives on one thread at a time. DesireError: the program does not come to a run; a name cannot vary."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.kept = kept(task.keep)
        self._names = (*task.names, *(name for name, _ in task.fixed))
        self._fixed = np.array([value for _, value in task.fixed])
        self._expressions = self.kept.expressions()
        options = LoadOptions(
            task.segment, task.answers, task.backend, task.allow_shell, task.allow_write, self._expressions
        )
        self.instance = Instance(task.source, options)
        self.way = way_of(self._names, self.instance)
        program, blocks = self.instance.prepared.script
        shapes = known_shapes(self._names, self.instance)
        problems = elements_beyond(self._names, program, blocks, shapes)
        problems += computed_anyway(task.names, self.instance)
        if problems:
            raise DesireError(*problems)
        self.lock_step: LockStep | None = None
        """Makes several runs at a time."""
        self.hindrance = "" if task.lanes else "not wanted"
        """Why there is none."""
        if task.lanes:
            try:
                self.lock_step = LockStep(
                    self.instance.prepared,
                    self.way,
                    way_of(task.names, self.instance),
                    self._expressions.names,
                    [item.kind for item in self.kept.items],
                    fast=task.fast,
                )
            except LockStepError as reason:
                self.hindrance = str(reason)

    @property
    def way_taken(self) -> str:
        """How runs are made, in words."""
        return "in lock step" if self.lock_step is not None else f"one by one ({self.hindrance})"

    @property
    def runs_together(self) -> int:
        """How many runs take hardly longer than one."""
        return 1 if self.lock_step is None else self.lock_step.width

    def settings(self, rows: Floats) -> Floats:
        """Return the values of everything that is set: what varies, then what is fixed."""
        return np.concatenate([rows, np.broadcast_to(self._fixed, (len(rows), len(self._fixed)))], axis=1)

    def first_state(self) -> int:
        """Return where the random numbers of run 0 begin."""
        return first_state(self.task.seed, int(self.instance.prepared.base.saved.random[0]))

    def chunk(self, first: int, rows: Floats, stopped: Callable[[], bool]) -> Chunk:
        """Make runs one after the other."""
        made = Chunk.empty(first, len(rows), self.kept.size)
        settings = self.settings(rows)
        alone: Sequence[int] = range(len(rows))
        if self.lock_step is not None:
            alone = self._in_lock_step(self.lock_step, made, settings, stopped)
        self._one_by_one(made, alone, settings, stopped)
        return made

    def _in_lock_step(
        self, lock_step: LockStep, made: Chunk, settings: Floats, stopped: Callable[[], bool]
    ) -> list[int]:
        """Make runs side by side; return the places of those that have to be made alone."""
        alone: list[int] = []
        first = 0
        while first < len(settings) and not stopped():
            count = min(lock_step.runs_most, len(settings) - first)
            begin = made.first + first
            random = streams(self.first_state(), begin, count) if lock_step.draws else None
            table, counts, left, numbers = lock_step.run(settings[first : first + count], random)
            there = made.numbers[first : first + count]
            if numbers is not None:
                there[:] = numbers
            elif not left.all():
                good = ~left
                some = table if good.all() else table[:, :, good]
                there[good] = reduce(self.kept.items, some[0], list(some[1:]), counts[good])
            if left.any():
                there[left] = np.nan
                alone += (first + np.flatnonzero(left)).tolist()
            first += count
        return alone

    def end(self) -> None:
        """End the run that goes on; from any thread."""
        self.instance.prepared.end()
        if self.lock_step is not None:
            self.lock_step.end()

    def _one_by_one(
        self, made: Chunk, places: Iterable[int], settings: Floats, stopped: Callable[[], bool]
    ) -> None:
        """Make the runs at some places of a chunk; what they sample is reduced for several at a time."""
        gathered = _Gathered(self.kept.items)
        for place in places:
            if stopped():
                break
            number, row = made.first + place, settings[place].tolist()
            try:
                record = self._record(number, row)
            except DesireError as error:
                problem = error.diagnostics[0]
                if made.failures.is_new(problem):
                    problem = self._explained(number, row, problem)
                made.errors[place] = made.failures.note(number, error.diagnostics[0], problem.message)
                continue
            gathered.add(place, self._columns(record))
            if gathered.is_full:
                gathered.reduce_into(made)
        gathered.reduce_into(made)

    def _explained(self, number: int, row: list[float], problem: Diagnostic) -> Diagnostic:
        """Return what a run says that failed: it is made once more, and looked at."""
        try:
            self._record(number, row, explains=True)
        except DesireError as error:
            return error.diagnostics[0]
        return problem

    def _record(self, number: int, row: list[float], *, explains: bool = False) -> RunRecord:
        instance, way = self.instance, self.way
        if way.slots is None:
            instance.override(dict(zip(self._names, row, strict=True)))
        start = RunStart(
            settings=() if way.slots is None else tuple(zip(way.slots, row, strict=True)),
            follow=way.follow,
            random=stream(self.first_state(), number),
        )
        record, error = instance.prepared.run(start, (), _NOBODY, explains=explains)
        if error is None and record.ended == "stopped":
            error = DesireError(Diagnostic("stopped-by-user", source=self.task.source))
        if error is not None:
            raise error
        return record

    def _columns(self, record: RunRecord) -> Floats:
        """Return times and what is kept at them: (samples, 1 + items)."""
        names = [column.name for column in record.columns]
        taken = [0, *(1 + names.index(name) for name in self._expressions.names)]
        return record.rows[: record.count, taken]


class _Gathered:
    """Samples of runs that wait to be reduced together."""

    def __init__(self, items: tuple[Kept, ...]) -> None:
        self._items = items
        self._places: list[int] = []
        self._samples: list[Floats] = []
        self._numbers = 0

    def add(self, place: int, samples: Floats) -> None:
        """Add a run's."""
        self._places.append(place)
        self._samples.append(samples)
        self._numbers += samples.size

    @property
    def is_full(self) -> bool:
        """Whether there are enough of them."""
        return self._numbers >= _GATHERED_MOST or len(self._places) >= _RUNS_MOST

    def reduce_into(self, made: Chunk) -> None:
        """Put what is kept of the runs into a chunk, and forget their samples."""
        if not self._places:
            return
        counts = np.array([len(samples) for samples in self._samples])
        table = np.zeros((1 + len(self._items), counts.max(), len(counts)))
        for run, samples in enumerate(self._samples):
            table[:, : len(samples), run] = samples.T
        made.numbers[self._places] = reduce(self._items, table[0], list(table[1:]), counts)
        self._places, self._samples, self._numbers = [], [], 0


class _Nobody:
    def block(self, record: RunRecord, first_row: int) -> None:
        """Look at no samples while they come."""


_NOBODY = _Nobody()
