"""What scripts can reach: the interpreter's host."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.integration.rules import DEFAULT_RULE
from desire_tui.engine.session.status import State
from desire_tui.engine.session.type_output import TypeOutput
from desire_tui.engine.values import SCALE

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.graph.pages import GraphPages
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.activity import Activity
    from desire_tui.engine.session.console import Console
    from desire_tui.engine.session.current_interpreter import CurrentInterpreter
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.session_commands import SessionCommands
    from desire_tui.engine.session.workspace import Workspace
    from desire_tui.engine.values import Quantity, Values


class ScriptHost:
    """Implements `interpreter.Host` for a session. Lives on the session's thread."""

    def __init__(
        self,
        workspace: Workspace,
        listener: Listener,
        console: Console,
        activity: Activity,
        runs: Runs,
        graphs: GraphPages,
        interpreter: CurrentInterpreter,
        commands: SessionCommands,
    ) -> None:
        self._workspace = workspace
        self._values: Values = workspace.values
        self._listener = listener
        self._console = console
        self._activity = activity
        self._runs = runs
        self._graphs = graphs
        self._interpreter = interpreter
        self._commands = commands
        self.rule = DEFAULT_RULE
        self.step_allowed = False
        """The traced script may carry out the statement it stands at (`go` was given)."""
        self.runs_expected: int | None = None
        """How many runs there will be in all; None: that cannot be told."""
        self.prepares: tuple[str | None] | None = None
        """The segment at whose first `drun` the script is left (`RunReached`); (None,): at any."""

    # ------------------------------------------------------------------ runs

    def drun(self, label: str | None, placed: Placed, *, star: bool) -> None:
        """Make one run of a segment, to its end."""
        if self.prepares is not None and self.prepares[0] in (None, label):
            from desire_tui.engine.session.prepared_run import RunReached

            raise RunReached(label, placed)
        ahead = self._interpreter.runs_ahead()
        with self._activity.during(State.COMPILING):
            self._runs.make(
                label, placed, self.rule, star=star, ahead=ahead, on_start=partial(self._run_starts, ahead)
            )

    def _run_starts(self, ahead: int | None, record: RunRecord) -> TypeOutput:
        self._activity.state = State.RUNNING
        self.runs_expected = None if ahead is None else record.number + ahead
        return TypeOutput(record, self._console.write, self._interpreter.write_to_channel)

    def reset(self) -> None:
        """Restore t, DT and states to the start of the last run."""
        self._runs.simulator.reset()

    def end_runs(self) -> None:
        """Tell that no runs follow for now."""
        if (changed := self._graphs.end_runs()) is not None:
            self._listener.graph_changed(changed)

    def begin_program(self) -> None:
        """Set the display back to where a program starts."""
        self._graphs.begin_program(self._workspace.source.file_name)

    # ------------------------------------------------------------------ console

    def write(self, text: str) -> None:
        """Console output."""
        self._console.write(text)

    def ask(self, prompt: str) -> str:
        """Console input."""
        with self._activity.during(State.ASKING):
            return self._listener.ask(prompt)

    def note(self, text: str) -> None:
        """Append to the notebook."""
        self._workspace.notebook.note(text)
        self._listener.noted(text)

    def warn(self, problem: DesireError) -> None:
        """Show a problem without stopping."""
        self._listener.problems(problem.diagnostics)

    # ------------------------------------------------------------------ graphs

    def display(self, mode: str, args: Sequence[float]) -> None:
        """Carry out a `display` statement."""
        changed = self._graphs.display(mode, args, self._scale, at_once=self._workspace.command is not None)
        if changed and self._graphs.current is not None:
            self._listener.graph_changed(self._graphs.current)

    def name_graph(self, part: str, text: str) -> None:
        """Give graphs a `title`, `xlabel` or `ylabel`."""
        if self._graphs.name(part, text, at_once=self._workspace.command is not None):
            assert self._graphs.current is not None
            self._listener.graph_changed(self._graphs.current)

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
        self._graphs.show(quantity.name, values, width, self._scale, by_size=self._graphs.settings.by_size)
        assert self._graphs.current is not None
        self._listener.graph_changed(self._graphs.current)

    def show_area(self, *, by_size: bool) -> None:
        """Let the pictures to come show size or colour."""
        self._graphs.settings.by_size = by_size

    @property
    def _scale(self) -> float:
        return abs(self._values.cells[SCALE]) or 1.0

    # ------------------------------------------------------------------ the machine

    def shell(self, command: str) -> None:
        """Run a shell command, its output to the console, and its status if it fails; Ctrl-C ends it."""
        from desire_tui.engine.session.shell_command import run_shell

        self._workspace.permissions.shell_command(command, self._workspace.asker, self._listener.permit)
        status = run_shell(command, self._workspace.folder, self.write, lambda: self._activity.ending)
        if status:
            self.write(f"the shell command `{command}` ended with status {status}\n")

    def permit(self, path: Path, mode: Literal["read", "write"]) -> Path:
        """Return the resolved path if the program may open it."""
        return self._workspace.permit(path, mode, self._listener.permit)

    def command(self, word: str, argument: str | None) -> None:
        """Carry out a command that is no statement."""
        self._commands.carry_out(word, argument)

    def before(self, placed: Placed) -> None:
        """Stop a traced script as at a STOP, but at a statement that `go` has just allowed."""
        del placed
        if self._workspace.command is None and not self.step_allowed:
            self._interpreter.stop_here()
        self.step_allowed = False

    def interrupted(self) -> bool:
        """Whether the script is to end; waits while paused."""
        return self._activity.interrupted()
