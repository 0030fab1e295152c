"""Sums of products Σ a_j·b_{k-j} of numbers' series, each product written out, several sums as one vector.

What a turn asks for is made of coefficients that were there at its start, so any sums may stand side by side,
whatever they are part of. They are added in the order of `sums`, so that a sum has the same bits: products of
coefficients 2 and above as they become known, then those with a coefficient 1, then the one of equal orders.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.sums import Sum

if TYPE_CHECKING:
    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.sums import Factor
    from desire_tui.engine.passes.series.nodes import Series

    Keys = tuple[tuple[str, int], ...]
    """Which factor is in which lane."""

_WIDE = 4
"""Sums side by side: more would be moved about for longer than they take one by one."""


class _Pack(NamedTuple):
    """Sums side by side; `first` is `second` where all are of squares."""

    sums: list[Sum]
    first: Keys
    second: Keys


class StraightSums:
    """Has the methods of `sums.Sums` that write; all coefficients are values of the text."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._sums: dict[Sum, tuple[Factor, Factor]] = {}
        self._packs: list[_Pack] = []
        self._rows: dict[Keys, list[str]] = {}
        """Coefficients 1, 2 … of factors side by side."""
        self._known: dict[Sum, str] = {}

    def add(self, which: Sum, first: Factor, second: Factor) -> None:
        """Announce a sum before anything is written."""
        self._sums[which] = first, second

    @property
    def factors(self) -> list[Factor]:
        """All factors, some twice."""
        return [factor for pair in self._sums.values() for factor in pair]

    def begin(self) -> None:
        """Choose which sums stand side by side."""
        most = min(_WIDE, machine().width)
        for squares in (False, True):
            alike = [which for which, (a, b) in self._sums.items() if (a == b) is squares]
            for at in range(0, len(alike), most):
                sums = alike[at : at + most]
                first, second = (
                    tuple((self._sums[n][side].what, self._sums[n][side].series.number) for n in sums)
                    for side in (0, 1)
                )
                self._packs.append(_Pack(sums, first, second))
                self._rows[first], self._rows[second] = [], []

    def turn(self) -> None:
        """Write the sums of the order in turn, but for products in which a coefficient 0 is a factor."""
        k, text = self._frame.order, self._frame.text
        assert k is not None
        for pack in self._packs:
            lanes = self._lanes(len(pack.sums))
            total = self._total(pack, k, lanes)
            for lane, which in enumerate(pack.sums):
                self._known[which] = (
                    literal(0.0) if k == 1
                    else total if lanes.width == 1
                    else text.op(f"extractelement {lanes.kind} {total}, i64 {lane}")
                )  # fmt: skip

    def known(self, node: Series, part: int = 0) -> str:
        """Return what `turn` has written."""
        return self._known[Sum(node.number, part)]

    def end_turn(self, coefficients: dict[tuple[str, int], str]) -> None:
        """Keep the factors' coefficients of the order in turn."""
        text = self._frame.text
        for keys, row in self._rows.items():
            lanes = self._lanes(len(keys))
            values = [coefficients[key] for key in keys]
            if lanes.width == 1:
                row.append(values[0])
                continue
            vector = lanes.const(0.0)
            for lane, value in enumerate(values):
                vector = text.op(f"insertelement {lanes.kind} {vector}, double {value}, i64 {lane}")
            row.append(vector)

    def _lanes(self, count: int) -> Fused:
        return Fused(self._frame.text, count if count < 3 else _WIDE)

    def _total(self, pack: _Pack, k: int, lanes: Fused) -> str:
        zero = lanes.const(0.0)
        a, b = [zero, *self._rows[pack.first]], [zero, *self._rows[pack.second]]
        is_square = pack.first == pack.second
        total = zero
        for j in range(k // 2 + 1, k):
            one, other = (k - j, j) if j == k - 1 else (j, k - j)
            total = lanes.mul_add(a[one], b[other], total)
            if not is_square:
                total = lanes.mul_add(a[other], b[one], total)
        if k % 2:
            return lanes.mul(lanes.const(2.0), total) if is_square else total
        middle = lanes.mul(a[k // 2], b[k // 2])
        if k == 2:
            return middle
        return lanes.mul_add(lanes.const(2.0), total, middle) if is_square else lanes.add(total, middle)
