"""The interpreter's engine: a program counter over operations that are made when they are first reached.

Each statement becomes one operation, a Python function without arguments that returns the address of the
next one. All operations stand in one list: the script's first, then the body of each PROCEDURE (one for each
kind of arguments), then the command line being executed. A call pushes the address to come back to.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.code_table import CodeTable, Finished, Operation, ScriptCode, StatementList
from desire_tui.engine.interpreter.compile_python import PythonCompiler
from desire_tui.engine.interpreter.data_list import DataList
from desire_tui.engine.interpreter.exception_mapping import Origins, ScriptFault, explain
from desire_tui.engine.interpreter.expression_translation import ExpressionTranslator
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.name_resolution import NameScope
from desire_tui.engine.interpreter.run_count import runs_ahead
from desire_tui.engine.interpreter.user_functions import UserFunctions

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.channels import Channels
    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values

_BURST = 1000
"""Operations between two checks for interruption and tracing; every jump back checks, too."""


class TracingToggled(Exception):  # noqa: N818 - control flow
    """Tracing was toggled on or off; `address` comes next."""

    def __init__(self, address: int) -> None:
        super().__init__()
        self.address = address


@dataclass(frozen=True, slots=True, eq=False)
class Stop:
    """Where `go` continues, and the open calls there."""

    address: int
    returns: list[tuple[int, str]]


class ScriptMachine:
    """Runs code over values.

    `make` turns the statement at a place into an operation, `data_item` an item of a `data` statement into
    the function that evaluates it.
    """

    def __init__(
        self,
        values: Values,
        host: Host,
        channels: Channels,
        program: Program,
        structure: Structure,
        make: Callable[[ScriptMachine, ScriptCode, int], Operation],
        data_item: Callable[[ScriptMachine, int, Expr], Callable[[], complex]],
    ) -> None:
        self.values = values
        self.host = host
        self.channels = channels
        self.program = program
        self.structure = structure
        self.origins = Origins()
        self.build = PythonCompiler(values, self.origins)
        self.build.names["check"] = self.check
        functions = dict(structure.functions)  # commands may add to it
        self.scope = NameScope(values, functions, structure.procedures)
        self.functions = UserFunctions(functions, self.scope, self.build, program.source)
        self.code_table = CodeTable(partial(make, self), self._halt)
        self.data = DataList(program.script, structure.data, structure.faults, partial(data_item, self))
        self.procedures: dict[tuple[object, ...], ScriptCode] = {}
        text = StatementList(program.script, structure, program.source)
        self.script = self.link(text, self.scope, 0, len(program.script))
        self.returns: list[tuple[int, str]] = []
        self.stopped: Stop | None = None
        self._address = 0
        self._passing: int | None = None
        """The halt from which the script goes on: it does not halt there a second time."""
        self.stepping = False
        self.run_at: tuple[ScriptCode, int] | None = None
        """Where the `drun` stands that is carried out, or was the last."""
        self._generation = values.generation

    # ------------------------------------------------------------------------------- making code

    def link(
        self,
        text: StatementList,
        scope: NameScope,
        first: int,
        last: int,
        *,
        is_command: bool = False,
    ) -> ScriptCode:
        """Add statements `first` … `last - 1` of a text to the operations."""
        translator = ExpressionTranslator(scope, self.build, self.functions)
        return self.code_table.link(text, scope, translator, first, last, is_command=is_command)

    def forget(self) -> None:
        """Make all operations anew when they are next reached, and PROCEDUREs' bodies when next called."""
        self.procedures.clear()
        self.functions.forget()
        self.data.forget()
        self.code_table.forget()

    def refresh(self) -> None:
        """Forget all operations if all names were cleared since they were made."""
        if self._generation != self.values.generation:
            self._generation = self.values.generation
            self.forget()

    def define(self, definitions: dict[str, Placed], source: Source | None) -> None:
        """Take FUNCTIONs from a command line; code that calls those of the same name is made anew."""
        if definitions:
            self.functions.define(definitions, source)
            self.forget()

    # ------------------------------------------------------------------------------- running

    def run(self, address: int, returns: list[tuple[int, str]] | None = None) -> None:
        """Run to the end or to a STOP. DesireError with its place; Interrupted."""
        self.refresh()
        before, self.returns = self.returns, returns if returns is not None else []
        try:
            while True:
                try:
                    self._loop(address)
                except TracingToggled as toggled:
                    address = toggled.address
        except Finished:
            pass
        finally:
            self.returns = before

    def run_straight(self, address: int, count: int) -> None:
        """Carry out `count` statements without jumps, loops and output. DesireError with its place."""
        self.refresh()
        operations = self.code_table.operations
        try:
            for _ in range(count):
                address = operations[address]()
        except (TracingToggled, Interrupted):
            raise
        except Exception as error:
            raise self._explained(error, address) from error

    def _loop(self, address: int) -> None:
        operations, host = self.code_table.operations, self.host
        try:
            while True:
                while not self.stepping:
                    for _ in range(_BURST):
                        address = operations[address]()
                    self.check()
                while self.stepping:
                    code, place = self.code_table.locate(address)
                    if place < code.last:
                        self._address = address
                        host.before(code.text.placed[place])
                    address = operations[address]()
        except (Finished, TracingToggled, Interrupted):
            raise
        except Exception as error:
            raise self._explained(error, address) from error

    def _explained(self, error: Exception, address: int) -> DesireError:
        """Return what a user is told of an error at an address."""
        code, place = self.code_table.locate(address)
        return explain(error, code.text.placed[place], code.text.source, self.origins, self._callers())

    def runs_ahead(self) -> int | None:
        """Return how many runs come after the one being made, where loops show it."""
        if self.run_at is None:
            return None
        return runs_ahead(
            [self.run_at, *(self.code_table.locate(back - 1) for back, _ in reversed(self.returns))]
        )

    def _callers(self) -> list[tuple[Placed, Source | None]]:
        """Return the `call` statements that led here, the innermost first."""
        found = (self.code_table.locate(back - 1) for back, _ in reversed(self.returns))
        return [(code.text.placed[place], code.text.source) for code, place in found]

    def toggle_tracing(self, address: int) -> NoReturn:
        """`trace`: on, or off again; go on at `address`."""
        self.stepping = not self.stepping
        raise TracingToggled(address)

    def check(self) -> None:
        """Let the user in: called at every jump back."""
        if self.host.interrupted():
            raise Interrupted

    def must_leave(self, first: int, last: int) -> bool:
        """Let the user in; return whether statements of these addresses have to be carried out one by one."""
        self.check()
        return self.stepping or self.code_table.halts_within(first, last)

    def call(self, name: str, back: int) -> None:
        """Note a PROCEDURE that is entered; error 52 if it is being executed already."""
        for _, active in self.returns:
            if active == name:
                raise ScriptFault("procedure-recursion", None, name=name)
        self.returns.append((back, name))

    def leave(self) -> int:
        """Return from a PROCEDURE."""
        return self.returns.pop()[0]

    def stop(self, address: int) -> NoReturn:
        """STOP: `go` continues at `address`."""
        self.stopped = Stop(address, self.returns)
        raise Finished

    def stop_before(self) -> NoReturn:
        """Stop before the statement that `Host.before` is just hearing of."""
        self.stopped = Stop(self._address, self.returns)
        raise Finished

    def _halt(self, address: int) -> None:
        """Stop before the statement at an address that holds a breakpoint, unless `go` starts there."""
        passing, self._passing = self._passing, None
        if passing != address:
            self.stop(address)

    def resume(self) -> None:
        """Continue after STOP; error 43."""
        if self.stopped is None:
            raise DesireError(Diagnostic("go-without-stop"))
        stop, self.stopped = self.stopped, None
        self._passing = stop.address if self.code_table.halts_before(stop.address) else None
        self.run(stop.address, stop.returns)
