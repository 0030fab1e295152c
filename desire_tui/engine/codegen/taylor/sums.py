"""Sums of products Σ a_j·b_{k-j} of numbers' series, kept in registers as the order rises.

A sum is not added up when its turn comes: as soon as a_k and b_k are known their products with lower
coefficients are added to all sums to come, so that nothing waits for long sums. The products

    i = 0                  are made in the turn itself;
    i = 1                  one turn later, from numbers;
    i = 2 … 9, i < k       at the end of the turn, as one vector: sums k + 2 … k + 9;
    i = k                  at the end of the turn, for the sum of order 2k.

More is not wanted up to order 20: the other factor's order would be i too. Every vector moves on by one
element in a turn, so that it meets memory as a whole only, and reading what was just written never waits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.layout import ROW
from desire_tui.engine.integration.taylor.memory import ORDER_MOST

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.passes.series.nodes import Series

LANES = 8
"""Of a vector: i = 2 … 9."""
assert (ORDER_MOST - 1) // 2 - 1 <= LANES


class Factor(NamedTuple):
    """A factor of a sum: which coefficients of a series, its own ("value") or k times those ("slope")."""

    what: str
    series: Series


class Sum(NamedTuple):
    """Which sum of a series: one with two has parts 0 and 1."""

    number: int
    part: int

    @property
    def cell(self) -> str:
        """What a cell of the layout holds."""
        return f"sum {self.part}"


class Sums:
    """Writes the sums of a function.

    `in_memory`: what turns hand on stands in cells of the layout, not in registers: for large models.
    """

    def __init__(self, frame: Frame, *, in_memory: bool) -> None:
        self._frame, self._in_memory = frame, in_memory
        self._text = frame.text
        self._one, self._wide = Fused(frame.text), Fused(frame.text, LANES)
        self._sums: dict[Sum, tuple[Factor, Factor]] = {}
        self._factors: dict[tuple[str, int], Factor] = {}
        self._cells: dict[tuple[str, str, int], str] = {}

    def add(self, which: Sum, first: Factor, second: Factor) -> None:
        """Announce a sum before anything is written."""
        self._sums[which] = first, second
        for factor in (first, second):
            self._factors[factor.what, factor.series.number] = factor

    @property
    def factors(self) -> list[Factor]:
        """All factors, each once."""
        return list(self._factors.values())

    def finish_layout(self) -> None:
        """Place everything."""
        cells = list(self._factors)
        cells += [(which.cell, which.number) for which in self._sums]
        self._frame.layout.finish(cells if self._in_memory else (), self._sums)

    def begin(self) -> None:
        """Write what makes cells in the function's frame, all 0; those in memory have been cleared."""
        if self._in_memory:
            return
        for what, number in self._factors:
            for part in ("vector", "first", "before"):
                self._make(what, number, part)
        for which in self._sums:
            for part in ("vector", "next"):
                self._make(which.cell, which.number, part)

    def turn(self) -> None:
        """Write what all sums need in a turn: which element is coefficient k's."""
        lanes = f"<{LANES} x i64>"
        text = self._text
        text.do(f"%k.1 = insertelement {lanes} poison, i64 %k, i64 0")
        text.do(f"%k.all = shufflevector {lanes} %k.1, {lanes} poison, <{LANES} x i32> zeroinitializer")
        places = ", ".join(f"i64 {i}" for i in range(2, 2 + LANES))
        text.do(f"%k.here = icmp eq {lanes} %k.all, <{places}>")

    def known(self, node: Series, part: int = 0) -> str:
        """Return the sum of order k without the products in which a coefficient 0 is a factor."""
        which = Sum(node.number, part)
        first, second = self._sums[which]
        one = self._one
        squares = self._frame.get(self._frame.layout.squares(which), "%k")
        total = self._get(which.cell, which.number, "next")
        total = one.mul_add(self._factor(first, "first"), self._factor(second, "before"), total)
        if first == second:
            return one.mul_add(literal(2.0), total, squares)
        total = one.mul_add(self._factor(first, "before"), self._factor(second, "first"), total)
        return one.add(total, squares)

    def end_turn(self, coefficients: dict[tuple[str, int], str]) -> None:
        """Write what adds a turn's products to the sums to come; `coefficients`: the factors' k-th."""
        text, one, wide = self._text, self._one, self._wide
        twice = text.op("shl i64 %k, 1")
        fits = text.op(f"icmp slt i64 {twice}, {ROW - 1}")
        double = text.op(f"select i1 {fits}, i64 {twice}, i64 {ROW - 1}")
        later = text.op("icmp sge i64 %k, 2")
        splats = {key: wide.splat(coefficients[key]) for key in self._factors}
        vectors = {key: self._get(*key, "vector") for key in self._factors}
        moved = f"<{', '.join(f'i32 {i}' for i in range(1, LANES + 1))}>"
        for which, (first, second) in self._sums.items():
            a, b = ((f.what, f.series.number) for f in (first, second))
            sums = self._get(which.cell, which.number, "vector")
            self._put(which.cell, which.number, "next", text.op(f"extractelement {wide.kind} {sums}, i64 0"))
            ahead = text.op(
                f"shufflevector {wide.kind} {sums}, {wide.kind} zeroinitializer, <{LANES} x i32> {moved}"
            )
            grown = wide.mul_add(splats[a], vectors[b], ahead)
            if a != b:
                grown = wide.mul_add(splats[b], vectors[a], grown)
            self._put(which.cell, which.number, "vector", grown)
            self._frame.put(
                self._frame.layout.squares(which), one.mul(coefficients[a], coefficients[b]), double
            )
        is_first = text.op("icmp eq i64 %k, 1")
        for key in self._factors:
            now = coefficients[key]
            self._put(*key, "vector", wide.choose("%k.here", splats[key], vectors[key]))
            self._put(*key, "first", one.choose(is_first, now, self._get(*key, "first")))
            self._put(*key, "before", one.choose(later, now, literal(0.0)))

    # ------------------------------------------------------------------ cells

    def _factor(self, factor: Factor, part: str) -> str:
        return self._get(factor.what, factor.series.number, part)

    def _make(self, what: str, number: int, part: str) -> None:
        kind = self._kind(part)
        cell = self._cells[what, part, number] = self._text.alloca(kind)
        self._text.do(f"store {kind} zeroinitializer, ptr {cell}")

    def _at(self, what: str, number: int, part: str) -> str:
        if not self._in_memory:
            return self._cells[what, part, number]
        place = self._frame.layout.cell(what, number)
        return self._frame.at(place + {"vector": 0, "first": LANES, "next": LANES, "before": LANES + 1}[part])

    def _get(self, what: str, number: int, part: str) -> str:
        return self._text.op(f"load {self._kind(part)}, ptr {self._at(what, number, part)}, align 8")

    def _put(self, what: str, number: int, part: str, value: str) -> None:
        self._text.do(f"store {self._kind(part)} {value}, ptr {self._at(what, number, part)}, align 8")

    def _kind(self, part: str) -> str:
        return self._wide.kind if part == "vector" else "double"
