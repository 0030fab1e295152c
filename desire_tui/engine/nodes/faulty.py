"""A statement that cannot be read, in its place among the others."""

from __future__ import annotations

from desire_tui.engine.nodes.record import Node, node


@node
class Faulty(Node):
    """A statement whose first word says what it was to be, but whose rest cannot be read.

    It stops a program that reaches it, and no other; `Program.faults` holds what is wrong. `word` is its
    keyword, aliases replaced, or NAME for an assignment or an invocation.
    """

    word: str
    start: int = 0
    end: int = 0
