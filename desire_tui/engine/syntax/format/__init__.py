"""Nodes as text that parses back to the same nodes.

Used by `list` and `edit`, and by tests: `parse(format(x)) == x` for every tree.
"""

from desire_tui.engine.syntax.format.program import format_program
from desire_tui.engine.syntax.format.statements import format_statement

__all__ = ["format_program", "format_statement"]
