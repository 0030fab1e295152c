"""A program whose script makes several runs, or draws random numbers: run as a whole for each run of a study.

Quantities of the model are kept of the last run that the script makes; what the script itself computes is
kept as the script leaves it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.api.instance import ELEMENTS
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.overrides import problems_of
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.parse import parse
from desire_tui.studies.keep import kept, slices
from desire_tui.studies.reductions import reduce
from desire_tui.studies.settable import elements_beyond
from desire_tui.studies.streams import first_state, stream
from desire_tui.studies.task import Chunk
from desire_tui.studies.way import of_the_script

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.studies.task import Task

    Floats = NDArray[np.float64]


class ScriptProgram:
    """Lives on one thread at a time. DesireError: a name cannot vary."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.kept = kept(task.keep)
        program = parse(task.source)
        values = dict.fromkeys((*task.names, *(name for name, _ in task.fixed)), 0.0)
        blocks = structure(program)
        problems = problems_of(program, blocks, values) or elements_beyond(values, program, blocks)
        if problems:
            raise DesireError(*problems)
        self._results = of_the_script(program, self.kept)
        self._expressions = self.kept.expressions(but=self._results)
        self._listener = _Answers()
        self._session = Session(
            self._listener,
            backend=task.backend,
            elements_most=ELEMENTS,
            permissions=Permissions(shell=task.allow_shell, files=task.allow_write),
        )
        self._session.graphs.pages_max = 1
        self._session.keep(self._expressions)
        self._session.remember_segments()

    @property
    def way_taken(self) -> str:
        """How runs are made, in words."""
        return "each by the whole script"

    @property
    def runs_together(self) -> int:
        """How many runs take hardly longer than one."""
        return 1

    def chunk(self, first: int, rows: Floats, stopped: Callable[[], bool]) -> Chunk:
        """Run the script once for each row."""
        made = Chunk.empty(first, len(rows), self.kept.size)
        for place, row in enumerate(rows.tolist()):
            if stopped():
                break
            number = first + place
            try:
                self._run(number, dict(zip(self.task.names, row, strict=True)))
                made.numbers[place] = self._reduced()
            except DesireError as error:
                made.errors[place] = made.failures.note(number, error.diagnostics[0])
        return made

    def end(self) -> None:
        """End the script that goes on; from any thread."""
        self._session.end()

    def _run(self, number: int, settings: dict[str, float]) -> None:
        session, seed = self._session, self.task.seed
        values = session.values
        values.seeding = lambda state: stream(first_state(seed, state), number)
        values.random[0] = values.seeding(0)
        session.override({**settings, **dict(self.task.fixed)})
        self._listener.answers = iter(self.task.answers)
        session.erun(self.task.source)
        while session.stopped_at is not None:
            session.go()

    def _reduced(self) -> Floats:
        made = np.full(self.kept.size, np.nan)
        items = list(slices(self.kept.items))
        sampled = [number for number in range(len(items)) if number not in self._results]
        for number, text in self._results.items():
            made[items[number][1]] = self._value(text)
        if sampled:
            record = self._record(self.kept.items[sampled[0]].label)
            rows = record.rows[: record.count]
            names = [column.name for column in record.columns]
            columns = [rows[:, 1 + names.index(name), None] for name in self._expressions.names]
            some = [items[number][0] for number in sampled]
            numbers = reduce(some, rows[:, :1], columns, np.array([len(rows)]))[0]
            for (_, place), number in zip(slices(some), sampled, strict=True):
                made[items[number][1]] = numbers[place]
        return made

    def _record(self, label: str) -> RunRecord:
        for record in reversed(self._session.runs):
            if record.count and any(c.name == self._expressions.names[0] for c in record.columns):
                return record
        raise DesireError(Diagnostic("study-no-run", None, {"text": label}, self.task.source))

    def _value(self, text: str) -> float:
        from desire_tui.engine.session.overrides import name_and_subscripts

        name, subscripts = name_and_subscripts(text)
        quantity = self._session.values.find(name)
        if quantity is None or len(quantity.shape) != len(subscripts):
            return np.nan
        array = self._session.values.view(quantity) if quantity.shape else None
        if array is None:
            return float(self._session.values.cells[quantity.slot])
        inside = all(1 <= k <= n for k, n in zip(subscripts, quantity.shape, strict=True))
        return float(array[tuple(k - 1 for k in subscripts)].real) if inside else np.nan


class _Answers(Listener):
    """Answers what scripts ask."""

    wants_check = False

    def __init__(self) -> None:
        self.answers = iter(tuple[str, ...]())

    def ask(self, prompt: str) -> str:
        """Return the next answer."""
        del prompt
        try:
            return next(self.answers)
        except StopIteration:
            raise EOFError from None
