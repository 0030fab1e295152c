"""A program's script without its runs: what JACOBIAN segments need to be checked before the first run.

Parameters, array sizes and initial values are what the script makes of them, so the script is carried out,
over quantities of its own and with a host that does nothing: runs are skipped, nothing is shown, read,
asked for or written. A script that cannot go on there, or takes long, is left; nothing is then said.
"""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.integration.rules import DEFAULT_RULE
from desire_tui.engine.interpreter.host import Interrupted

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Quantity, Values

SECONDS_MOST = 0.5
ARRAYS_MOST = 1 << 20
"""Numbers in all arrays: more would be work, and memory, for a check while typing."""
STOPS_MOST = 100


def wrong_jacobians(program: Program) -> tuple[Diagnostic, ...]:
    """Return warnings 462 for all JACOBIAN segments that a script's `drun`s reach, in the order of the runs.

    `program` has no errors. Programs without a JACOBIAN cost nothing.
    """
    labels = {segment.label for segment in program.segments if segment.jacobian}
    if not labels:
        return ()
    from desire_tui.engine.check.state_order import state_order
    from desire_tui.engine.interpreter.interpreter import Interpreter
    from desire_tui.engine.structure.structure import structure
    from desire_tui.engine.values import Values

    values = Values(ARRAYS_MOST)
    for name in state_order(program):
        values.scalar(name, is_state=True)
    script = structure(program)
    host = DryHost(program, script, values, labels)
    interpreter = Interpreter(program, script, values, host)
    try:
        interpreter.run()
        for _ in range(STOPS_MOST):
            if interpreter.position is None:
                break
            interpreter.go()
    except (DesireError, Interrupted, MemoryError):
        pass  # what is wrong, the run itself will say
    finally:
        interpreter.channels.close()
    return tuple(host.found)


class DryHost:
    """Implements `interpreter.Host`: the script runs, but nothing it asks for happens."""

    def __init__(
        self,
        program: Program,
        structure: Structure,
        values: Values,
        labels: set[str | None],
        seconds: float = SECONDS_MOST,
    ) -> None:
        self.rule = DEFAULT_RULE
        self.found: list[Diagnostic] = []
        self._program, self._structure, self._values = program, structure, values
        self._wanted = labels
        self._until = monotonic() + seconds

    def drun(self, label: str | None, placed: Placed, *, star: bool) -> None:
        """Look at the segment's JACOBIAN instead of running it."""
        del placed, star
        if label not in self._wanted:
            return
        from desire_tui.engine.lowering.lowering import lower
        from desire_tui.engine.reference.jacobian import wrong_elements

        self._wanted.discard(label)
        segment = lower(self._program, label, self._values, self._structure)
        self.found.extend(wrong_elements(segment, self._values) or ())
        if not self._wanted:
            raise Interrupted

    def interrupted(self) -> bool:
        """Whether it has taken long enough."""
        return monotonic() > self._until

    def ask(self, prompt: str) -> str:
        """Nobody answers."""
        raise EOFError(prompt)

    def permit(self, path: Path, mode: Literal["read", "write"]) -> Path:
        """Let it write into nothing; files are not read."""
        if mode == "write":
            return Path(os.devnull)
        raise DesireError(Diagnostic("data-file-not-found", facts={"file": path}))

    def write(self, text: str) -> None:
        """Show nothing."""

    def reset(self) -> None:
        """Do nothing: there was no run."""

    def display(self, mode: str, args: Sequence[float]) -> None:
        """Show nothing."""

    def name_graph(self, part: str, text: str) -> None:
        """Name nothing."""

    def plot(self, x: float, y: float, color: int | None) -> None:
        """Show nothing."""

    def show(self, quantity: Quantity, columns: int) -> None:
        """Show nothing."""

    def show_area(self, *, by_size: bool) -> None:
        """Show nothing."""

    def note(self, text: str) -> None:
        """Write nothing."""

    def shell(self, command: str) -> None:
        """Run nothing."""

    def command(self, word: str, argument: str | None) -> None:
        """Do nothing."""

    def before(self, placed: Placed) -> None:
        """Nobody traces."""

    def warn(self, problem: DesireError) -> None:
        """Say nothing."""
