"""Sums of products Σ a_j·b_{k-j} of short arrays, j from 1 to k - 1: from rows in memory, many at a time.

All that a turn asks for is made of coefficients that were there at its start, so one loop over j makes
several sums at once: what two of them read is read once, and a loop's end is paid for once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.vector import Weight
    from desire_tui.engine.passes.series.nodes import Series


class Term(NamedTuple):
    """What a series' sum is made of; `a` is `b`: twice the half, and the middle."""

    node: Series
    a: Series
    b: Series
    weight: Weight | None

    @property
    def is_square(self) -> bool:
        """Whether both factors are the same."""
        return self.a is self.b


class RowSums:
    """Writes the sums of a turn."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._lanes = Fused(frame.text, machine().width)
        self._loops: list[list[tuple[Term, int]]] = []
        self._known: dict[tuple[int, int], str] = {}

    def begin(self, terms: list[Term]) -> None:
        """Choose which sums are made in one loop: half of the registers hold them."""
        most = 16 if machine().width == 8 else 8
        for squares in (True, False):
            sums = [
                (term, i)
                for term in terms
                if term.is_square is squares
                for i in range(-(-term.node.size // self._lanes.width))
            ]
            self._loops += [sums[at : at + most] for at in range(0, len(sums), most)]

    def known(self, node: Series, i: int) -> str:
        """Return a vector of the sums that `turn` has written."""
        return self._known[node.number, i]

    def turn(self) -> None:
        """Write the sums of order k."""
        for sums in self._loops:
            self._loop(sums)

    def _loop(self, sums: list[tuple[Term, int]]) -> None:
        text, lanes = self._frame.text, self._lanes
        kind, squares = lanes.kind, sums[0][0].is_square
        cells = [text.alloca(kind) for _ in sums]
        for cell in cells:
            text.do(f"store {kind} {lanes.const(0.0)}, ptr {cell}")
        end = text.op(f"lshr i64 {text.op('add i64 %k, 1')}, 1") if squares else "%k"

        def products(j: str) -> None:
            other = text.op(f"sub i64 %k, {j}")
            count = text.op(f"sitofp i64 {j} to double")
            read: dict[tuple[int, int, str], str] = {}

            def at(series: Series, i: int, order: str) -> str:
                key = series.number, i, order
                if key not in read:
                    read[key] = self._row(series, i, order)
                return read[key]

            for (term, i), cell in zip(sums, cells, strict=True):
                left = at(term.a, i, j)
                if term.weight is not None:
                    left = term.weight(count, left, str(i))
                before = text.op(f"load {kind}, ptr {cell}")
                total = lanes.mul_add(left, at(term.b, i, other), before)
                text.do(f"store {kind} {total}, ptr {cell}")

        loop(text, "1", end, 1, products)
        totals = [text.op(f"load {kind}, ptr {cell}") for cell in cells]
        if squares:
            totals = self._with_middles(sums, totals)
        for (term, i), total in zip(sums, totals, strict=True):
            self._known[term.node.number, i] = total

    def _with_middles(self, sums: list[tuple[Term, int]], halves: list[str]) -> list[str]:
        text, lanes = self._frame.text, self._lanes
        half = text.op("lshr i64 %k, 1")
        is_even = text.op(f"icmp eq i64 {text.op('and i64 %k, 1')}, 0")
        found = []
        for (term, i), total in zip(sums, halves, strict=True):
            middle = self._row(term.a, i, half)
            other = text.op(f"select i1 {is_even}, {lanes.kind} {middle}, {lanes.kind} {lanes.const(0.0)}")
            found.append(lanes.mul_add(lanes.const(2.0), total, lanes.mul(middle, other)))
        return found

    def _row(self, series: Series, i: int, order: str) -> str:
        """Read a vector of an order's coefficients."""
        frame, text, lanes = self._frame, self._frame.text, self._lanes
        place = frame.layout.place(series)
        if series.count is None:
            return lanes.splat(frame.get(place, order))
        row = text.op(
            f"getelementptr double, ptr %c, i64 {text.op(f'mul i64 {order}, {frame.layout.apart(series)}')}"
        )
        at = text.op(f"getelementptr double, ptr {row}, i64 {place + i * lanes.width}")
        return text.op(f"load {lanes.kind}, ptr {at}, align 8")
