"""Array expressions worked out element by element: those that draw random numbers or look up tables.

What neither draws nor looks up is evaluated first, as whole arrays. The rest becomes a function of one
element of each, called for the last element first: the order of draws in DYNAMIC segments (language.md 4.1).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.name_resolution import Local, Meaning
from desire_tui.engine.interpreter.user_functions import NUMBERS_OF_TABLE_FUNCTIONS, is_used_as_array
from desire_tui.engine.left_chains import OPERATORS, chain
from desire_tui.engine.nodes.conditions import with_compared
from desire_tui.engine.nodes.declarations import Function
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
from desire_tui.engine.nodes.signs import literal
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from desire_tui.engine.interpreter.array_shapes import ArrayShapes, Shape
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.expressions import Expr

    Evaluator = Callable[[], Any]

ELEMENTS_AT_ONCE = 10_000
"""Elements that a function is applied to before the user is let in."""


class ElementwiseExpressions:
    """Makes evaluators of expressions whose elements are worked out one by one.

    `evaluator` makes those of the parts that are evaluated as whole arrays.
    """

    def __init__(
        self, context: StatementContext, shapes: ArrayShapes, evaluator: Callable[[Expr], Evaluator]
    ) -> None:
        self._context, self._shapes, self._whole_evaluator = context, shapes, evaluator

    def needed(self, node: Expr) -> bool:
        """Whether an expression draws, or looks up an array's elements in a table."""
        return self._special(node, ())

    def _special(self, node: Expr, within: tuple[str, ...]) -> bool:
        match node:
            case Call(name, args):
                placed = self._context.machine.functions.definitions.get(name)
                if placed is not None:
                    body = placed.node.body if isinstance(placed.node, Function) else None
                    if body is not None and name not in within and self._special(body, (*within, name)):
                        return True
                elif name in DRAWS or (
                    name in NUMBERS_OF_TABLE_FUNCTIONS and not within and self._shapes.of(node)
                ):
                    return True
                return any(self._special(arg, within) for arg in args)
            case Element(_, subscripts):
                return any(self._special(part, within) for part in subscripts)
            case Unary(_, operand):
                return self._special(operand, within)
            case Binary():
                first, steps = chain(node) if node.op in OPERATORS else (node.left, [node])
                return any(self._special(part, within) for part in (first, *(step.right for step in steps)))
            case Truth():
                return True  # NumPy has no conditions that stop when the answer is known
            case Number() | Text() | Name() | Transposed() | Shifted() | RowOf() | Pair():
                return False
        assert_never(node)

    def is_whole(self, node: Expr) -> bool:
        """Whether an expression is no operation between elements: a true product, an inverse."""
        if isinstance(node, Binary):
            return self._shapes.is_product(node.op, self._shapes.of(node.left), self._shapes.of(node.right))
        return isinstance(node, Call) and node.name.startswith("$")

    def evaluator(self, node: Expr, shape: Shape) -> Evaluator:
        """Return a function that evaluates an expression to an array of this shape."""
        context = self._context
        wholes: list[Evaluator] = []
        dummies: dict[str, Meaning] = dict(context.scope.dummies)
        of_elements = self._of_elements(node, wholes, dummies)
        translator = context.translator.within(context.scope.inner(dummies))
        code, kind = translator.expression(of_elements)
        if kind is Kind.COMPLEX:
            raise ScriptFault("complex-not-possible", node)
        parameters = tuple(f"p{number}" for number in range(len(wholes)))
        body = [py.return_value(code)]
        function = context.machine.build.function(body, context.placed, context.code.text.source, parameters)
        check = context.machine.check

        def evaluate() -> Any:
            values = [whole() for whole in wholes]
            for value in values:
                if np.ndim(value) and np.shape(value) != shape:
                    sizes = ["×".join(map(str, s)) for s in (np.shape(value), shape)]
                    raise ScriptFault("nonconformable", node, have=sizes[0], want=sizes[1])
            return by_elements(function, values, shape, check)

        return evaluate

    def _of_elements(self, node: Expr, wholes: list[Evaluator], dummies: dict[str, Meaning]) -> Expr:
        """Return an expression of one element: what can be had as a whole becomes a dummy."""
        if literal(node) is not None:
            return node
        if self.is_whole(node) or not self.needed(node):
            name = f" {len(wholes)}"  # no name of the user's
            dummies[name] = Local(f"p{len(wholes)}", Kind.REAL)
            wholes.append(self._whole_evaluator(node))
            return Name(name, node.start, node.end)
        match node:
            case Unary(op, operand):
                return Unary(op, self._of_elements(operand, wholes, dummies), node.start, node.end)
            case Binary():
                return self._chain(node, wholes, dummies)
            case Call(name, args):
                by_name = self._passed_by_name(name, len(args))
                elements = [
                    arg if place in by_name else self._of_elements(arg, wholes, dummies)
                    for place, arg in enumerate(args)
                ]
                return Call(name, tuple(elements), node.start, node.end)
            case Truth(condition):
                changed = with_compared(condition, lambda part: self._of_elements(part, wholes, dummies))
                return Truth(changed, node.start, node.end)
            case Number() | Text() | Name() | Element() | Transposed() | Shifted() | RowOf() | Pair():
                return node
        assert_never(node)

    def _passed_by_name(self, name: str, count: int) -> Collection[int]:
        """Return which arguments of a call are arrays as such: tables, and what a FUNCTION uses as one."""
        placed = self._context.machine.functions.definitions.get(name)
        if placed is None or not isinstance(placed.node, Function):
            return range(NUMBERS_OF_TABLE_FUNCTIONS.get(name, count), count)
        body = placed.node.body
        return [at for at, dummy in enumerate(placed.node.dummies) if is_used_as_array(dummy, body)]

    def _chain(self, node: Binary, wholes: list[Evaluator], dummies: dict[str, Meaning]) -> Expr:
        """Rewrite a chain; its longest beginning that can be had as a whole is one dummy."""
        first, steps = chain(node) if node.op in OPERATORS else (node.left, [node])
        begin: Expr = first
        for number in range(len(steps) - 1, -1, -1):
            left = steps[number].left
            if isinstance(left, Binary) and number and (self.is_whole(left) or not self.needed(left)):
                begin, steps = left, steps[number:]
                break
        result = self._of_elements(begin, wholes, dummies)
        for step in steps:
            right = self._of_elements(step.right, wholes, dummies)
            result = Binary(step.op, result, right, step.start, step.end)
        return result


def by_elements(
    function: Callable[..., float], values: Sequence[Any], shape: Shape, check: Callable[[], None]
) -> Any:
    """Apply a function to each element of arrays and numbers, from the last to the first as draws go."""
    count = int(np.prod(shape)) if shape else 1
    columns = [np.broadcast_to(value, shape).ravel()[::-1] for value in values]
    backwards = np.empty(count)
    for first in range(0, count, ELEMENTS_AT_ONCE):
        last = min(first + ELEMENTS_AT_ONCE, count)
        if columns:
            rows = zip(*(column[first:last].tolist() for column in columns), strict=True)
            backwards[first:last] = [function(*row) for row in rows]
        else:
            backwards[first:last] = [function() for _ in range(first, last)]
        check()
    return backwards[::-1].reshape(shape)[()]
