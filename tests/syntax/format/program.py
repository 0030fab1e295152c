"""Programs as text: a statement a line, blocks indented."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import For, If, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Submodel
from tests.syntax.format.statements import format_statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.nodes.statements import Statement

INDENT = "  "
_CLOSING = frozenset({"else", "proceed", "next", "end while", "end", "end if"})


def format_program(program: Program) -> str:
    """Return a program's canonical text: a statement a line, blocks indented. Comments are lost: no nodes."""
    lines: list[str] = []
    depth = 0
    for placed in program.script:
        node = placed.node
        depth -= _closes(node)
        shown = placed.number is not None and not _repeats(program.script, placed)
        number = f"{placed.number} " if shown else ""
        lines.append(number + INDENT * max(0, depth) + format_statement(node))
        depth += _opens(node)
    for i, segment in enumerate(program.segments):
        if i == 0:
            lines.append("DYNAMIC")
        if segment.label is not None:
            lines.append(f"label {segment.label}")
        lines += [INDENT + format_statement(placed.node) for placed in segment.body]
        if segment.jacobian:
            lines.append("JACOBIAN")
            lines += [INDENT + format_statement(placed.node) for placed in segment.jacobian]
    return "".join(f"{line}\n" for line in lines)


def _repeats(script: Sequence[Placed], placed: Placed) -> bool:
    """Whether an earlier statement of the same line has shown its number."""
    return next(other for other in script if other.number == placed.number) is not placed


def _opens(node: Statement) -> bool:
    if isinstance(node, If | For | While | Procedure | Submodel):
        return True
    return isinstance(node, Simple) and node.word in ("repeat", "else")


def _closes(node: Statement) -> bool:
    if isinstance(node, Until):
        return True
    return isinstance(node, Simple) and node.word in _CLOSING
