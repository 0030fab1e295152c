"""Arithmetic on unevaluated sums of two doubles, elementwise: 106 bits where 53 are not enough.

T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18 (1971), with
fused multiplication and addition for the errors of products (Muller et al., "Handbook of Floating-Point
Arithmetic", 2nd ed. 2018, chapter 4).
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.ir.lanes import Lanes


class Pair(NamedTuple):
    """The sum `high + low`; low is small beside high."""

    high: str
    low: str


class Pairs:
    """Writes operations on pairs into the text of some lanes."""

    def __init__(self, lanes: Lanes) -> None:
        self.lanes = lanes

    def fma(self, a: str, b: str, c: str) -> str:
        """Return a·b + c, rounded once."""
        lanes = self.lanes
        function = f"llvm.fma.{lanes.suffix}"
        kinds = ", ".join([lanes.kind] * 3)
        lanes.text.declarations.add(f"declare {lanes.kind} @{function}({kinds})")
        listed = ", ".join(f"{lanes.kind} {x}" for x in (a, b, c))
        return lanes.text.op(f"call {lanes.kind} @{function}({listed})")

    def const(self, value: float) -> str:
        """Return a number in every lane."""
        return self.lanes.const(value)

    def sum(self, large: str, small: str) -> Pair:
        """Return large + small without error where |large| ≥ |small| (Fast2Sum)."""
        lanes = self.lanes
        high = lanes.add(large, small)
        return Pair(high, lanes.add(lanes.sub(large, high), small))

    def product(self, a: str, b: str) -> Pair:
        """Return a·b without error."""
        high = self.lanes.mul(a, b)
        return Pair(high, self.fma(a, b, self.lanes.neg(high)))

    def by_squares(self, x: str, coefficients: Sequence[Fraction]) -> str:
        """Return Σ coefficient[i]·xⁱ in plain doubles: terms are joined two by two (Estrin)."""
        terms = [self.const(float(coefficient)) for coefficient in coefficients]
        power = x
        while len(terms) > 1:
            joined = [self.fma(power, b, a) for a, b in zip(terms[::2], terms[1::2], strict=False)]
            terms = joined + terms[len(terms) & ~1 :]
            if len(terms) > 1:
                power = self.lanes.mul(power, power)
        return terms[0]


def split(value: Fraction) -> tuple[float, float]:
    """Return the double next to a number, and the double next to what is left."""
    high = float(value)
    return high, float(value - Fraction(high))
