"""The active program's script: run from the top, stopped, continued; and command lines over its names."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.listener import StoppedAt
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from desire_tui.engine.values import SCALE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from desire_tui.engine.interpreter.interpreter import Interpreter
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.session.activity import Activity
    from desire_tui.engine.session.current_interpreter import CurrentInterpreter
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.runs import Runs
    from desire_tui.engine.session.script_host import ScriptHost
    from desire_tui.engine.session.workspace import Workspace


class ScriptRunner:
    """Makes the interpreter and drives it. Everything here runs on the session's thread."""

    def __init__(
        self,
        workspace: Workspace,
        listener: Listener,
        activity: Activity,
        runs: Runs,
        current: CurrentInterpreter,
        host: ScriptHost,
    ) -> None:
        self._workspace = workspace
        self._listener = listener
        self._activity = activity
        self._runs = runs
        self._current = current
        self._host = host
        self._states_of: tuple[Program, tuple[str, ...]] | None = None
        self.stopped: StoppedAt | None = None
        """Where it came to a STOP."""
        self.edited = False
        """The program was changed since: `go` is refused."""

    def forget(self) -> None:
        """Drop the interpreter and all names; the files that the script connected are closed."""
        self._drop()
        self.stopped, self.edited = None, False
        self._clear()

    def run(self, scale: float) -> None:
        """Clear all names and run from the top. DesireError 215: there is no program; or its problems."""
        program, _ = self._workspace.runnable()
        tracing = self._current.interpreter is not None and self._current.interpreter.stepping
        self.forget()
        self._workspace.values.assign(SCALE, scale)
        self._runs.forget()
        self._workspace.notebook.program(program.source)
        with self.working(program.source):
            interpreter = self._ready()
            interpreter.stepping = tracing
            interpreter.run()
        self._note_stop()

    def go(self) -> None:
        """Continue after STOP; error 43."""
        if self._current.interpreter is None or self.stopped is None:
            raise DesireError(Diagnostic("go-without-stop"))
        if self.edited:
            raise DesireError(Diagnostic("go-after-edit"))
        self.stopped = None
        self._host.step_allowed = self._current.interpreter.stepping
        with self.working(self._workspace.source):
            self._current.interpreter.go()
        self._note_stop()

    def set_breakpoints(self, lines: frozenset[int]) -> None:
        """Stop before these lines of the active program from now on; from any thread."""
        self._workspace.breakpoints = lines
        if (interpreter := self._current.interpreter) is not None:
            interpreter.halt_at(lines)

    def interpret(self, statements: list[Placed], source: Source) -> None:
        """Carry out statements of a command line."""
        if not statements:
            return
        before, self._workspace.command = self._workspace.command, source
        try:
            with self.working(source):
                self._ready().execute(tuple(statements), source)
        finally:
            self._workspace.command = before

    def repeated(self, assignments: Sequence[Placed]) -> Callable[[], None]:
        """Return what makes some of the script's assignments once more. It raises DesireError."""
        return self._ready().repeated(assignments)

    def _clear(self) -> None:
        workspace, values = self._workspace, self._workspace.values
        values.clear()
        self._host.begin_program()
        if workspace.program is not None:
            for name in self._states(workspace.program if workspace.own is None else workspace.own[0]):
                cancellation_point()
                values.scalar(name, is_state=True)
            if workspace.overrides:
                from desire_tui.engine.session.overrides import initial_values

                for name, value in initial_values(workspace.program, workspace.overrides).items():
                    values.assign(values.scalar(name).slot, value)
        self._listener.quantities_cleared()

    def _states(self, program: Program) -> tuple[str, ...]:
        """Return a program's scalar states in their order; overrides change nothing about it."""
        if self._states_of is None or self._states_of[0] is not program:
            start = self._workspace.segments.start
            if start is not None and start.own[0] is program:
                self._states_of = program, start.states()
            else:
                from desire_tui.engine.check.state_order import state_order

                self._states_of = program, state_order(program)
        return self._states_of[1]

    def _drop(self) -> None:
        interpreter, self._current.interpreter = self._current.interpreter, None
        if interpreter is not None:
            interpreter.channels.close()

    def _ready(self) -> Interpreter:
        if self._current.interpreter is None:
            from desire_tui.engine.interpreter.interpreter import Interpreter
            from desire_tui.engine.structure.structure import structure
            from desire_tui.engine.syntax.parse import parse

            program = self._workspace.program or parse(Source("", "<none>"))
            script = self._workspace.structure or structure(program)
            interpreter = Interpreter(program, script, self._workspace.values, self._host)
            interpreter.halt_at(self._workspace.breakpoints)
            self._current.interpreter = interpreter
        return self._current.interpreter

    def _note_stop(self) -> None:
        interpreter = self._current.interpreter
        placed = interpreter.position if interpreter is not None else None
        if interpreter is not None and placed is not None:
            self.stopped = StoppedAt(placed, self._workspace.source, tracing=interpreter.stepping)
            self._listener.stopped_at(self.stopped)

    @contextmanager
    def working(self, source: Source) -> Iterator[None]:
        """Frame of what may be paused and ended (error 301); places problems that have no source yet."""
        with self._activity.working(State.SCRIPT):
            try:
                yield
            except Interrupted:
                raise DesireError(Diagnostic("stopped-by-user", source=source)) from None
            except DesireError as error:
                raise DesireError(*(d.within(source) for d in error.diagnostics)) from error
            except MemoryError:
                raise DesireError(Diagnostic("memory-exhausted", source=source)) from None
            finally:
                self._host.end_runs()
