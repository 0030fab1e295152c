"""What scripts can reach: the interpreter's host."""

from __future__ import annotations

from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.runtime.record import RunRecord
from desire_tui.engine.runtime.run import Simulator
from desire_tui.engine.runtime.stash import write_stash
from desire_tui.engine.session.lister import Lister
from desire_tui.engine.session.starting import NUMBERS_MOST, Situation
from desire_tui.engine.session.status import State
from desire_tui.engine.values import SCALE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from desire_tui.engine.graph import Graph, GraphBook
    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.nodes import Placed
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.control import Control
    from desire_tui.engine.session.desk import Desk
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.values import Quantity, Values

RUNS_BYTES_MAX = 1 << 30
"""Samples of all runs kept; the oldest go first."""
THINNED_ROWS = 10_000
"""Samples left of those, for the graphs that show them."""


class World:
    """Implements `interpreter.Host` for a session. Lives on the session's thread."""

    def __init__(self, desk: Desk, listener: Listener, control: Control, graphs: GraphBook) -> None:
        self._desk = desk
        self._listener = listener
        self._control = control
        self._graphs = graphs
        self._values: Values = desk.values
        self.simulator = Simulator(desk.values, control)
        self.rule = 1
        self.state = State.IDLE
        self.runs: list[RunRecord] = []
        self.runs_made = 0
        self._runs_bytes = 0  # of all but the newest
        self.start: Situation | None = None
        """Where the last run began, unless the model is large."""
        self.run_of: tuple[str, int] | None = None
        """The last run's program text, and `Values.generation` then."""
        self.stop_here: Callable[[], None] = _nothing
        self.step_allowed = False
        """The traced script may carry out the statement it stands at (`go` was given)."""
        self.carry_out: Callable[[str, str | None], None] = _nothing
        self.write_to_channel: Callable[[int, str], object] = _nothing

    # ------------------------------------------------------------------ runs

    def drun(self, label: str | None, placed: Placed, *, star: bool) -> None:
        """Make one run of a segment, to its end."""
        before, self.state = self.state, State.COMPILING
        try:
            self._run(label, placed, star=star)
        finally:
            self.state = before

    def _run(self, label: str | None, placed: Placed, *, star: bool) -> None:
        desk, began = self._desk, perf_counter()
        program, structure = desk.runnable()
        try:
            segment = desk.segments.lowered(program, structure, label, self.rule)
        except DesireError as error:
            raise _placed_at(error, desk, placed) from None
        if segment.recover:
            segment = desk.segments.recovering(segment, desk.stash_path)
        start = self._situation()
        plan = self.simulator.defaults.plan(segment, self.rule, desk.source_of(placed), placed.span())
        model = desk.segments.model(segment, plan.rule)
        self._advise(model)
        self.start, self.run_of = start, (program.source.text, self._values.generation)
        self.runs_made += 1
        record = RunRecord(
            number=self.runs_made, segment=label, line=desk.line_of(placed), requests=segment.requests,
            columns=segment.columns, overlay=self._graphs.settings.mode == 2, rule=plan.rule,
            scale=plan.scale, t0=plan.t0, t_max=plan.t_max, nn=plan.nn, dt=plan.dt, error_max=plan.tolerance,
            compile_seconds=perf_counter() - began,
        )  # fmt: skip
        self._keep(record)
        graph = self._graphs.begin_run(record, segment.pictures)
        lister = Lister(record, self.write, self.write_to_channel)
        self.state = State.RUNNING
        self._listener.run_started(record)
        if graph is not None:
            self._listener.graph_changed(graph)
        try:
            finished = self.simulator.run(model, segment, plan, record, lister)
        except DesireError as error:
            record.ended = "failed"
            record.message = record.message or error.diagnostics[0].message
            raise _placed_at(error, desk, placed) from None
        finally:
            desk.journal.run_ended(record, desk.overrides)
            self._listener.run_ended(record)
        if not finished:
            raise Interrupted
        if segment.stash and not star:
            self._stash(segment, record)

    def _situation(self) -> Situation | None:
        values = self._values
        return Situation.now(values, self.simulator) if values.numbers_used <= NUMBERS_MOST else None

    def _advise(self, model: Model) -> None:
        """Show what a model has to say before its first run (rules 9 … 16)."""
        advice = getattr(model, "advice", None)
        problems = advice() if advice is not None else ()
        if problems:
            self._listener.problems(problems)

    def _stash(self, segment: Segment, record: RunRecord) -> None:
        first = 1 + len(record.columns) - len(segment.stash)
        write_stash(self._desk.stash_path, record.rows[: record.count, first:])

    def _keep(self, record: RunRecord) -> None:
        if self.runs:
            self._runs_bytes += self.runs[-1].rows.nbytes
        self.runs.append(record)
        while self._runs_bytes > RUNS_BYTES_MAX:
            oldest = self.runs.pop(0)
            self._runs_bytes -= oldest.rows.nbytes
            oldest.thin(THINNED_ROWS)  # pages may show it still

    def begin_program(self) -> None:
        """Set the display back to where a program starts."""
        self._graphs.begin_program()

    def forget_runs(self) -> None:
        """Begin a program: its runs count from 1."""
        self.runs.clear()
        self.start = self.run_of = None
        self.runs_made = self._runs_bytes = 0

    def reset(self) -> None:
        """Restore t, DT and states to the start of the last run."""
        self.simulator.reset()

    @contextmanager
    def working(self) -> Iterator[None]:
        """Frame of a command that makes a run: it may be paused and ended."""
        self._control.begin()
        before, self.state = self.state, State.RUNNING
        try:
            yield
        finally:
            self.state = before
            self._control.done()

    @contextmanager
    def restored(self) -> Iterator[None]:
        """Put everything that a run could change back afterwards."""
        before = Situation.now(self._values, self.simulator)
        try:
            yield
        finally:
            before.put_back(self._values, self.simulator)

    def go_back(self) -> None:
        """Go to where the last run began: everything as it was, or (large models) t, DT and states only."""
        if self.start is not None:
            self.start.put_back(self._values, self.simulator)
        else:
            self.simulator.reset()

    # ------------------------------------------------------------------ console

    def write(self, text: str) -> None:
        """Console output."""
        self._desk.journal.output(text)
        self._listener.console_text(text)

    def ask(self, prompt: str) -> str:
        """Console input."""
        before, self.state = self.state, State.ASKING
        try:
            return self._listener.ask(prompt)
        finally:
            self.state = before

    def note(self, text: str) -> None:
        """Append to the notebook."""
        self._desk.journal.note(text)
        self._listener.noted(text)

    def warn(self, problem: DesireError) -> None:
        """Show a problem without stopping."""
        self._listener.problems(problem.diagnostics)

    # ------------------------------------------------------------------ graphs

    def display(self, mode: str, args: Sequence[float]) -> None:
        """Carry out a `display` statement."""
        changed = self._graphs.display(mode, args, self._scale)
        if changed and self._graphs.current is not None:
            self._listener.graph_changed(self._graphs.current)

    def graph_changed(self, graph: Graph) -> None:
        """Have a page drawn."""
        self._listener.graph_changed(graph)

    def plot(self, x: float, y: float, color: int | None) -> None:
        """Draw one point."""
        before = self._graphs.current
        self._graphs.plot(x, y, color, self._scale)
        if self._graphs.current is not before:
            assert self._graphs.current is not None
            self._listener.graph_changed(self._graphs.current)

    def show(self, quantity: Quantity, columns: int) -> None:
        """Show an array as a picture."""
        values = np.array(self._values.view(quantity).real, dtype=np.float64).ravel()
        width = columns if columns > 0 else (quantity.shape[-1] if quantity.shape else 1)
        self._graphs.show(quantity.name, values, width, self._scale)
        assert self._graphs.current is not None
        self._listener.graph_changed(self._graphs.current)

    @property
    def _scale(self) -> float:
        return abs(self._values.cells[SCALE]) or 1.0

    # ------------------------------------------------------------------ the machine

    def shell(self, command: str) -> None:
        """Run a shell command, its output to the console; Ctrl-C ends it."""
        from desire_tui.engine.session.shell import run_shell

        self._desk.permissions.shell_command(command, self._listener.permit)
        run_shell(command, self._desk.folder, self.write, lambda: self._control.ending)

    def permit(self, path: Path, mode: Literal["read", "write"]) -> Path:
        """Return the resolved path if the program may open it."""
        return self._desk.permissions.file(path, mode, self._desk.folder, self._listener.permit)

    def command(self, word: str, argument: str | None) -> None:
        """Carry out a command that is no statement."""
        self.carry_out(word, argument)

    def before(self, placed: Placed) -> None:
        """Stop a traced script as at a STOP, but at a statement that `go` has just allowed."""
        del placed
        if self._desk.command is None and not self.step_allowed:
            self.stop_here()
        self.step_allowed = False

    def interrupted(self) -> bool:
        """Whether the script is to end; waits while paused."""
        if self._control.paused:
            before, self.state = self.state, State.PAUSED
            self._control.wait()
            self.state = before
        return self._control.ending


def _placed_at(error: DesireError, desk: Desk, placed: Placed) -> DesireError:
    """Place problems that have no place of their own at the drun."""
    source = desk.source_of(placed)
    return DesireError(
        *(
            d
            if d.span is not None
            else Diagnostic(d.key, placed.span(), d.facts, source, d.severity, d.related)
            for d in error.diagnostics
        )
    )


def _nothing(*_: object) -> None:
    return
