"""The interpreter's engine: a program counter over operations that are made when they are first reached.

Each statement becomes one operation, a Python function without arguments that returns the place of the statement to
go on with. Blocks are jumps; a PROCEDURE is a frame on a stack, so that STOP can leave and `go` come back anywhere.
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
    from desire_tui.engine.nodes import Placed
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Values

Operation = Callable[[], int]

_BURST = 1000
"""Operations between two looks at the world (`Host.interrupted`, tracing); every jump back looks too."""


class Switch(Exception):  # noqa: N818 - control flow
    """The top frame changed: a PROCEDURE was called or left."""


class Finished(Exception):  # noqa: N818 - control flow
    """The script (or command line) ended, or came to a STOP."""


@dataclass(eq=False)
class Code:
    """Statements with the operations made of them so far; a PROCEDURE has one for each kind of arguments."""

    machine: Machine
    placed: Sequence[Placed]
    structure: Structure
    scope: Scope
    source: Source | None
    is_command: bool = False
    operations: list[Operation] = field(default_factory=list)
    loops: dict[int, list[float]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        machine = self.machine
        self.translator = Translator(self.scope, machine.build, machine.functions)
        self.forget()

    def forget(self) -> None:
        """Make all operations anew when they are next reached."""
        first = self.machine.first
        self.operations[:] = [partial(first, self, place) for place in range(len(self.placed))]
        self.operations.append(self.machine.finish)


@dataclass(slots=True, eq=False)
class Frame:
    """A place in some code, and the PROCEDURE it belongs to."""

    code: Code
    place: int
    procedure: str | None = None


class Machine:
    """Runs code over values; `make` turns a statement into an operation."""

    def __init__(
        self,
        values: Values,
        host: Host,
        script: Sequence[Placed],
        structure: Structure,
        source: Source | None,
        make: Callable[[Code, int], Operation],
    ) -> None:
        self.values = values
        self.host = host
        self.script = script
        self.structure = structure
        functions = dict(structure.functions)  # commands may add to it
        self.source = source
        self.make = make
        self.origins = Origins()
        self.build = Builder(values, self.origins)
        self.build.names["check"] = self.check
        self.scope = Scope(values, functions, structure.procedures)
        self.functions = Functions(functions, self.scope, self.build, source)
        self.procedures: dict[tuple[object, ...], Code] = {}
        self.frames: list[Frame] = []
        self.stopped: list[Frame] | None = None
        self.stepping = False
        self.channels: Channels
        self.data: DataList
        self.script_code: Code
        self._generation = values.generation

    def check(self) -> None:
        """Let the user in: called at every jump back."""
        if self.host.interrupted():
            raise Interrupted

    def finish(self) -> NoReturn:
        """End of the statements."""
        raise Finished

    def stop(self, place: int) -> NoReturn:
        """STOP: `go` continues at `place`."""
        self.frames[-1].place = place
        self.stopped = self.frames
        raise Finished

    def resume(self) -> None:
        """Continue after STOP; error 43."""
        frames = self.stopped
        if frames is None:
            raise DesireError(Diagnostic("go-without-stop"))
        self.stopped = None
        self.run(frames)

    def first(self, code: Code, place: int) -> int:
        """Make the operation of a statement that is reached for the first time, and carry it out."""
        operation = code.operations[place] = self.make(code, place)
        return operation()

    def run(self, frames: list[Frame]) -> None:
        """Run to the end or to a STOP. DesireError with its place; Interrupted."""
        self.refresh(frames)
        before, self.frames = self.frames, frames
        try:
            self._loop(frames)
        except Finished:
            pass
        finally:
            self.frames = before

    def define(self, definitions: dict[str, Placed], source: Source | None) -> None:
        """Take FUNCTIONs from a command line; code that calls those of the same name is made anew."""
        if definitions:
            self.functions.define(definitions, source)
            self.procedures.clear()
            self.script_code.forget()

    def refresh(self, frames: list[Frame] = ()) -> None:  # type: ignore[assignment]
        """Forget made operations if all names were cleared since."""
        if self._generation == self.values.generation:
            return
        self._generation = self.values.generation
        self.procedures.clear()
        self.functions.forget()
        self.data.forget()
        self.script_code.forget()
        for frame in frames:
            frame.code.forget()

    def _loop(self, frames: list[Frame]) -> None:
        interrupted = self.host.interrupted
        while True:
            frame = frames[-1]
            operations = frame.code.operations
            place = frame.place
            try:
                while not self.stepping:
                    for _ in range(_BURST):
                        place = operations[place]()
                    if interrupted():
                        raise Interrupted
                while self.stepping:
                    frame.place = place
                    if place < len(frame.code.placed):
                        self.host.before(frame.code.placed[place])
                    place = operations[place]()
                frame.place = place
            except Switch:
                continue
            except (Finished, Interrupted):
                raise
            except Exception as error:
                code = frame.code
                raise explain(error, code.placed[place], code.source, self.origins) from error

    def enter(self, name: str, code: Code, place: int, back: int) -> NoReturn:
        """Call a PROCEDURE; error 52 if it is being executed already."""
        if any(frame.procedure == name for frame in self.frames):
            raise Fault("procedure-recursion", None, name=name)
        self.frames[-1].place = back
        self.frames.append(Frame(code, place, name))
        raise Switch

    def leave(self) -> NoReturn:
        """Return from a PROCEDURE."""
        if len(self.frames) < 2:
            raise Fault("end-without-call")
        self.frames.pop()
        raise Switch
