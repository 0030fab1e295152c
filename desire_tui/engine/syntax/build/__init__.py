"""One method for each production of `desire.lark`: children in, node out.

A node made here is a *pattern*: `start` and `end` hold token numbers, and names, numbers and strings
remember the token they came from, so that `shapes` can make the same node again from another statement's
tokens.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from desire_tui.engine.syntax.build.children import Kids, Misuse, NumberToken, Token, Value
from desire_tui.engine.syntax.build.expressions import ExpressionProductions
from desire_tui.engine.syntax.build.script import ScriptProductions
from desire_tui.engine.syntax.build.segment import Dynamic

if TYPE_CHECKING:
    from desire_tui.engine.nodes.record import Node


class NodeBuilder(ExpressionProductions, ScriptProductions, Dynamic):
    """The productions' methods. `kids` are the children, tokens included; offsets are token numbers."""

    def token(self, kind: str, text: str, number: int) -> Token:
        """Wrap a token."""
        token = Token(text)
        token.kind, token.number = kind, number
        return token

    def make(self, method: str, kids: Kids, first: int, last: int) -> Node:
        """Make the node of a production; raises Misuse."""
        return cast("Node", getattr(self, method)(kids, first, last))


__all__ = ["Misuse", "NodeBuilder", "NumberToken", "Token", "Value"]
