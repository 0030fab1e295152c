"""Taylor coefficients of a segment's states by NumPy: the yardstick of `codegen.taylor`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.lowered.expressions import Const
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.passes.series.nodes import Operand, SeriesProgram

    Array = NDArray[np.float64]


class ReferenceSeries:
    """Computes the coefficients from the values at a step's start; `data` are all values.

    `pieces` and `room`: where `give` writes the states' coefficients (`integration.taylor.solver.Layout`).
    """

    def __init__(self, program: SeriesProgram, data: Array) -> None:
        self._program, self._data = program, data
        self.pieces: list[tuple[int, int, int, int]] = []
        self.room = 0
        for piece in program.states:
            self.pieces.append((piece.first, piece.count, self.room, piece.count))
            self.room += piece.count * (ORDER_MOST + 1)
        self.mode_count, self.conditions = program.mode_count, program.conditions
        self.arguments: list[tuple[int, int]] = []
        for operand, _ in program.arguments:
            self.arguments.append((self.room, 1) if isinstance(operand, Series) else (-1, 0))
            self.room += ORDER_MOST + 1
        self._square_roots = [node for node in program.nodes if node.kind == "sqrt"]
        self.roots: list[tuple[int, int, int]] = []
        for node in self._square_roots:
            self.roots.append((self.room, node.size, node.size))
            self.room += node.size * (ORDER_MOST + 1)
        self._derivatives = {piece.series.number: piece.derivative for piece in program.states}
        self._rows: dict[int, list[Array]] = {}

    def compute(self, order: int) -> None:
        """Compute coefficients 0 … `order` of all series: what `values_pass` sets must be there."""
        nodes = self._program.nodes
        self._order = order
        self._rows = {
            node.number: [self._values(node)] + [np.zeros(node.size) for _ in range(order)] for node in nodes
        }
        for k in range(1, order + 1):
            for node in nodes:
                self._rows[node.number][k][:] = self._coefficient(node, k)

    def _values(self, node: Series) -> Array:
        """Return coefficients 0."""
        if node.slots:
            return self._data[list(node.slots)]
        return self._data[node.slot : node.slot + node.size].copy()

    def give(self, order: int, coefficients: Array) -> None:
        """Compute coefficients, and write states', arguments' and roots' where the solver reads them."""
        self.compute(order)
        for piece, (_, count, place, _) in zip(self._program.states, self.pieces, strict=True):
            flat = np.concatenate(self._rows[piece.series.number])
            coefficients[place : place + count * (order + 1)] = flat
        for (operand, at), (place, _) in zip(self._program.arguments, self.arguments, strict=True):
            if isinstance(operand, Series):
                coefficients[place : place + order + 1] = [row[at] for row in self._rows[operand.number]]
        for node, (place, _, count) in zip(self._square_roots, self.roots, strict=True):
            coefficients[place : place + count * (order + 1)] = np.concatenate(self._rows[node.number])

    def rows(self, operand: Operand) -> list[Array]:
        """Return an operand's coefficients, one array of all elements for each order."""
        if isinstance(operand, Series):
            return self._rows[operand.number]
        size = operand.count or 1
        return [np.zeros(size) + self._constant(operand)] + [np.zeros(size) for _ in range(self._order)]

    def _constant(self, constant: Constant) -> Array | float:
        if isinstance(constant.value, Const):
            return constant.value.value
        return self._data[constant.slot : constant.slot + (constant.count or 1)]

    def _coefficient(self, node: Series, k: int) -> Array | float:
        if node.kind == "time":
            return float(k == 1)
        if node.kind == "state":
            derivative = self._derivatives[node.number]
            if isinstance(derivative, Constant):
                return self._constant(derivative) if k == 1 else 0.0
            return self._rows[derivative.number][k - 1] / k
        recurrence: Callable[[Series, int], Array | float] = getattr(self, f"_{node.kind}")
        return recurrence(node, k)

    def _raised(self, node: Series, k: int) -> Array:
        """Return the k-th coefficient of the only series among the operands."""
        (rows,) = (self._rows[o.number] for o in node.operands if isinstance(o, Series))
        return rows[k]

    def _other(self, node: Series) -> Array | float:
        """Return the constant among the operands."""
        return next(self._constant(o) for o in node.operands if isinstance(o, Constant))

    def _mul(self, node: Series, k: int) -> Array:
        a, b = (self.rows(o) for o in node.operands)
        return _convolution(a, b, k, 0, k)

    def _div(self, node: Series, k: int) -> Array:
        u = self._rows[node.number]
        a, b = (self.rows(o) for o in node.operands)
        return (a[k] - _convolution(u, b, k, 0, k - 1)) / b[0]

    def _sqrt(self, node: Series, k: int) -> Array:
        u = self._rows[node.number]
        return (self._raised(node, k) - _convolution(u, u, k, 1, k - 1)) / (2.0 * u[0])

    def _integral(self, node: Series, k: int) -> Array:
        a, b = (self.rows(o) for o in node.operands)
        return _convolution(_slopes(b), a, k, 1, k) / k

    def _quotient(self, node: Series, k: int) -> Array:
        u = self._rows[node.number]
        a, b = (self.rows(o) for o in node.operands)
        return (k * a[k] - _convolution(_slopes(u), b, k, 1, k - 1)) / (b[0] * k)

    def _power(self, node: Series, k: int) -> Array:
        """Return u_k from Σ (b·j - (k - j))·a_j·u_{k-j} = 0, j from 0 to k."""
        u, a, exponent = self._rows[node.number], self.rows(node.operands[0]), self._other(node)
        total = np.zeros(node.size)
        for j in range(1, k + 1):
            total = total + (exponent * j - (k - j)) * a[j] * u[k - j]
        return total / (k * a[0])

    def _select(self, node: Series, k: int) -> Array:
        condition, yes, no = node.operands
        assert isinstance(condition, Constant)
        return np.where(np.asarray(self._constant(condition)) > 0.0, self.rows(yes)[k], self.rows(no)[k])

    def _shift(self, node: Series, k: int) -> Array:
        row = self._raised(node, k)
        moved = np.zeros_like(row)
        n, by = len(row), node.by
        if abs(by) < n:
            moved[max(-by, 0) : n - max(by, 0)] = row[max(by, 0) : n - max(-by, 0)]
        return moved

    def _product(self, node: Series, k: int) -> Array:
        assert node.matrix is not None
        slot, rows, columns, transposed = node.matrix
        matrix = self._data[slot : slot + rows * columns].reshape(rows, columns)
        result: Array = (matrix.T if transposed else matrix) @ self._raised(node, k)
        return result

    def _gather(self, node: Series, k: int) -> Array:
        return np.array(
            [0.0 if isinstance(o, Constant) else self._rows[o.number][k][at] for o, at in node.lanes]
        )

    def _add(self, node: Series, k: int) -> Array:
        a, b = (self.rows(o) for o in node.operands)
        return a[k] + b[k]

    def _sub(self, node: Series, k: int) -> Array:
        a, b = (self.rows(o) for o in node.operands)
        return a[k] - b[k]

    def _neg(self, node: Series, k: int) -> Array:
        return -self._raised(node, k)

    def _times(self, node: Series, k: int) -> Array:
        return self._raised(node, k) * self._other(node)

    def _plus_times(self, node: Series, k: int) -> Array:
        rest, term, _ = node.operands
        return self.rows(rest)[k] + self.rows(term)[k] * self._other(node)

    def _over(self, node: Series, k: int) -> Array:
        return self._raised(node, k) / self._other(node)

    def _total(self, node: Series, k: int) -> float:
        return float(self._raised(node, k).sum())

    def _element(self, node: Series, k: int) -> float:
        return float(self._raised(node, k)[node.by])


def _slopes(rows: list[Array]) -> list[Array]:
    """Return j times the j-th coefficients."""
    return [j * row for j, row in enumerate(rows)]


def _convolution(a: list[Array], b: list[Array], k: int, first: int, last: int) -> Array:
    """Sum a_j·b_{k-j} for j from `first` to `last`."""
    width = max(len(a[0]), len(b[0]))
    total = np.zeros(width)
    for j in range(first, last + 1):
        total = total + a[j] * b[k - j]
    return total
