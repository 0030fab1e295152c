"""The active program's script: run from the top, stopped, continued; and command lines over its names."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.listener import StoppedAt
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from desire_tui.engine.values import SCALE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.interpreter.interpreter import Interpreter
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.runtime.pause_and_stop import Control
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.script_host import ScriptHost
    from desire_tui.engine.session.workspace import Workspace


class ScriptRunner:
    """Owns the interpreter. Everything here runs on the session's thread."""

    def __init__(self, desk: Workspace, world: ScriptHost, control: Control, listener: Listener) -> None:
        self._desk, self._world, self._control, self._listener = desk, world, control, listener
        self._interpreter: Interpreter | None = None
        self.stopped: StoppedAt | None = None
        """Where it came to a STOP."""
        self.edited = False
        """The program was changed since: `go` is refused."""
        world.write_to_channel = self._write_to_channel

    def forget(self) -> None:
        """Drop the interpreter and all names; the files that the script connected are closed."""
        self._drop()
        self.stopped, self.edited = None, False
        self._clear()

    def run(self, scale: float) -> None:
        """Clear all names and run from the top. DesireError 215: there is no program; or its problems."""
        program, _ = self._desk.runnable()
        tracing = self._interpreter is not None and self._interpreter.stepping
        self.forget()
        self._desk.values.assign(SCALE, scale)
        self._world.runs.forget()
        self._desk.journal.program(program.source)
        with self._working(program.source):
            interpreter = self._ready()
            interpreter.stepping = tracing
            interpreter.run()
        self._note_stop()

    def go(self) -> None:
        """Continue after STOP; error 43."""
        if self._interpreter is None or self.stopped is None:
            raise DesireError(Diagnostic("go-without-stop"))
        if self.edited:
            raise DesireError(Diagnostic("go-after-edit"))
        self.stopped = None
        self._world.step_allowed = self._interpreter.stepping
        with self._working(self._desk.source):
            self._interpreter.go()
        self._note_stop()

    def set_breakpoints(self, lines: frozenset[int]) -> None:
        """Stop before these lines of the active program from now on; from any thread."""
        self._desk.breakpoints = lines
        if (interpreter := self._interpreter) is not None:
            interpreter.halt_at(lines)

    def interpret(self, statements: list[Placed], source: Source) -> None:
        """Carry out statements of a command line."""
        if not statements:
            return
        before, self._desk.command = self._desk.command, source
        try:
            with self._working(source):
                self._ready().execute(tuple(statements), source)
        finally:
            self._desk.command = before

    def _clear(self) -> None:
        from desire_tui.engine.check.state_order import state_order

        desk, values = self._desk, self._desk.values
        values.clear()
        self._world.begin_program()
        if desk.program is not None:
            for name in state_order(desk.program):
                values.scalar(name, is_state=True)
            if desk.overrides:
                from desire_tui.engine.session.overrides import initial

                for name, value in initial(desk.program, desk.overrides).items():
                    values.assign(values.scalar(name).slot, value)
        self._listener.quantities_cleared()

    def _drop(self) -> None:
        interpreter, self._interpreter = self._interpreter, None
        if interpreter is not None:
            interpreter.channels.close()

    def _ready(self) -> Interpreter:
        if self._interpreter is None:
            from desire_tui.engine.interpreter.interpreter import Interpreter
            from desire_tui.engine.structure.structure import structure
            from desire_tui.engine.syntax.parse import parse

            program = self._desk.program or parse(Source("", "<none>"))
            script = self._desk.structure or structure(program)
            self._interpreter = Interpreter(program, script, self._desk.values, self._world)
            self._world.stop_here = self._interpreter.stop_here
            self._world.runs_ahead = self._interpreter.runs_ahead
            self._interpreter.halt_at(self._desk.breakpoints)
        return self._interpreter

    def _note_stop(self) -> None:
        interpreter = self._interpreter
        placed = interpreter.position if interpreter is not None else None
        if interpreter is not None and placed is not None:
            self.stopped = StoppedAt(placed, self._desk.source, tracing=interpreter.stepping)
            self._listener.stopped_at(self.stopped)

    @contextmanager
    def _working(self, source: Source) -> Iterator[None]:
        """Frame of everything that may be paused and ended; places problems that have no source yet."""
        control, world = self._control, self._world
        control.begin()
        before, world.state = world.state, State.SCRIPT
        try:
            yield
        except Interrupted:
            raise DesireError(Diagnostic("stopped-by-user", source=source)) from None
        except DesireError as error:
            raise DesireError(*(d.within(source) for d in error.diagnostics)) from error
        except MemoryError:
            raise DesireError(Diagnostic("memory-exhausted", source=source)) from None
        finally:
            world.state = before
            control.done()

    def _write_to_channel(self, channel: int, text: str) -> None:
        self._ready().channels.write(channel, text)
