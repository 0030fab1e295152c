"""From text to nodes: tokenizer, grammar, parser, and back again.

`parse` a program, `parse_command` a command line; `highlight` a line for an editor; `format_program` writes
nodes as text.
"""

from __future__ import annotations

from desire_tui.engine.syntax.format import format_program, format_statement
from desire_tui.engine.syntax.highlight import highlight
from desire_tui.engine.syntax.parse import parse, parse_command

__all__ = ["format_program", "format_statement", "highlight", "parse", "parse_command"]
