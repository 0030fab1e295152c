"""A command line that only reads, carried out while a run goes on: `write 2*x`, `dump`.

Native code changes the quantities meanwhile, and a script may stand in the middle of a statement. So the line
is carried out over a copy of all numbers, by an interpreter of its own, with a host that
only lets it write.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.nodes.files import Dump, Write
from desire_tui.engine.session.dry_run import DryHost
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values

NUMBERS_MOST = 1 << 22
"""Of larger models no copy is made while they run."""
SECONDS_MOST = 0.5


def evaluate_while_running(text: str, program: Program, structure: Structure, values: Values) -> str | None:
    """Return what a line writes that does nothing else; None: it is no such line, or the model is too large.

    Any thread. DesireError: its mistakes.
    """
    from desire_tui.engine.interpreter.interpreter import Interpreter
    from desire_tui.engine.syntax.parse import parse_command

    source = Source(text, "<command>")
    statements, problems = parse_command(source)
    nodes = [placed.node for placed in statements]
    reads = all(
        isinstance(node, Write | Dump) and node.channel is None and getattr(node, "what", "all") == "all"
        for node in nodes
    )
    if problems or not nodes or not reads or values.numbers_used > NUMBERS_MOST:
        return None
    copy = values.copied()
    host = _WritingHost(program, structure, copy, set(), SECONDS_MOST)
    interpreter = Interpreter(program, structure, copy, host)
    try:
        interpreter.execute(statements, source)
    except Interrupted:
        return None
    return "".join(host.written)


class _WritingHost(DryHost):
    """A host that does nothing but keep what is written."""

    def __init__(
        self, program: Program, structure: Structure, values: Values, wanted: set[str | None], seconds: float
    ) -> None:
        super().__init__(program, structure, values, wanted, seconds)
        self.written: list[str] = []

    def write(self, text: str) -> None:
        """Keep it."""
        self.written.append(text)
