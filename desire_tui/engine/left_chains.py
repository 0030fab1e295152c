"""Long sums and products: chains of operations whose left operands nest as deep as they are long.

`a + b + … + z` is a tree that leans to the left. Every pass that recurses into operands walks down such a
chain in a loop, so that a sum may have any number of terms; only true nesting is limited
(`syntax.automaton`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.expressions import Binary, Unary

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.record import Node

OPERATORS = frozenset("+-*/&")
"""Operations that group from the left."""

LONG = 400
"""Characters from which on an expression may be too deep for one piece; a level takes two at least."""

PIECE = 50
"""Operations of a long chain that are computed in one piece, before the rest goes on from its result."""


def chain(node: Expr) -> tuple[Expr, list[Binary]]:
    """Return the leftmost operand of a chain and its operations in the order in which they are computed."""
    steps: list[Binary] = []
    while isinstance(node, Binary) and node.op in OPERATORS:
        steps.append(node)
        node = node.left
    steps.reverse()
    return node, steps


def signed_terms(node: Expr, sign: float = 1.0) -> list[tuple[float, Expr]]:
    """Split a sum into its terms with their signs (1 or −1), from left to right."""
    if isinstance(node, Unary):
        return signed_terms(node.operand, -sign if node.op == "-" else sign)
    following: list[tuple[float, Expr]] = []
    first, steps = chain(node)
    while steps and steps[-1].op in "+-":
        step = steps.pop()
        following += signed_terms(step.right, sign if step.op == "+" else -sign)[::-1]
    if not following:
        return [(sign, node)]
    return [*signed_terms(steps[-1] if steps else first, sign), *following[::-1]]


def is_long(node: Node) -> bool:
    """Whether an expression may be too deep for recursion, by its length in the text."""
    return node.end - node.start >= LONG
