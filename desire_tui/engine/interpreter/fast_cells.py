"""Scalars of the script as variables of a Python function: read at its beginning, written back at its end."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from desire_tui.engine.values import SCALAR_SLOTS

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

_BLIND = frozenset(
    "bad_subscript complex int integer_power loop_count overflow power step_is_zero to_integer undefined"  # noqa: SIM905 - a list of words reads better than a wall of quotes
    " ran gauss real_exp tim".split()
)
"""Helpers that look at their arguments alone, as do the library's functions (`f_NAME`)."""


def cells_as_variables(body: list[ast.stmt], blind: AbstractSet[str]) -> tuple[list[str], list[str]]:
    """Replace `c[slot]` of scalars by variables in `body`; return code that reads them and writes them back.

    Both are empty, and nothing is changed, where functions are called that may see the cells themselves
    (those of `blind` do not).
    """
    for statement in body:
        for part in ast.walk(statement):
            if isinstance(part, ast.Call) and not _is_blind(part.func, blind):
                return [], []
    transformer = _Variables()
    for statement in body:
        transformer.visit(statement)
    read = [f"x_{slot} = c[{slot}]" for slot in sorted(transformer.slots)]
    return read, [f"c[{slot}] = x_{slot}" for slot in sorted(transformer.written)]


def _is_blind(function: ast.expr, blind: AbstractSet[str]) -> bool:
    name = function.id if isinstance(function, ast.Name) else ""
    return name in _BLIND or name in blind or name.startswith("f_")


class _Variables(ast.NodeTransformer):
    """Replaces cells, and notes which."""

    def __init__(self) -> None:
        self.slots: set[int] = set()
        self.written: set[int] = set()

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        """Replace a scalar's cell."""
        slot = node.slice.value if isinstance(node.slice, ast.Constant) else None
        of_cells = isinstance(node.value, ast.Name) and node.value.id == "c"
        if not (of_cells and isinstance(slot, int) and slot < SCALAR_SLOTS):
            return self.generic_visit(node)
        self.slots.add(slot)
        if isinstance(node.ctx, ast.Store):
            self.written.add(slot)
        return ast.copy_location(ast.Name(f"x_{slot}", node.ctx), node)
