"""Shapes of array expressions before they are evaluated."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.interpreter.user_functions import NUMBERS_OF_TABLE_FUNCTIONS
from desire_tui.engine.left_chains import chain
from desire_tui.engine.nodes.conditions import compared
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Name,
    Number,
    Pair,
    RowOf,
    Shifted,
    Text,
    Transposed,
    Truth,
    Unary,
)
from desire_tui.engine.values import Quantity

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.name_resolution import NameScope
    from desire_tui.engine.nodes.expressions import Expr

Shape = tuple[int, ...]


class ArrayShapes:
    """Shapes of array expressions, as far as the declarations show: `()` for numbers."""

    def __init__(self, scope: NameScope, *, true_products: bool) -> None:
        self._scope = scope
        self._true_products = true_products

    def of(self, node: Expr) -> Shape:
        """Return an expression's shape, that of its first array where shapes do not fit."""
        match node:
            case Name(name) | Transposed(name) | Shifted(name) | RowOf(name):
                meaning = self._scope.find(name)
                shape = meaning.shape if isinstance(meaning, Quantity) else ()
                return shape if isinstance(node, Name) else shape[::-1] or (0,)
            case Unary(_, operand):
                return self.of(operand)
            case Binary(op="^"):
                return self.of(node.left) or self.of(node.right)
            case Binary():
                first, steps = chain(node)
                shape = self.of(first)
                for step in steps:
                    shape = self._joined(step.op, shape, self.of(step.right))
                return shape
            case Call(name, args):
                shapes = [self.of(arg) for arg in args[: NUMBERS_OF_TABLE_FUNCTIONS.get(name, len(args))]]
                shape = next(filter(None, shapes), ())
                return shape[::-1] if name == "$Tr" else shape
            case Truth(condition):
                return next(filter(None, map(self.of, compared(condition))), ())
            case Number() | Text() | Element() | Pair():
                return ()
        assert_never(node)

    def _joined(self, op: str, left: Shape, right: Shape) -> Shape:
        if not (left and right):
            return left or right
        if op == "&" or (op == "*" and len(left) == len(right) == 1 and self._true_products):
            return left + right
        return left[:-1] + right[1:] if self.is_product(op, left, right) else left

    def is_product(self, op: str, left: Shape, right: Shape) -> bool:
        """Whether an operation between such shapes is not one between elements."""
        if not (left and right):
            return False
        return op == "&" or (op == "*" and (self._true_products or len(left) != 1 or len(right) != 1))
