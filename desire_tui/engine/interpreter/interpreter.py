"""The script half of a session: runs programs, goes on after STOP, carries out command lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.analysis.structure import Structure, script_structure
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.interpreter.channels import Channels
from desire_tui.engine.interpreter.machine import Code, Frame, Machine
from desire_tui.engine.interpreter.reading import DataList
from desire_tui.engine.interpreter.statements import make
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.nodes import Placed, Program
    from desire_tui.engine.values import Values


class Interpreter:
    """Interprets one program's script over a session's values.

    `stepping` asks for `Host.before` before each statement (tracing, breakpoints); it may be set from another
    thread. All methods raise DesireError for the user's mistakes, with the exact place, and `Interrupted`.
    """

    def __init__(self, program: Program, structure: Structure, values: Values, host: Host) -> None:
        self.program = program
        self.structure = structure
        self._machine = Machine(values, host, program.script, structure, program.source, make)
        self.channels = self._machine.channels = Channels(host)
        self._script = Code(self._machine, program.script, structure, self._machine.scope, program.source)
        self._machine.script_code = self._script
        self._machine.data = DataList(self._script)

    @property
    def stepping(self) -> bool:
        """Whether the host wants to hear of each statement."""
        return self._machine.stepping

    @stepping.setter
    def stepping(self, wanted: bool) -> None:
        self._machine.stepping = wanted

    @property
    def position(self) -> Placed | None:
        """The statement that `go` would carry out next (after STOP); None if there is nothing to go on with."""
        frames = self._machine.stopped
        if not frames or not frames[-1].code.placed:
            return None
        frame = frames[-1]
        return frame.code.placed[min(frame.place, len(frame.code.placed) - 1)]

    def run(self) -> None:
        """Run the script from the top; files still connected are closed first."""
        if self.structure.problems:
            raise DesireError(*self.structure.problems)
        self._machine.stopped = None
        self._machine.data.rewind()
        self.channels.close()
        self._run([Frame(self._script, 0)])

    def go(self) -> None:
        """Continue after STOP; error 43 if there is nothing to continue."""
        try:
            self._machine.resume()
        finally:
            self.channels.flush()

    def stop_here(self) -> NoReturn:
        """Stop before the present statement as at a STOP; for `Host.before` while tracing."""
        self._machine.stop(self._machine.frames[-1].place)

    def forget_position(self) -> None:
        """Make `go` impossible: the program was edited, or the values were cleared."""
        self._machine.stopped = None

    def execute(self, statements: Sequence[Placed], source: Source | None = None) -> None:
        """Carry out a command line; loops must be complete in it. A FUNCTION line defines that function."""
        structure = script_structure(statements, source or Source("", "<command>"))
        if structure.problems:
            raise DesireError(*structure.problems)
        self._machine.define(structure.functions, source)
        code = Code(self._machine, statements, structure, self._machine.scope, source, is_command=True)
        self._run([Frame(code, 0)])

    def _run(self, frames: list[Frame]) -> None:
        try:
            self._machine.run(frames)
        finally:
            self.channels.flush()
