"""Recurrences of numbers' series.

A sum Σ a_j·b_{k-j} is not summed up when its turn comes: as soon as a_k and b_k are known, their products
with lower coefficients are added to all sums to come, several at a time, so that nothing waits for long sums:

    sum[k + i] += a_k·b_i + b_k·a_i    0 < i < k, k + i ≤ order;    the products with i = 0 and i = k apart.

For that no row may show coefficient k before all such products are made: rows are written at a turn's end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.taylor.layout import ROW
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.taylor.frame import Frame

STRIP = 4
"""Sums that are added to at a time."""


def helper(name: str, *, inline: bool) -> str:
    """Write the function that adds a turn's products to the sums behind `s`."""
    vector = f"<{STRIP} x double>"
    return f"""define internal void @{name}(ptr noalias %s, double %a, ptr %b, double %d, ptr %e, i64 %n) \
{"alwaysinline " if inline else "noinline "}nounwind {{
entry:
%a1 = insertelement {vector} poison, double %a, i64 0
%av = shufflevector {vector} %a1, {vector} poison, <{STRIP} x i32> zeroinitializer
%d1 = insertelement {vector} poison, double %d, i64 0
%dv = shufflevector {vector} %d1, {vector} poison, <{STRIP} x i32> zeroinitializer
br label %head
head:
%i = phi i64 [ 0, %entry ], [ %next, %body ]
%on = icmp slt i64 %i, %n
br i1 %on, label %body, label %done
body:
%sp = getelementptr double, ptr %s, i64 %i
%bp = getelementptr double, ptr %b, i64 %i
%ep = getelementptr double, ptr %e, i64 %i
%bv = load {vector}, ptr %bp, align 8
%ev = load {vector}, ptr %ep, align 8
%sv = load {vector}, ptr %sp, align 8
%p = fmul {vector} %av, %bv
%q = fmul {vector} %dv, %ev
%r = fadd {vector} %p, %q
%t = fadd {vector} %sv, %r
store {vector} %t, ptr %sp, align 8
%next = add i64 %i, {STRIP}
br label %head
done:
ret void
}}"""


class _Sum(NamedTuple):
    """A running sum, and what the turn adds to it: coefficients and rows of both factors."""

    sums: int
    squares: int
    factors: tuple[tuple[str, int], tuple[str, int]]


class ScalarRecurrences:
    """Writes the turns of numbers' series."""

    def __init__(self, frame: Frame, helper_name: str) -> None:
        self._frame = frame
        self._lanes = Lanes(frame.text)
        self._helper = helper_name
        self._sums: list[_Sum] = []
        self._late: list[tuple[Series, tuple[str, int], Series]] = []
        """Integrals, whose first factor may come behind them."""
        self._rows: dict[int, str] = {}
        """What each row gets at the end of the turn."""

    # ------------------------------------------------------------------ before the loop

    @staticmethod
    def reserve(frame: Frame, node: Series) -> None:
        """Make room for a series' sums."""
        if node.kind in {"mul", "div", "sqrt", "integral", "quotient"}:
            if node.kind == "integral" and isinstance(node.operands[0], Constant):
                return
            for what in ("sums", "squares"):
                frame.layout.row_for(what, node)
        if node.kind == "integral":
            inner = node.operands[1]
            assert isinstance(inner, Series)
            frame.layout.row_for("slope", inner)
        if node.kind == "quotient":
            frame.layout.row_for("slope", node)

    @staticmethod
    def prepare(frame: Frame, node: Series) -> None:
        """Compute before the loop what a series needs in it."""
        for operand in node.operands:
            if isinstance(operand, Constant):
                frame.load_constant(operand)
        if node.kind in {"div", "quotient", "over"}:
            frame.load_reciprocal(node.operands[1])
        if node.kind == "sqrt":
            frame.load_reciprocal(node)

    # ------------------------------------------------------------------ in the loop

    def write(self, node: Series) -> None:
        """Write what computes a series' k-th coefficient."""
        write: Callable[[Series], str] = getattr(self, f"_{node.kind}")
        self._frame.now[node.number] = write(node)
        self.keep(node)

    def keep(self, node: Series) -> None:
        """Let a coefficient that is known be written to its row at the end of the turn."""
        self._rows[self._frame.layout.place(node)] = self._frame.now[node.number]

    def end_turn(self) -> None:
        """Write what adds the turn's products to the sums to come, and keeps its coefficients."""
        frame, text = self._frame, self._frame.text
        upper = text.op("sub i64 %p, %k")
        lower = text.op("sub i64 %k, 1")
        shorter = text.op(f"icmp slt i64 {upper}, {lower}")
        count = text.op(f"select i1 {shorter}, i64 {upper}, i64 {lower}")
        behind = text.op("add i64 %k, 1")
        twice = text.op("shl i64 %k, 1")
        fits = text.op(f"icmp slt i64 {twice}, {ROW - 1}")
        double = text.op(f"select i1 {fits}, i64 {twice}, i64 {ROW - 1}")
        for node, slope, factor in self._late:
            self._add_to_sums(node, slope, self._factor(factor))
        products = []
        for made in self._sums:
            (a, row_a), (b, row_b) = made.factors
            sums = frame.at(made.sums, behind)
            lists = f"double {a}, ptr {frame.at(row_b + 1)}, double {b}, ptr {frame.at(row_a + 1)}"
            text.do(f"call void @{self._helper}(ptr {sums}, {lists}, i64 {count})")
            products.append((made.squares, self._lanes.mul(a, b)))
        for squares, product in products:
            frame.put(squares, product, double)
        for place, value in self._rows.items():
            frame.put(place, value, "%k")

    def _running(self, node: Series) -> str:
        """Return the sum of the products with lower coefficients, those with coefficient 0 left out."""
        layout = self._frame.layout
        sums = self._frame.get(layout.row_for("sums", node), "%k")
        return self._lanes.add(sums, self._frame.get(layout.row_for("squares", node), "%k"))

    def _add_to_sums(self, node: Series, first: tuple[str, int], second: tuple[str, int]) -> None:
        layout = self._frame.layout
        self._sums.append(
            _Sum(layout.row_for("sums", node), layout.row_for("squares", node), (first, second))
        )

    def _factor(self, series: Series) -> tuple[str, int]:
        return self._frame.coefficient(series), self._frame.layout.place(series)

    def _slope(self, series: Series) -> tuple[str, int]:
        """Return k·a_k and the row of all of them, for products with a derivative."""
        place = self._frame.layout.row_for("slope", series)
        value = self._rows.get(place)
        if value is None:
            value = self._rows[place] = self._lanes.mul("%kf", self._frame.coefficient(series))
        return value, place

    def _time(self, _node: Series) -> str:
        one = self._frame.text.op("icmp eq i64 %k, 1")
        return self._lanes.choose(one, literal(1.0), literal(0.0))

    def _raised(self, node: Series) -> str:
        (given,) = (o for o in node.operands if isinstance(o, Series))
        return self._frame.coefficient(given)

    def _add(self, node: Series) -> str:
        return self._lanes.add(*map(self._frame.coefficient, node.operands))

    def _sub(self, node: Series) -> str:
        return self._lanes.sub(*map(self._frame.coefficient, node.operands))

    def _neg(self, node: Series) -> str:
        return self._lanes.neg(self._frame.coefficient(node.operands[0]))

    def _times(self, node: Series) -> str:
        a, b = (
            self._frame.first(o) if isinstance(o, Constant) else self._frame.coefficient(o)
            for o in node.operands
        )
        return self._lanes.mul(a, b)

    def _over(self, node: Series) -> str:
        a, b = node.operands
        return self._lanes.mul(self._frame.coefficient(a), self._frame.reciprocal(b))

    def _mul(self, node: Series) -> str:
        a, b = node.operands
        assert isinstance(a, Series)
        assert isinstance(b, Series)
        lanes, frame = self._lanes, self._frame
        if a is b:
            ends = lanes.mul(lanes.mul(literal(2.0), frame.first(a)), frame.coefficient(a))
        else:
            ends = lanes.add(
                lanes.mul(frame.coefficient(a), frame.first(b)),
                lanes.mul(frame.first(a), frame.coefficient(b)),
            )
        self._add_to_sums(node, self._factor(a), self._factor(b))
        return lanes.add(self._running(node), ends)

    def _div(self, node: Series) -> str:
        a, b = node.operands
        assert isinstance(b, Series)
        lanes, frame = self._lanes, self._frame
        known = lanes.add(self._running(node), lanes.mul(frame.first(node), frame.coefficient(b)))
        rest = lanes.neg(known) if isinstance(a, Constant) else lanes.sub(frame.coefficient(a), known)
        value = lanes.mul(rest, frame.reciprocal(b))
        self._add_to_sums(node, (value, frame.layout.place(node)), self._factor(b))
        return value

    def _sqrt(self, node: Series) -> str:
        lanes, frame = self._lanes, self._frame
        rest = lanes.sub(frame.coefficient(node.operands[0]), self._running(node))
        value = lanes.mul(lanes.mul(literal(0.5), rest), frame.reciprocal(node))
        factor = value, frame.layout.place(node)
        self._add_to_sums(node, factor, factor)
        return value

    def _integral(self, node: Series) -> str:
        factor, inner = node.operands
        assert isinstance(inner, Series)
        lanes, frame = self._lanes, self._frame
        if isinstance(factor, Constant):
            return lanes.mul(frame.first(factor), frame.coefficient(inner))
        slope, row = self._slope(inner)
        known = lanes.add(self._running(node), lanes.mul(slope, frame.first(factor)))
        value = lanes.mul(known, "%ki")
        self._late.append((node, (slope, row), factor))
        return value

    def _quotient(self, node: Series) -> str:
        a, b = node.operands
        assert isinstance(a, Series)
        assert isinstance(b, Series)
        lanes, frame = self._lanes, self._frame
        rest = lanes.sub(lanes.mul("%kf", frame.coefficient(a)), self._running(node))
        slope = lanes.mul(rest, frame.reciprocal(b))
        place = frame.layout.row_for("slope", node)
        self._rows[place] = slope
        self._add_to_sums(node, (slope, place), self._factor(b))
        return lanes.mul(slope, "%ki")

    def _select(self, node: Series) -> str:
        condition, yes, no = node.operands
        flag = self._lanes.compare("ogt", self._frame.first(condition), literal(0.0))
        return self._lanes.choose(flag, self._frame.coefficient(yes), self._frame.coefficient(no))
