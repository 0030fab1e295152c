"""Sums of products Σ a_j·b_{k-j} of numbers' series, each product written out.

They are added in the order of `sums`, so that a sum has the same bits: products of coefficients 2 and above
as they become known, then those with a coefficient 1, then the one of equal orders.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import literal

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.sums import Factor
    from desire_tui.engine.passes.series.nodes import Series


class StraightSums:
    """Has the methods of `sums.Sums` that write; all coefficients are values of the text."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._sums: dict[int, tuple[Factor, Factor]] = {}
        self._rows: dict[tuple[str, int], list[str]] = {}
        """Coefficients 1, 2 … of factors."""

    def add(self, node: Series, first: Factor, second: Factor) -> None:
        """Announce a sum before anything is written."""
        self._sums[node.number] = first, second
        for factor in (first, second):
            self._rows[factor.what, factor.series.number] = []

    @property
    def factors(self) -> list[Factor]:
        """All factors, each once."""
        return [factor for pair in self._sums.values() for factor in pair]

    def known(self, node: Series) -> str:
        """Return the sum of the order in turn without the products in which a coefficient 0 is a factor."""
        k, lanes = self._frame.order, self._frame.lanes
        assert k is not None
        first, second = self._sums[node.number]
        a, b = ([literal(0.0), *self._rows[f.what, f.series.number]] for f in (first, second))
        is_square = first == second
        total = literal(0.0)
        for j in range(k // 2 + 1, k):
            one, other = (k - j, j) if j == k - 1 else (j, k - j)
            total = lanes.mul_add(a[one], b[other], total)
            if not is_square:
                total = lanes.mul_add(a[other], b[one], total)
        if k % 2:
            return lanes.mul(literal(2.0), total) if is_square and k > 1 else total
        middle = lanes.mul(a[k // 2], b[k // 2])
        if k == 2:
            return middle
        return lanes.mul_add(literal(2.0), total, middle) if is_square else lanes.add(total, middle)

    def end_turn(self, coefficients: dict[tuple[str, int], str]) -> None:
        """Keep the factors' coefficients of the order in turn."""
        for key, value in coefficients.items():
            self._rows[key].append(value)
