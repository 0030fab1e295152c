"""Recurrences of short arrays: the elements' coefficients of the order in turn are vectors in registers.

No element waits for memory: what is gathered from other arrays is shuffled (`shuffles`). The sums of products
of a turn are made at its start, from the rows of lower orders (`row_sums`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.row_sums import RowSums, Term
from desire_tui.engine.codegen.taylor.short_starts import ShortStarts, vectors
from desire_tui.engine.codegen.taylor.shuffles import Lane, collected
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.vector import Weight
    from desire_tui.engine.passes.series.nodes import SeriesProgram


class ShortArrays(VectorRecurrences):
    """Has the methods of `VectorRecurrences`, in which an index is here the number of a vector."""

    def __init__(self, frame: Frame, program: SeriesProgram) -> None:
        super().__init__(frame, machine().width)
        self._lanes = Fused(frame.text, machine().width)
        self._arrays = [node for node in program.nodes if node.count is not None]
        self._states = [piece for piece in program.states if piece.series.count is not None]
        self._starts = ShortStarts(frame)
        self._sums = RowSums(frame)
        self._now: dict[int, list[str]] = {}
        self._cells: dict[int, list[str]] = {}
        """Of states: where the derivative's coefficients are handed on to the next turn."""
        self._node: Series | None = None

    # ------------------------------------------------------------------ before the orders

    def load_constant(self, constant: Constant) -> None:
        """Read an array that stays what it is."""
        self._starts.load_constant(constant)

    def load_first(self, node: Series) -> None:
        """Compute or read coefficients 0."""
        self._keep(node, self._starts.load(node), "0")

    def element_first(self, node: Series) -> str:
        """Return coefficient 0 of a number that is an array's element."""
        return self._element(node, self._starts.rows)

    def prepare(self, node: Series) -> None:
        """Compute one over what an array's coefficients are divided by."""
        if node.kind in {"div", "over", "quotient"}:
            self._starts.divide_by(node.operands[1], node.size)
        elif node.kind == "power":
            self._starts.divide_by(node.operands[0], node.size)
        elif node.kind == "sqrt":
            self._starts.divide_by(node, node.size)

    def before_orders(self) -> None:
        """Write what stands before the loop over the orders."""
        for piece in self._states:
            size = vectors(piece.series.size)
            cells = self._cells[piece.series.number] = [
                self._frame.text.alloca(self._lanes.kind) for _ in size
            ]
            for i, cell in zip(size, cells, strict=True):
                self._hand_on(cell, self._first(piece.derivative, str(i)))
        self._sums.begin([term for term in map(self._term, self._arrays) if term is not None])

    def _term(self, node: Series) -> Term | None:
        """Return which products an array's coefficients consist of; None: of none."""
        weight: Weight | None = None
        match node.kind:
            case "mul":
                a, b = node.operands
            case "div":
                a, b = node, node.operands[1]
            case "sqrt":
                a, b = node, node
            case "integral":
                b, a = node.operands
                weight = self._slope
            case "quotient":
                a, b, weight = node, node.operands[1], self._slope
            case "power":
                a, b, weight = node.operands[0], node, self._by_power(node.operands[1])
            case _:
                return None
        if isinstance(a, Constant) or isinstance(b, Constant):
            return None
        return Term(node, a, b, weight)

    # ------------------------------------------------------------------ the order in turn

    def turn(self) -> None:
        """Write the sums of products of lower orders."""
        self._sums.turn()

    def state(self, node: Series, derivative: Series | Constant) -> None:  # noqa: ARG002 - it was handed on
        """Write an array of states' k-th coefficients: the derivatives' one order lower, divided by k."""
        read = f"load {self._lanes.kind}, ptr"
        self._put(
            node, [self._over_order(self._frame.text.op(f"{read} {c}")) for c in self._cells[node.number]]
        )

    def end_turn(self) -> None:
        """Hand the derivatives on to the next turn."""
        for piece in self._states:
            for i, cell in enumerate(self._cells[piece.series.number]):
                self._hand_on(cell, self._of(piece.derivative, str(i)))

    def write(self, node: Series) -> None:
        """Write what computes an array's k-th coefficients."""
        if node.kind == "gather":
            self._put(node, self._gathered(node))
            return
        self._node = node
        element: Callable[[Series, str], str] = getattr(self, f"_element_{node.kind}")
        self._put(node, [element(node, str(i)) for i in vectors(node.size)])

    def number(self, node: Series) -> str:
        """Write a number that is an array's element."""
        return self._element(node, self._now)

    def _element(self, node: Series, rows: dict[int, list[str]]) -> str:
        (given,) = node.operands
        assert isinstance(given, Series)
        which, lane = divmod(node.by, self._lanes.width)
        vector = f"{self._lanes.kind} {rows[given.number][which]}"
        return self._frame.text.op(f"extractelement {vector}, i64 {lane}")

    def _gathered(self, node: Series) -> list[str]:
        width = self._lanes.width

        def lane(operand: Series | Constant, at: int) -> Lane:
            if isinstance(operand, Constant) or operand.count is None:
                return Lane(self._frame.coefficient(operand), None)
            return Lane(self._now[operand.number][at // width], at % width)

        return collected(self._lanes, [lane(*given) for given in node.lanes])

    def _hand_on(self, cell: str, values: str) -> None:
        self._frame.text.do(f"store {self._lanes.kind} {values}, ptr {cell}")

    def _put(self, node: Series, values: list[str]) -> None:
        self._now[node.number] = values
        self._keep(node, values, "%k")

    def _keep(self, node: Series, values: Iterable[str], order: str) -> None:
        """Put coefficients where sums of products, or the solver, read them."""
        layout, text = self._frame.layout, self._frame.text
        if not layout.has_place(node):
            return
        row = self._frame.at(layout.place(node), text.op(f"mul i64 {order}, {layout.apart(node)}"))
        for i, vector in enumerate(values):
            at = text.op(f"getelementptr {self._lanes.kind}, ptr {row}, i64 {i}")
            text.do(f"store {self._lanes.kind} {vector}, ptr {at}, align 8")

    # ------------------------------------------------------------------ operands

    def _of(self, operand: Series | Constant, i: str) -> str:
        if isinstance(operand, Constant):
            return self._lanes.const(0.0)
        if operand.count is None:
            return self._lanes.splat(self._frame.now[operand.number])
        return self._now[operand.number][int(i)]

    def _first(self, operand: Series | Constant, i: str) -> str:
        return self._starts.get(operand, int(i))

    def _constant(self, constant: Constant, i: str) -> str:
        return self._starts.get(constant, int(i))

    def _over_first(self, values: str, divisor: Series | Constant, i: str) -> str:
        return self._lanes.mul(values, self._starts.reciprocal(divisor, int(i)))

    def _square(self, a: Series | Constant, i: str, first: int) -> str:
        assert self._node is not None
        lanes, known = self._lanes, self._sums.known(self._node, int(i))
        if first:
            return known
        return lanes.mul_add(lanes.mul(lanes.const(2.0), self._first(a, i)), self._of(a, i), known)

    def _products(
        self,
        a: Series | Constant,
        b: Series | Constant,
        i: str,
        first: int,
        less: int,
        weight: Weight | None = None,
    ) -> str:
        assert self._node is not None
        lanes, total = self._lanes, self._sums.known(self._node, int(i))
        if less == 0:
            newest = self._of(a, i)
            newest = newest if weight is None else weight("%kf", newest, i)
            total = lanes.mul_add(newest, self._first(b, i), total)
        if first == 0:
            total = lanes.mul_add(self._first(a, i), self._of(b, i), total)
        return total
