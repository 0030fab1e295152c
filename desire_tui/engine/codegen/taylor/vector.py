"""Recurrences of arrays' series: loops over elements, several at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.taylor.arrays import Arrays
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.layout import strip
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    Weight = Callable[[str, str, str], str]
    """f(j, a_j, place of the elements): a_j with its weight in a sum."""


class VectorRecurrences(Arrays):
    """Writes the turns of arrays' series, and of numbers that are made of arrays' elements."""

    def load_first(self, node: Series) -> None:
        """Copy coefficients 0 from the values, if any are read."""
        if node.number not in self._frame.layout.begun:
            return
        target = self._frame.at(self._frame.layout.place(node))
        if not node.slots:
            self._copy(target, self._values(node.slot, node.size), self._length(node))
            return
        self._frame.loaded += [(slot, 1) for slot in node.slots]
        one, table = Lanes(self._frame.text), self._table(node.slots)
        loop(self._frame.text, "0", str(node.size), 1,
             lambda i: put(one, target, i, fetch(one, "%v", self._entry(table, i))))  # fmt: skip

    def load_constant(self, constant: Constant) -> None:
        """Nothing is read ahead."""

    def prepare(self, node: Series) -> None:
        """Compute before the loop what an array needs in it: nothing."""

    def before_orders(self) -> None:
        """Write what stands before the loop over the orders: nothing."""

    def turn(self) -> None:
        """Write what stands at a turn's start: nothing."""

    def end_turn(self) -> None:
        """Write what stands at a turn's end: nothing."""

    def write(self, node: Series) -> None:
        """Write what computes an array's k-th coefficients."""
        self._lanes = Fused(self._frame.text, strip(node.size))
        write: Callable[[Series], None] | None = getattr(self, f"_{node.kind}", None)
        if write is not None:
            write(node)
            return
        element: Callable[[Series, str], str] = getattr(self, f"_element_{node.kind}")
        target = self._frame.row(node)
        loop(self._frame.text, "0", self._end(node), self._lanes.width,
             lambda i: put(self._lanes, target, i, element(node, i)))  # fmt: skip

    def state(self, node: Series, derivative: Series | Constant) -> None:
        """Write an array of states' k-th coefficients: the derivatives' one order lower, divided by k."""
        self._lanes = Fused(self._frame.text, strip(node.size))
        text, lanes = self._frame.text, self._lanes
        target = self._frame.row(node)
        before = text.op("sub i64 %k, 1")
        if isinstance(derivative, Constant):
            first = text.op("icmp eq i64 %k, 1")
            once = text.op(f"select i1 {first}, double {literal(1.0)}, double {literal(0.0)}")

            def constant(i: str) -> None:
                put(lanes, target, i, lanes.mul(self._constant(derivative, i), lanes.splat(once)))

            loop(text, "0", self._end(node), lanes.width, constant)
            return
        source = self._frame.row(derivative, before)
        loop(text, "0", self._end(node), lanes.width,
             lambda i: put(lanes, target, i, self._over_order(fetch(lanes, source, i))))  # fmt: skip

    def number(self, node: Series) -> str:
        """Write a number that is an array's element, or the sum of its elements."""
        (given,) = node.operands
        assert isinstance(given, Series)
        row = self._frame.row(given)
        one = Lanes(self._frame.text)
        if node.kind == "element":
            return fetch(one, row, str(node.by))
        return self._sum(given.size, lambda lanes, i: fetch(lanes, row, i))

    # ------------------------------------------------------------------ one element

    def _element_raised(self, node: Series, i: str) -> str:
        (given,) = (o for o in node.operands if isinstance(o, Series))
        return self._of(given, i)

    def _element_add(self, node: Series, i: str) -> str:
        return self._lanes.add(*(self._of(o, i) for o in node.operands))

    def _element_sub(self, node: Series, i: str) -> str:
        return self._lanes.sub(*(self._of(o, i) for o in node.operands))

    def _element_neg(self, node: Series, i: str) -> str:
        return self._lanes.neg(self._of(node.operands[0], i))

    def _element_times(self, node: Series, i: str) -> str:
        a, b = (self._constant(o, i) if isinstance(o, Constant) else self._of(o, i) for o in node.operands)
        return self._lanes.mul(a, b)

    def _element_plus_times(self, node: Series, i: str) -> str:
        rest, term, factor = node.operands
        return self._lanes.mul_add(self._of(term, i), self._first(factor, i), self._of(rest, i))

    def _element_over(self, node: Series, i: str) -> str:
        a, b = node.operands
        return self._over_first(self._of(a, i), b, i)

    def _element_mul(self, node: Series, i: str) -> str:
        a, b = node.operands
        return self._square(a, i, 0) if a is b else self._products(a, b, i, 0, 0)

    def _element_div(self, node: Series, i: str) -> str:
        a, b = node.operands
        known = self._products(node, b, i, 0, 1)
        lanes = self._lanes
        rest = lanes.neg(known) if isinstance(a, Constant) else lanes.sub(self._of(a, i), known)
        return self._over_first(rest, b, i)

    def _element_sqrt(self, node: Series, i: str) -> str:
        lanes = self._lanes
        rest = lanes.sub(self._of(node.operands[0], i), self._square(node, i, 1))
        return self._over_first(lanes.mul(lanes.const(0.5), rest), node, i)

    def _element_integral(self, node: Series, i: str) -> str:
        factor, inner = node.operands
        if isinstance(factor, Constant):
            return self._lanes.mul(self._constant(factor, i), self._of(inner, i))
        total = self._products(inner, factor, i, 1, 0, self._slope)
        return self._over_order(total)

    def _element_quotient(self, node: Series, i: str) -> str:
        lanes = self._lanes
        a, b = node.operands
        known = self._over_order(self._products(node, b, i, 1, 1, self._slope))
        return self._over_first(lanes.sub(self._of(a, i), known), b, i)

    def _element_power(self, node: Series, i: str) -> str:
        """Return u_k from k·a_0·u_k = Σ ((b + 1)·j - k)·a_j·u_{k-j}, j from 1 to k."""
        base, exponent = node.operands
        lanes = self._lanes
        known = self._over_order(self._products(base, node, i, 1, 1, self._by_power(exponent)))
        rate = lanes.mul(self._first(exponent, i), self._first(node, i))
        return self._over_first(lanes.mul_add(rate, self._of(base, i), known), base, i)

    def _element_select(self, node: Series, i: str) -> str:
        condition, yes, no = node.operands
        assert isinstance(condition, Constant)
        lanes = self._lanes
        flags = lanes.compare("ogt", self._constant(condition, i), lanes.const(0.0))
        return lanes.choose(flags, self._of(yes, i), self._of(no, i))

    def _over_order(self, values: str) -> str:
        return self._frame.all_over_order(self._lanes, values)

    def _square(self, a: Series | Constant, i: str, first: int) -> str:
        """Return Σ a_j·a_{k-j}, j from `first` to k - `first`: twice the half, and the middle."""
        text, lanes = self._frame.text, self._lanes
        assert isinstance(a, Series)
        half = self._sum_of_products(a, a, i, str(first), text.op(f"lshr i64 {text.op('add i64 %k, 1')}, 1"))
        middle = self._at_order(a, text.op("lshr i64 %k, 1"), i)
        is_even = text.op(f"icmp eq i64 {text.op('and i64 %k, 1')}, 0")
        other = text.op(f"select i1 {is_even}, {lanes.kind} {middle}, {lanes.kind} {lanes.const(0.0)}")
        return lanes.mul_add(lanes.const(2.0), half, lanes.mul(middle, other))

    def _over_first(self, values: str, divisor: Series | Constant, i: str) -> str:
        """Return values over the divisor's coefficients 0."""
        return self._lanes.div(values, self._first(divisor, i))

    def _slope(self, count: str, values: str, i: str) -> str:  # noqa: ARG002 - powers' depend on it
        """Return j·a_j; `count`: j as a double."""
        return self._lanes.mul(self._lanes.splat(count), values)

    def _by_power(self, exponent: Series | Constant) -> Weight:
        def weighted(count: str, values: str, i: str) -> str:
            lanes = self._lanes
            raised = lanes.add(self._first(exponent, i), lanes.const(1.0))
            factor = lanes.sub(lanes.mul(lanes.splat(count), raised), lanes.splat("%kf"))
            return lanes.mul(factor, values)

        return weighted

    def _products(
        self,
        a: Series | Constant,
        b: Series | Constant,
        i: str,
        first: int,
        less: int,
        weight: Weight | None = None,
    ) -> str:
        """Return Σ a_j·b_{k-j}, j from `first` to k - `less`, each with a weight."""
        end = self._frame.text.op(f"add i64 %k, {1 - less}")
        return self._sum_of_products(a, b, i, str(first), end, weight)

    def _sum_of_products(
        self,
        a: Series | Constant,
        b: Series | Constant,
        i: str,
        first: str,
        end: str,
        weight: Weight | None = None,
    ) -> str:
        assert isinstance(a, Series)
        assert isinstance(b, Series)
        text, lanes = self._frame.text, self._lanes
        cell = text.alloca(lanes.kind)
        text.do(f"store {lanes.kind} {lanes.const(0.0)}, ptr {cell}")

        def turn(j: str) -> None:
            left = self._at_order(a, j, i)
            if weight is not None:
                left = weight(text.op(f"sitofp i64 {j} to double"), left, i)
            right = self._at_order(b, text.op(f"sub i64 %k, {j}"), i)
            before = text.op(f"load {lanes.kind}, ptr {cell}")
            text.do(f"store {lanes.kind} {lanes.mul_add(left, right, before)}, ptr {cell}")

        loop(text, first, end, 1, turn)
        return text.op(f"load {lanes.kind}, ptr {cell}")
