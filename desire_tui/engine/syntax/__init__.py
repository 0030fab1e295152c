"""From text to nodes: tokenizer, grammar, parser, and back again.

`parse` a program, `parse_command` a command line; `highlight` a line for an editor; `format_program` and
`format_statement` write nodes as text.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.syntax.parse import parse, parse_command

if TYPE_CHECKING:
    from desire_tui.engine.syntax.format import format_program, format_statement
    from desire_tui.engine.syntax.highlighting import before, highlight

_LATER = {
    "before": "highlighting",
    "format_program": "format",
    "format_statement": "format",
    "highlight": "highlighting",
}


def __getattr__(name: str) -> object:
    """Import what a run does not need when it is asked for."""
    from importlib import import_module

    if name not in _LATER:
        raise AttributeError(name)
    value = globals()[name] = getattr(import_module(f"{__name__}.{_LATER[name]}"), name)
    return value


__all__ = ["before", "format_program", "format_statement", "highlight", "parse", "parse_command"]
