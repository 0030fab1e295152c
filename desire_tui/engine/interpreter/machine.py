"""The interpreter's engine: a program counter over operations that are made when they are first reached.

Each statement becomes one operation, a Python function without arguments that returns the address of the
next one. All operations stand in one list: the script's first, then the body of each PROCEDURE (one for each
kind of arguments), then the command line in hand. A call pushes the address to come back to.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.builder import Builder
from desire_tui.engine.interpreter.faults import Fault, Origins, explain
from desire_tui.engine.interpreter.functions import Functions
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.scope import Scope
from desire_tui.engine.interpreter.translate import Translator

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.analysis.structure import Structure
    from desire_tui.engine.interpreter.channels import Channels
    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.interpreter.reading import DataList
    from desire_tui.engine.nodes import Placed, Program
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Values

Operation = Callable[[], int]

_BURST = 1000
"""Operations between two looks at the world (`Host.interrupted`, tracing); every jump back looks too."""


class Finished(Exception):  # noqa: N818 - control flow
    """The script (or command line) ended, or came to a STOP."""


class Turned(Exception):  # noqa: N818 - control flow
    """Tracing was turned on or off; `address` comes next."""

    def __init__(self, address: int) -> None:
        super().__init__()
        self.address = address


@dataclass(frozen=True, slots=True, eq=False)
class Stop:
    """Where `go` continues, and the open calls there."""

    address: int
    returns: list[tuple[int, str]]


@dataclass(eq=False)
class Code:
    """Some statements, from place `first` to `last`, whose operations stand at address `base` + place."""

    placed: Sequence[Placed]
    structure: Structure
    scope: Scope
    source: Source | None
    translator: Translator
    first: int
    last: int
    base: int
    is_command: bool = False
    loops: dict[int, list[float]] = field(default_factory=dict)


class Machine:
    """Runs code over values; `make` turns the statement at a place into an operation."""

    channels: Channels
    data: DataList

    def __init__(
        self,
        values: Values,
        host: Host,
        program: Program,
        structure: Structure,
        make: Callable[[Machine, Code, int], Operation],
    ) -> None:
        self.values = values
        self.host = host
        self.make = make
        self.structure = structure
        self.origins = Origins()
        self.build = Builder(values, self.origins)
        self.build.names["check"] = self.check
        functions = dict(structure.functions)  # commands may add to it
        self.scope = Scope(values, functions, structure.procedures)
        self.functions = Functions(functions, self.scope, self.build, program.source)
        self.operations: list[Operation] = []
        self.codes: list[Code] = []
        self.procedures: dict[tuple[object, ...], Code] = {}
        self.script = self.link(program.script, structure, self.scope, program.source, 0, len(program.script))
        self.returns: list[tuple[int, str]] = []
        self.stopped: Stop | None = None
        self._address = 0
        self.stepping = False
        self._generation = values.generation

    # ------------------------------------------------------------------------------- making code

    def link(
        self,
        placed: Sequence[Placed],
        structure: Structure,
        scope: Scope,
        source: Source | None,
        first: int,
        last: int,
        *,
        is_command: bool = False,
    ) -> Code:
        """Add statements `first` … `last - 1` to the operations; the last one is followed by the end."""
        base = len(self.operations) - first
        translator = Translator(scope, self.build, self.functions)
        code = Code(placed, structure, scope, source, translator, first, last, base, is_command)
        self.operations += [partial(self._first, code, place) for place in range(first, last)]
        self.operations.append(_finish)
        self.codes.append(code)
        return code

    def unlink(self, code: Code) -> None:
        """Take a command line's operations away again, unless something was added behind them."""
        if self.codes[-1] is code:
            self.codes.pop()
            del self.operations[code.base + code.first :]

    def _first(self, code: Code, place: int) -> int:
        """Make the operation of a statement that is reached for the first time, and carry it out."""
        operation = self.operations[code.base + place] = self.make(self, code, place)
        return operation()

    def forget(self) -> None:
        """Make all operations anew when they are next reached, and PROCEDUREs' bodies when next called."""
        self.procedures.clear()
        self.functions.forget()
        self.data.forget()
        for code in self.codes:
            for place in range(code.first, code.last):
                self.operations[code.base + place] = partial(self._first, code, place)

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
                except Turned as turned:
                    address = turned.address
        except Finished:
            pass
        finally:
            self.returns = before

    def _loop(self, address: int) -> None:
        operations, host = self.operations, self.host
        try:
            while True:
                while not self.stepping:
                    for _ in range(_BURST):
                        address = operations[address]()
                    self.check()
                while self.stepping:
                    code, place = self.locate(address)
                    if place < code.last:
                        self._address = address
                        host.before(code.placed[place])
                    address = operations[address]()
        except (Finished, Turned, Interrupted):
            raise
        except Exception as error:
            code, place = self.locate(address)
            placed = code.placed[place]
            raise explain(error, placed, code.source, self.origins, self._callers()) from error

    def _callers(self) -> list[tuple[Placed, Source | None]]:
        """Return the `call` statements that led here, the innermost first."""
        found = (self.locate(back - 1) for back, _ in reversed(self.returns))
        return [(code.placed[place], code.source) for code, place in found]

    def locate(self, address: int) -> tuple[Code, int]:
        """Return the code and the place in it that an address belongs to."""
        for code in self.codes:
            if code.first <= address - code.base <= code.last:
                return code, address - code.base
        raise IndexError(address)

    def turn_tracing(self, address: int) -> NoReturn:
        """`trace`: on, or off again; go on at `address`."""
        self.stepping = not self.stepping
        raise Turned(address)

    def check(self) -> None:
        """Let the user in: called at every jump back."""
        if self.host.interrupted():
            raise Interrupted

    def call(self, name: str, back: int) -> None:
        """Note a PROCEDURE that is entered; error 52 if it is being executed already."""
        for _, active in self.returns:
            if active == name:
                raise Fault("procedure-recursion", None, name=name)
        self.returns.append((back, name))

    def leave(self) -> int:
        """Return from a PROCEDURE."""
        if not self.returns:
            raise Fault("end-without-call")
        return self.returns.pop()[0]

    def stop(self, address: int) -> NoReturn:
        """STOP: `go` continues at `address`."""
        self.stopped = Stop(address, self.returns)
        raise Finished

    def stop_before(self) -> NoReturn:
        """Stop before the statement that `Host.before` is just hearing of."""
        self.stopped = Stop(self._address, self.returns)
        raise Finished

    def resume(self) -> None:
        """Continue after STOP; error 43."""
        if self.stopped is None:
            raise DesireError(Diagnostic("go-without-stop"))
        stop, self.stopped = self.stopped, None
        self.run(stop.address, stop.returns)


def _finish() -> NoReturn:
    raise Finished
