"""Recurrences of short arrays: the elements' coefficients of the order in turn are vectors in registers.

No element waits for memory: what is gathered from other arrays is shuffled. The sums of products of a turn
are made at its start, from the rows of lower orders, many side by side in one loop (`row_sums`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.row_sums import RowSums, Term
from desire_tui.engine.codegen.taylor.shuffles import Lane, collected
from desire_tui.engine.codegen.taylor.vector import VectorRecurrences
from desire_tui.engine.lowered.expressions import Const
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.vector import Weight
    from desire_tui.engine.passes.series.nodes import SeriesProgram

_ROOTS = frozenset((-2.5, -1.5, -0.5, 0.5, 1.5, 2.5))
"""Powers whose coefficient 0 is a root times a few factors, as in `passes.series.functions`."""


def vectors(size: int) -> int:
    """Return how many vectors an array takes."""
    return -(-size // machine().width)


class ShortArrays(VectorRecurrences):
    """Has the methods of `VectorRecurrences`, in which an index is here the number of a vector."""

    def __init__(self, frame: Frame, program: SeriesProgram) -> None:
        super().__init__(frame, machine().width)
        self._lanes = Fused(frame.text, machine().width)
        self._states = [piece for piece in program.states if piece.series.count is not None]
        self._now: dict[int, list[str]] = {}
        self._first_rows: dict[int, list[str]] = {}
        self._constants: dict[int, list[str]] = {}
        self._reciprocals: dict[int, list[str]] = {}
        self._carried: dict[int, list[str]] = {}
        """Cells of the states' derivatives, which are one order behind."""
        self._sums = RowSums(frame)
        self._program = program
        self._node: Series | None = None

    # ------------------------------------------------------------------ before the orders

    def load_first(self, node: Series) -> None:
        """Read or compute coefficients 0."""
        rows = self._first_rows[node.number] = self._made_first(node) or self._read(node)
        self._keep(node, rows)

    def element_first(self, node: Series) -> str:
        """Return coefficient 0 of a number that is an array's element."""
        return self._element(node, self._first_rows)

    def before_orders(self) -> None:
        """Write what stands before the loop over the orders."""
        for piece in self._states:
            cells = self._carried[piece.series.number] = []
            for i in range(vectors(piece.series.size)):
                cells.append(self._frame.text.alloca(self._lanes.kind))
                self._carry(cells[-1], self._first(piece.derivative, str(i)))
        arrays = [node for node in self._program.nodes if node.count is not None]
        self._sums.begin([term for term in map(self._term, arrays) if term is not None])

    def _made_first(self, node: Series) -> list[str] | None:
        """Compute coefficients 0 that follow from the operands'; None: they have to be read."""
        if node.kind == "gather":
            if any(isinstance(operand, Constant) for operand in node.operands):
                return None
            return self._gathered(node, self._first_rows, self._frame.first)
        make: Callable[[Series, str], str] | None = getattr(self, f"_first_{node.kind}", None)
        if make is None or (node.kind == "power" and not _exponent(node) not in _ROOTS):
            return None
        return [make(node, str(i)) for i in range(vectors(node.size))]

    def _read(self, node: Series) -> list[str]:
        if not node.slots:
            self._frame.loaded.append((node.slot, node.size))
            return self._loaded(node.slot, node.size)
        self._frame.loaded += [(slot, 1) for slot in node.slots]
        frame = self._frame
        given = [Lane(frame.text.op(f"load double, ptr {frame.slot(slot)}"), None) for slot in node.slots]
        return collected(self._lanes, given)

    def _loaded(self, slot: int, size: int) -> list[str]:
        """Read an array; lanes behind its end are 1."""
        text, lanes, width = self._frame.text, self._lanes, self._lanes.width
        found = []
        for first in range(0, size, width):
            at = self._frame.slot(slot + first)
            if first + width <= size:
                found.append(text.op(f"load {lanes.kind}, ptr {at}, align 8"))
                continue
            mask = ", ".join(f"i1 {str(first + lane < size).lower()}" for lane in range(width))
            name = f"llvm.masked.load.{lanes.suffix}.p0"
            text.declarations.add(f"declare {lanes.kind} @{name}(ptr, <{width} x i1>, {lanes.kind})")
            found.append(
                text.op(f"call {lanes.kind} @{name}(ptr align 8 {at}, <{width} x i1> <{mask}>, "
                        f"{lanes.kind} {lanes.const(1.0)})")
            )  # fmt: skip
        return found

    def _firsts(self, node: Series, i: str) -> list[str]:
        return [self._first(operand, i) for operand in node.operands]

    def _first_add(self, node: Series, i: str) -> str:
        return self._lanes.add(*self._firsts(node, i))

    def _first_sub(self, node: Series, i: str) -> str:
        return self._lanes.sub(*self._firsts(node, i))

    def _first_neg(self, node: Series, i: str) -> str:
        return self._lanes.neg(*self._firsts(node, i))

    def _first_times(self, node: Series, i: str) -> str:
        return self._lanes.mul(*self._firsts(node, i))

    def _first_plus_times(self, node: Series, i: str) -> str:
        rest, term, factor = self._firsts(node, i)
        return self._lanes.add(rest, self._lanes.mul(term, factor))

    def _first_over(self, node: Series, i: str) -> str:
        return self._lanes.div(*self._firsts(node, i))

    def _first_mul(self, node: Series, i: str) -> str:
        return self._lanes.mul(*self._firsts(node, i))

    def _first_div(self, node: Series, i: str) -> str:
        return self._lanes.div(*self._firsts(node, i))

    def _first_sqrt(self, node: Series, i: str) -> str:
        return self._lanes.intrinsic("sqrt", *self._firsts(node, i))

    def _first_power(self, node: Series, i: str) -> str:
        exponent = _exponent(node)
        assert exponent is not None
        lanes, base = self._lanes, self._first(node.operands[0], i)
        found = lanes.intrinsic("sqrt", base)
        for _ in range(int(abs(exponent))):
            found = lanes.mul(base, found)
        return found if exponent > 0.0 else lanes.div(lanes.const(1.0), found)

    # ------------------------------------------------------------------ the order in turn

    def turn(self) -> None:
        """Write the sums of products of lower orders."""
        self._sums.turn()

    def state(self, node: Series, derivative: Series | Constant) -> None:  # noqa: ARG002 - it was carried here
        """Write an array of states' k-th coefficients: the derivatives' one order lower, divided by k."""
        kind = self._lanes.kind
        cells = self._carried[node.number]
        before = [self._frame.text.op(f"load {kind}, ptr {cell}") for cell in cells]
        self._put(node, [self._over_order(values) for values in before])

    def end_turn(self) -> None:
        """Hand the derivatives on to the next turn."""
        for piece in self._states:
            for i, cell in enumerate(self._carried[piece.series.number]):
                self._carry(cell, self._of(piece.derivative, str(i)))

    def write(self, node: Series) -> None:
        """Write what computes an array's k-th coefficients."""
        if node.kind == "gather":
            self._put(node, self._gathered(node, self._now, self._frame.coefficient))
            return
        self._node = node
        element: Callable[[Series, str], str] = getattr(self, f"_element_{node.kind}")
        self._put(node, [element(node, str(i)) for i in range(vectors(node.size))])

    def number(self, node: Series) -> str:
        """Write a number that is an array's element."""
        return self._element(node, self._now)

    def _element(self, node: Series, rows: dict[int, list[str]]) -> str:
        (given,) = node.operands
        assert isinstance(given, Series)
        which, lane = divmod(node.by, self._lanes.width)
        return self._frame.text.op(
            f"extractelement {self._lanes.kind} {rows[given.number][which]}, i64 {lane}"
        )

    def _gathered(
        self, node: Series, rows: dict[int, list[str]], number: Callable[[Series | Constant], str]
    ) -> list[str]:
        width = self._lanes.width

        def lane(operand: Series | Constant, at: int) -> Lane:
            if isinstance(operand, Constant) or operand.count is None:
                return Lane(number(operand), None)
            return Lane(rows[operand.number][at // width], at % width)

        return collected(self._lanes, [lane(*given) for given in node.lanes])

    def _carry(self, cell: str, values: str) -> None:
        self._frame.text.do(f"store {self._lanes.kind} {values}, ptr {cell}")

    def _put(self, node: Series, values: list[str]) -> None:
        self._now[node.number] = values
        self._keep(node, values, "%k")

    def _keep(self, node: Series, values: Iterable[str], order: str = "0") -> None:
        """Put coefficients where sums of products, or others, read them."""
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
        if isinstance(operand, Constant):
            return self._constant(operand, i)
        if operand.count is None:
            return self._lanes.splat(self._frame.first(operand))
        return self._first_rows[operand.number][int(i)]

    def _constant(self, constant: Constant, i: str) -> str:
        if constant.count is None:
            return self._lanes.splat(self._frame.first(constant))
        return self._constants[id(constant)][int(i)]

    def load_constant(self, constant: Constant) -> None:
        """Read an array that stays what it is."""
        if constant.count is not None and id(constant) not in self._constants:
            self._frame.loaded.append((constant.slot, constant.count))
            self._constants[id(constant)] = self._loaded(constant.slot, constant.count)

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

    def _over_first(self, values: str, divisor: Series | Constant, i: str) -> str:
        return self._lanes.mul(values, self._reciprocals[id(divisor)][int(i)])

    def _term(self, node: Series) -> Term | None:
        """Return which products an array's coefficients consist of; None: of none."""
        match node.kind:
            case "mul":
                pair, weight = node.operands, None
            case "div":
                pair, weight = (node, node.operands[1]), None
            case "sqrt":
                pair, weight = (node, node), None
            case "integral":
                pair, weight = (node.operands[1], node.operands[0]), self._slope
            case "quotient":
                pair, weight = (node, node.operands[1]), self._slope
            case "power":
                pair, weight = (node.operands[0], node), self._by_power(node.operands[1])
            case _:
                return None
        a, b = pair
        if isinstance(a, Constant) or isinstance(b, Constant):
            return None
        return Term(node, a, b, weight)

    def prepare(self, node: Series) -> None:
        """Compute before the loop what an array needs in it: one over what it is divided by."""
        if node.kind in {"div", "over", "quotient"}:
            self._divide_by(node.operands[1], node.size)
        elif node.kind == "power":
            self._divide_by(node.operands[0], node.size)
        elif node.kind == "sqrt":
            self._divide_by(node, node.size)

    def _divide_by(self, divisor: Series | Constant, size: int) -> None:
        if id(divisor) not in self._reciprocals:
            one = self._lanes.const(1.0)
            self._reciprocals[id(divisor)] = [
                self._lanes.div(one, self._first(divisor, str(i))) for i in range(vectors(size))
            ]


def _exponent(node: Series) -> float | None:
    exponent = node.operands[1]
    assert isinstance(exponent, Constant)
    return exponent.value.value if isinstance(exponent.value, Const) else None
