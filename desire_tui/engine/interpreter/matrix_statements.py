"""`MATRIX`, `Vector`, `DOT`, `AVG` in scripts, on real arrays (language.md section 7; book, section 6.2)."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

import numpy as np

from desire_tui.engine.interpreter.array_expressions import ArrayExpressions, conform
from desire_tui.engine.interpreter.assignment import storer
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.left_chains import chain, signed_terms
from desire_tui.engine.nodes.assignments import Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.expressions import Expr, Name, Number, Transposed
from desire_tui.engine.nodes.signs import unsigned

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.values import Quantity

    Array = NDArray[np.float64]

TEMPORARIES = 3
"""Arrays of the target's size that a statement holds at a time."""


def computed(context: StatementContext, node: MatrixAssign | VectorAssign | Dot) -> Operation:
    """Make the operation of a statement that computes arrays."""
    match node:
        case MatrixAssign():
            return matrix(context, node)
        case VectorAssign():
            return vector(context, node)
        case Dot():
            return dot(context, node)
    assert_never(node)


def matrix(context: StatementContext, node: MatrixAssign) -> Operation:
    """`MATRIX C = A * B + …`; `= 1` the identity, `= 0` all zeroes; `DELTA` adds."""
    target = context.array(Name(node.name, node.start, node.end))
    if len(target.shape) != 2:
        raise ScriptFault("not-a-matrix", Name(node.name, node.start, node.end), name=node.name)
    rows, columns = target.shape
    expressions = ArrayExpressions(context, true_products=True)
    value = expressions.assigned(node.value, target.shape)
    bounded = _bounded(context, node)
    mask = context.numbers(context.array(Name(node.mask))) if node.mask else None
    view = context.numbers(target)
    identity = isinstance(node.value, Number) and node.value.value == 1.0 and not node.delta

    @np.errstate(all="ignore")  # the result is looked at
    def action() -> None:
        context.require_memory(TEMPORARIES * target.size, node)
        result = value()
        if identity:
            result = np.eye(rows, columns)
        if np.ndim(result) == 0 and not identity and not node.delta and result != 0.0:
            raise ScriptFault("matrix-from-number", node.value, name=node.name)
        result = conform(result, target.shape, node, node.name)
        result = bounded(view + result if node.delta else result)
        if mask is not None:
            np.copyto(view, result, where=conform(mask, target.shape, node, node.name) != 0.0)
        else:
            view[...] = result

    return context.then(action)


def vector(context: StatementContext, node: VectorAssign) -> Operation:
    """`Vector y = A * x + b`, `Vectr delta x = v`, `Vector y^ = v`, `Vector y = [m] v`."""
    target = context.array(Name(node.name, node.start, node.end))
    if len(target.shape) != 1:
        raise ScriptFault("not-a-vector", Name(node.name, node.start, node.end), name=node.name)
    value = ArrayExpressions(context, true_products=False).assigned(node.value, target.shape)
    bounded = _bounded(context, node)
    mask = context.numbers(context.array(Name(node.mask))) if node.mask else None
    view = context.numbers(target)

    @np.errstate(all="ignore")  # the result is looked at
    def action() -> None:
        context.require_memory(TEMPORARIES * target.size, node)
        result = conform(value(), target.shape, node, node.name)
        if node.delta:
            result = bounded(view + result)
        if node.largest:
            result = _largest_only(result)
        if mask is not None:
            result = np.where(conform(mask, target.shape, node, node.name) != 0.0, 0.0, result)
        view[...] = result

    return context.then(action)


def _bounded(context: StatementContext, node: MatrixAssign | VectorAssign) -> Callable[[Array], Array]:
    """Return what keeps elements between the two numbers behind a statement's `;`, if there are any."""
    if node.lower is None or node.upper is None:
        return lambda array: array
    lower, upper = context.real(node.lower), context.real(node.upper)
    return lambda array: np.clip(array, lower(), upper())


def _largest_only(vector: Array) -> Array:
    """Keep the largest element (ties: the highest index); all others become 0."""
    place = len(vector) - 1 - int(np.argmax(vector[::-1]))
    result = np.zeros_like(vector)
    result[place] = vector[place]
    return result


def dot(context: StatementContext, node: Dot) -> Operation:
    """`DOT s = u*v + u*1 + u*A*v + u*A%*v`; `AVG` divides by the vectors' length."""
    terms = [_DotTerm(context, sign, term) for sign, term in signed_terms(node.value)]
    store = storer(context, node.target)

    @np.errstate(all="ignore")  # the result is looked at
    def action() -> None:
        total = sum(term.value() for term in terms)
        store(float(total / terms[0].length if node.average else total))

    return context.then(action)


def _factors(node: Expr) -> list[Expr]:
    first, steps = chain(node)
    right: list[Expr] = []
    while steps and steps[-1].op == "*":
        right += _factors(steps.pop().right)[::-1]
    if not right:
        return [node]
    return [*_factors(steps[-1] if steps else first), *right[::-1]]


class _DotTerm:
    """One product: a vector, perhaps a matrix, and a vector or 1."""

    def __init__(self, context: StatementContext, sign: float, node: Expr) -> None:
        factors = _factors(node)
        if not 2 <= len(factors) <= 3:
            raise ScriptFault("script-dot-term", node)
        own, first = unsigned(factors[0])  # `-u*v`
        self._sign = sign * own
        left = self._vector(context, first)
        self._left = context.numbers(left)
        self.length = left.size
        last = factors[-1]
        ones = isinstance(last, Number) and last.value == 1.0 and len(factors) == 2
        self._right = None if ones else context.numbers(self._vector(context, last))
        self._matrix = self._find_matrix(context, factors[1]) if len(factors) == 3 else None
        shape = self._matrix.shape if self._matrix is not None else (self.length, self.length)
        right = self.length if self._right is None else len(self._right)
        if shape != (self.length, right):
            have = str(self.length) if self._matrix is None else f"{self.length}, {shape[0]}×{shape[1]}"
            raise ScriptFault("nonconformable", node, have=have, want=right)

    def _vector(self, context: StatementContext, node: Expr) -> Quantity:
        quantity = context.array(node)
        if len(quantity.shape) != 1:
            raise ScriptFault("not-a-vector", node, name=quantity.name)
        return quantity

    def _find_matrix(self, context: StatementContext, node: Expr) -> Array:
        name = Name(node.name, node.start, node.end) if isinstance(node, Transposed) else node
        quantity = context.array(name)
        if len(quantity.shape) != 2:
            raise ScriptFault("not-a-matrix", node, name=quantity.name)
        view = context.numbers(quantity)
        return view.T if isinstance(node, Transposed) else view

    def value(self) -> float:
        """Return the signed sum of products."""
        if self._right is None:
            return self._sign * float(np.sum(self._left))
        right = self._right if self._matrix is None else self._matrix @ self._right
        return self._sign * float(self._left @ right)
