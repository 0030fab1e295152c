"""What scripts can reach: the interpreter's host."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.integration.rules import DEFAULT_RULE
from desire_tui.engine.session.runs import Runs
from desire_tui.engine.session.status import State
from desire_tui.engine.session.type_output import TypeOutput
from desire_tui.engine.values import SCALE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.graph.pages import GraphBook
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.runtime.pause_and_stop import Control
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.values import Quantity, Values


class ScriptHost:
    """Implements `interpreter.Host` for a session. Lives on the session's thread."""

    def __init__(self, desk: Workspace, listener: Listener, control: Control, graphs: GraphBook) -> None:
        self._desk = desk
        self._listener = listener
        self._control = control
        self._graphs = graphs
        self._values: Values = desk.values
        self.runs = Runs(desk, listener, control, graphs)
        self.rule = DEFAULT_RULE
        self.state = State.IDLE
        self.stop_here: Callable[[], None] = _nothing
        self.step_allowed = False
        """The traced script may carry out the statement it stands at (`go` was given)."""
        self.runs_ahead: Callable[[], int | None] = _nothing
        """How many runs come after the one being made; None: that cannot be told."""
        self.runs_expected: int | None = None
        """How many runs there will be in all."""
        self.carry_out: Callable[[str, str | None], None] = _nothing
        self.write_to_channel: Callable[[int, str], object] = _nothing

    # ------------------------------------------------------------------ runs

    def drun(self, label: str | None, placed: Placed, *, star: bool) -> None:
        """Make one run of a segment, to its end."""
        before, self.state = self.state, State.COMPILING
        try:
            self.runs.make(label, placed, self.rule, star=star, on_start=self._run_starts)
        finally:
            self.state = before

    def _run_starts(self, record: RunRecord) -> TypeOutput:
        self.state = State.RUNNING
        ahead = self.runs_ahead()
        self.runs_expected = None if ahead is None else record.number + ahead
        return TypeOutput(record, self.write, self.write_to_channel)

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

    def reset(self) -> None:
        """Restore t, DT and states to the start of the last run."""
        self.runs.simulator.reset()

    def begin_program(self) -> None:
        """Set the display back to where a program starts."""
        self._graphs.begin_program()

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
        from desire_tui.engine.session.shell_command import run_shell

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


def _nothing(*_: object) -> None:
    return
