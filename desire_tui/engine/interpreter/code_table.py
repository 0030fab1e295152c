"""All operations of an interpreter in one list, and the statements they were made from.

The script's stand first, then the body of each PROCEDURE (one for each kind of arguments), then the command
line being executed. The operation of a statement is made when it is first reached.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.interpreter.expression_translation import ExpressionTranslator
    from desire_tui.engine.interpreter.name_resolution import NameScope
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure

Operation = Callable[[], int]


class Finished(Exception):  # noqa: N818 - control flow
    """The script (or command line) ended, or came to a STOP."""


class StatementList(NamedTuple):
    """Statements, their blocks and labels, and the source they stand in."""

    placed: Sequence[Placed]
    structure: Structure
    source: Source | None


@dataclass(eq=False)
class ScriptCode:
    """Statements from place `first` to before `last`, whose operations stand at address `base` + place.

    `loops` holds the state of each `for` by its place: k, count, first value, step, slot.
    """

    text: StatementList
    scope: NameScope
    translator: ExpressionTranslator
    first: int
    last: int
    base: int
    is_command: bool
    loops: dict[int, list[float]] = field(default_factory=dict)


class CodeTable:
    """The list of operations; `make` turns the statement at a place of some code into its operation.

    `halt` is called with the address of a statement at which the script is to halt, before it is carried out.
    """

    def __init__(self, make: Callable[[ScriptCode, int], Operation], halt: Callable[[int], None]) -> None:
        self.operations: list[Operation] = []
        self._make = make
        self._halt = halt
        self._codes: list[ScriptCode] = []
        self._halts: frozenset[int] = frozenset()

    def link(
        self,
        text: StatementList,
        scope: NameScope,
        translator: ExpressionTranslator,
        first: int,
        last: int,
        *,
        is_command: bool,
    ) -> ScriptCode:
        """Add the statements `first` … `last - 1` of a text; the end follows the last one."""
        code = ScriptCode(text, scope, translator, first, last, len(self.operations) - first, is_command)
        self.operations += [self._fresh(code, place) for place in range(first, last)]
        self.operations.append(_finish)
        self._codes.append(code)
        return code

    def unlink(self, code: ScriptCode) -> None:
        """Take a command line's operations away again, unless something was added behind them."""
        if self._codes[-1] is code:
            self._codes.pop()
            del self.operations[code.base + code.first :]

    def locate(self, address: int) -> tuple[ScriptCode, int]:
        """Return the code and the place in it that an address belongs to."""
        for code in self._codes:
            if code.first <= address - code.base <= code.last:
                return code, address - code.base
        raise IndexError(address)

    def forget(self) -> None:
        """Make all operations anew when they are next reached."""
        for code in self._codes:
            for place in range(code.first, code.last):
                self.operations[code.base + place] = self._fresh(code, place)

    def halt_at(self, places: frozenset[int]) -> None:
        """Halt before these statements of the script, and no others; at once, and from any thread."""
        changed, self._halts = self._halts ^ places, places
        for code in tuple(self._codes):
            for place in changed:
                if not code.is_command and code.first <= place < code.last:
                    self.operations[code.base + place] = self._fresh(code, place)

    def halts_before(self, address: int) -> bool:
        """Whether the script halts before the statement at an address."""
        return self._halts_at(*self.locate(address))

    def halts_within(self, first: int, last: int) -> bool:
        """Whether the script halts anywhere between two addresses of the same code."""
        if not self._halts:
            return False
        code, place = self.locate(first)
        return any(self._halts_at(code, place + number) for number in range(last - first + 1))

    def is_made(self, address: int) -> bool:
        """Whether the statement at an address was reached before."""
        operation = self.operations[address]
        return not (isinstance(operation, partial) and operation.func == self._first)

    def _halts_at(self, code: ScriptCode, place: int) -> bool:
        return place in self._halts and not code.is_command

    def _fresh(self, code: ScriptCode, place: int) -> Operation:
        return partial(self._halted if self._halts_at(code, place) else self._first, code, place)

    def _first(self, code: ScriptCode, place: int) -> int:
        """Make the operation of a statement that is reached for the first time, and carry it out."""
        operation = self._make(code, place)
        self._put(code, place, operation)
        return operation()

    def replace_operation(self, address: int, operation: Operation) -> None:
        """Take a quicker operation for the statement at an address from now on."""
        self._put(*self.locate(address), operation)

    def _put(self, code: ScriptCode, place: int, operation: Operation) -> None:
        self.operations[code.base + place] = operation
        if self._halts_at(code, place):  # asked after the change: another thread may want it just now
            self.operations[code.base + place] = partial(self._halted, code, place)

    def _halted(self, code: ScriptCode, place: int) -> int:
        """Halt before a statement; carry it out if the script is to pass this time."""
        self._halt(code.base + place)
        return self._make(code, place)()


def _finish() -> NoReturn:
    raise Finished
