"""Expressions over whole arrays, evaluated by NumPy.

Products are true matrix products in `MATRIX` statements; in `Vector` statements a matrix times a vector is
one too, and two vectors multiply element by element. Scalars multiply and add everywhere.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.interpreter.array_shapes import ArrayShapes
from desire_tui.engine.interpreter.elementwise import (
    ELEMENTS_AT_ONCE,
    ElementwiseExpressions,
    by_elements,
)
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.interruptible import run_interruptibly
from desire_tui.engine.left_chains import OPERATORS, chain
from desire_tui.engine.library import LIBRARY, integer_power, power, shifted_by
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
from desire_tui.engine.nodes.signs import whole_power

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.interpreter.elementwise import Evaluator
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.values import Quantity


_SINGULAR = 1e-15
"""A matrix whose reciprocal condition number (1-norm) is below this is called singular."""


class ArrayExpressions:
    """Makes evaluators of array expressions for one statement."""

    def __init__(self, context: StatementContext, *, true_products: bool) -> None:
        self._context = context
        self._true_products = true_products
        self._shapes = ArrayShapes(context.scope, true_products=true_products)
        self._elements = ElementwiseExpressions(context, self._shapes, self.evaluator)

    def assigned(self, node: Expr, shape: tuple[int, ...]) -> Evaluator:
        """Return a function that evaluates what is assigned to an array of this shape.

        An expression that draws random numbers draws for each element, a number alone is not spread.
        """
        if self._elements.needed(node) and not self._elements.is_whole(node):
            return self._elements.evaluator(node, shape)
        return self.evaluator(node)

    def evaluator(self, node: Expr) -> Evaluator:
        """Return a function that evaluates an expression to a float, a vector or a matrix."""
        shape = self._shapes.of(node)
        if not shape:
            return self._context.real(node)
        if self._elements.needed(node):
            if not self._elements.is_whole(node):
                return self._elements.evaluator(node, shape)
            if isinstance(node, Binary):
                return self._whole(node)
        match node:
            case Name():
                view = self._context.numbers(self._context.array(node))
                return lambda: view
            case Transposed(name):
                view = self._context.numbers(self._matrix(Name(name, node.start, node.end)))
                return lambda: view.T
            case Shifted():
                return self._shifted(node)
            case Unary(op, operand):
                inner = self.evaluator(operand)
                return inner if op == "+" else lambda: -inner()
            case Binary():
                return self._chain(node) if node.op in OPERATORS else self._power(node)
            case Call():
                return self._call(node)
            case Number() | Text() | Element() | Pair() | RowOf() | Truth():
                raise ScriptFault("not-in-array-expression", node)
        assert_never(node)

    def _matrix(self, node: Expr) -> Quantity:
        quantity = self._context.array(node)
        if len(quantity.shape) != 2:
            raise ScriptFault("not-a-matrix", node, name=quantity.name)
        return quantity

    def _shifted(self, node: Shifted) -> Evaluator:
        quantity = self._context.array(Name(node.name, node.start, node.end))
        if len(quantity.shape) != 1:
            raise ScriptFault("not-a-vector", node, name=node.name)
        view, by, size = self._context.numbers(quantity), self._context.real(node.by), quantity.size

        def evaluate() -> NDArray[np.float64]:
            k = shifted_by(by(), size)
            result = np.zeros(size)
            result[max(0, -k) : size - max(0, k)] = view[max(0, k) : size + min(0, k)]
            return result

        return evaluate

    def _chain(self, node: Binary) -> Evaluator:
        """Evaluate sums and products; what stands before the first array is a scalar expression."""
        first, steps = chain(node)
        begin: Expr = first
        if not self._shapes.of(first):
            scalars = next(i for i, step in enumerate(steps) if self._shapes.of(step.right))
            begin = steps[scalars - 1] if scalars else first
            steps = steps[scalars:]
        start, check = self.evaluator(begin), self._context.machine.check
        operations = [(self._operation(step), self.evaluator(step.right)) for step in steps]

        def evaluate() -> Any:
            result = start()
            for operation, right in operations:
                check()
                result = operation(result, right())
            return result

        return evaluate

    def _whole(self, node: Binary) -> Evaluator:
        """Evaluate a product whose operands draw, each for itself."""
        left, right, operation = self.evaluator(node.left), self.evaluator(node.right), self._operation(node)
        return lambda: operation(left(), right())

    def _operation(self, node: Binary) -> Callable[[Any, Any], Any]:
        match node.op:
            case "+":
                return lambda a, b: np.add(*self._same(a, b, node))
            case "-":
                return lambda a, b: np.subtract(*self._same(a, b, node))
            case "*":
                return lambda a, b: self._product(a, b, node)
            case "/":
                return lambda a, b: _quotient(*self._same(a, _finite(b, node.right), node), node.right)
        return np.minimum.outer

    def _power(self, node: Binary) -> Evaluator:
        a, b = self.evaluator(node.left), self.evaluator(node.right)
        check = self._context.machine.check
        domain, exponent = "power-argument", whole_power(node.right)
        if exponent is not None:
            whole = partial(integer_power, n=exponent)
            return lambda: _elementwise(check, whole, node, domain, a())
        return lambda: _elementwise(check, power, node, domain, *self._same(a(), b(), node))

    def _same(self, a: Any, b: Any, node: Node) -> tuple[Any, Any]:
        if np.ndim(a) and np.ndim(b) and np.shape(a) != np.shape(b):
            raise ScriptFault("nonconformable", node, have=_size(a), want=_size(b))
        return a, b

    def _product(self, a: Any, b: Any, node: Node) -> Any:
        dimensions = np.ndim(a), np.ndim(b)
        if 0 in dimensions:
            return a * b
        if dimensions == (1, 1):
            return np.multiply.outer(a, b) if self._true_products else np.multiply(*self._same(a, b, node))
        if np.shape(a)[-1] != np.shape(b)[0]:
            raise ScriptFault("nonconformable", node, have=_size(a), want=_size(b))
        if dimensions != (2, 2):
            return a @ b
        own = a.copy(), b.copy()  # the product may outlive the statement (`run_interruptibly`)
        return run_interruptibly(a.size * b.shape[1], lambda: own[0] @ own[1], self._context.machine.check)

    def _call(self, node: Call) -> Evaluator:
        args = [self.evaluator(arg) for arg in node.args]
        if node.name == "$In" and len(args) == 1:
            return lambda: _inverse(args[0](), node, self._context.machine.check)
        if node.name == "$Tr" and len(args) == 1:
            return lambda: np.transpose(args[0]())
        if node.name in self._context.machine.functions.definitions:
            return self._own_function(node, args)
        entry, own = LIBRARY.get(node.name), self._context.scope.functions
        if entry is None and node.name not in own:
            close = closest(node.name, [*LIBRARY, *own])
            raise ScriptFault("undefined-function", node, name=node.name, close=close)
        if entry is None or entry.value is None or entry.gives_complex:
            raise ScriptFault("takes-no-array", node, name=node.name)
        if not entry.fewest <= len(args) <= entry.most:
            raise ScriptFault(
                "argument-count", node, name=node.name, given=len(args), needed=entry.parameters
            )
        function, check = entry.value, self._context.machine.check

        domain = entry.domain_error
        return lambda: _elementwise(check, function, node, domain, *(_finite(arg(), node) for arg in args))

    def _own_function(self, node: Call, args: list[Evaluator]) -> Evaluator:
        """Apply the program's FUNCTION to each element, from the last to the first as random draws go."""
        function, wanted = self._context.machine.functions.of_elements(node, self._context.translator)
        used = [arg for arg, is_wanted in zip(args, wanted, strict=True) if is_wanted]

        def evaluate() -> Any:
            values = [_finite(arg(), node) for arg in used]
            arrays = [value for value in values if np.ndim(value)]
            for other in arrays[1:]:
                self._same(arrays[0], other, node)
            shape = np.shape(arrays[0]) if arrays else ()
            return by_elements(function, values, shape, self._context.machine.check)

        return evaluate


def _elementwise(
    check: Callable[[], None],
    function: Callable[..., complex],
    node: Node,
    domain: str,
    *args: Any,
) -> Any:
    """Apply a library function to each element, some thousand at a time; `domain` names its ValueErrors."""
    each = np.vectorize(function, otypes=[np.float64])
    flat = [column.ravel() for column in np.broadcast_arrays(*args)]
    result = np.empty(flat[0].size)
    try:
        for first in range(0, len(result), ELEMENTS_AT_ONCE):
            piece = slice(first, first + ELEMENTS_AT_ONCE)
            result[piece] = each(*(column[piece] for column in flat))
            check()
    except ZeroDivisionError:
        raise ScriptFault("division-by-zero", node) from None
    except OverflowError:
        raise ScriptFault("overflow", node) from None
    except ValueError:
        raise ScriptFault(domain, node, function=getattr(node, "name", "")) from None
    return result.reshape(np.broadcast_shapes(*map(np.shape, args)))[()]


def _quotient(a: Any, b: Any, divisor: Node) -> Any:
    if np.any(np.equal(b, 0.0)):
        raise ScriptFault("division-by-zero", divisor)
    return np.divide(a, b)


def _inverse(matrix: Any, node: Node, check: Callable[[], None]) -> Any:
    """Invert by LAPACK's LU decomposition; error 123 for a matrix that is singular to working precision."""
    if np.ndim(matrix) != 2 or matrix.shape[0] != matrix.shape[1]:
        raise ScriptFault("not-square", node, have=_size(matrix))
    own = matrix.copy()
    try:
        inverse = run_interruptibly(2 * len(own) ** 3, lambda: np.linalg.inv(own), check)
    except np.linalg.LinAlgError:
        raise ScriptFault("singular-matrix", node) from None
    condition = np.linalg.norm(own, 1) * np.linalg.norm(inverse, 1)
    if not condition * _SINGULAR < 1.0:
        raise ScriptFault("singular-matrix", node)
    return inverse


def conform(value: Any, shape: tuple[int, ...], node: Node, name: str) -> NDArray[np.float64]:
    """Return a value spread over a target's shape; errors 3 and 74."""
    if np.ndim(value) and np.shape(value) != shape:
        have = _size(value)
        raise ScriptFault("nonconformable", node, have=have, want=f"{name}[{','.join(map(str, shape))}]")
    return np.array(np.broadcast_to(_finite(value, node), shape), dtype=np.float64)


def _finite(value: Any, node: Node) -> Any:
    """Return the value; error 3 for an infinite one."""
    if not np.all(np.isfinite(value)):
        raise ScriptFault("overflow", node)
    return value


def _size(value: Any) -> str:
    return "×".join(map(str, np.shape(value))) or "a number"
