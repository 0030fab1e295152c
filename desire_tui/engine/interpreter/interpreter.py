"""The script half of a session: runs programs, goes on after STOP, carries out command lines."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.interpreter.channels import Channels
from desire_tui.engine.interpreter.code_table import StatementList
from desire_tui.engine.interpreter.data_and_input import data_item
from desire_tui.engine.interpreter.machine import ScriptMachine
from desire_tui.engine.interpreter.statements import make
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import Structure, script_structure

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.values import Values


_OF_PROGRAMS = frozenset({"call-missing", "expression-alone"})
"""Problems that command lines do not have."""


class Interpreter:
    """Interprets one program's script over a session's values.

    `stepping` asks for `Host.before` before each statement (tracing); it may be set from another thread, as
    breakpoints may. All methods raise DesireError for the user's mistakes, with the exact place, and
    `Interrupted`.
    """

    def __init__(self, program: Program, structure: Structure, values: Values, host: Host) -> None:
        self.program = program
        self.structure = structure
        self.channels = Channels(host)
        self._machine = ScriptMachine(values, host, self.channels, program, structure, make, data_item)

    @property
    def stepping(self) -> bool:
        """Whether the host wants to hear of each statement."""
        return self._machine.stepping

    @stepping.setter
    def stepping(self, wanted: bool) -> None:
        self._machine.stepping = wanted

    def halt_at(self, lines: Iterable[int]) -> None:
        """Stop as at a STOP before the first statement of each of these lines (from 1), from now on."""
        self._machine.code_table.halt_at(self._places(frozenset(lines)))

    def _places(self, lines: frozenset[int]) -> frozenset[int]:
        """Return the places of the first statements that begin in lines, or else that go on in them."""
        first: dict[int, int] = {}
        goes_on: dict[int, int] = {}
        row_of = self.program.source.position
        for place, placed in enumerate(self.program.script if lines else ()):
            row, last = row_of(placed.at).row, row_of(placed.at + placed.node.end - 1).row
            first.setdefault(row, place)
            goes_on.update(dict.fromkeys(range(row + 1, last + 1), place))
        found = goes_on | first
        return frozenset(found[line] for line in lines if line in found)

    @property
    def position(self) -> Placed | None:
        """The statement that `go` would carry out next, after a STOP; else None."""
        if self._machine.stopped is None:
            return None
        code, place = self._machine.code_table.locate(self._machine.stopped.address)
        return code.text.placed[min(place, len(code.text.placed) - 1)]

    def runs_ahead(self) -> int | None:
        """Return how many runs come after the one being made; None: unknown."""
        return self._machine.runs_ahead()

    def run(self) -> None:
        """Run the script from the top; files still connected are closed first."""
        self._machine.stopped = None
        self._machine.data.rewind()
        self.channels.close()
        self._run(self._machine.script.base)

    def go(self) -> None:
        """Continue after STOP; error 43 if there is nothing to continue."""
        try:
            self._machine.resume()
        finally:
            self.channels.flush()

    def stop_here(self) -> NoReturn:
        """Stop before the present statement as at a STOP; for `Host.before` while tracing."""
        self._machine.stop_before()

    def execute(self, statements: Sequence[Placed], source: Source | None = None) -> None:
        """Carry out a command line; loops must be complete in it. A FUNCTION line defines that function."""
        structure = script_structure(statements, source or Source("", "<command>"))
        # what stands alone is a mistake in a script; as a command it prints its value
        problems = [problem for problem in structure.problems if problem.key not in _OF_PROGRAMS]
        if problems:
            raise DesireError(*problems)
        self._machine.define(structure.functions, source)
        machine = self._machine
        text = StatementList(statements, structure, source)
        code = machine.link(text, machine.scope, 0, len(statements), is_command=True)
        stopped = machine.stopped
        try:
            self._run(code.base)
        finally:
            if (
                machine.stopped is None or machine.stopped is stopped
            ):  # else a PROCEDURE stopped, and comes back here
                machine.code_table.unlink(code)

    def repeated(self, statements: Sequence[Placed]) -> Callable[[], None]:
        """Return what carries out some of the script's statements, which hold no jumps, again and again."""
        structure = script_structure(statements, self.program.source)
        text = StatementList(tuple(statements), structure, self.program.source)
        code = self._machine.link(text, self._machine.scope, 0, len(statements), is_command=True)
        return partial(self._machine.run_straight, code.base, len(statements))

    def _run(self, address: int) -> None:
        try:
            self._machine.run(address)
        except BaseException:
            with suppress(DesireError):  # the first problem counts: it has a place
                self.channels.flush()
            raise
        self.channels.flush()
