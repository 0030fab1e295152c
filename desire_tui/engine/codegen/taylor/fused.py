"""Products added without a rounding between, where the processor can: for the series of rule 17 alone."""

from __future__ import annotations

from fractions import Fraction

from desire_tui.engine.codegen.exact_functions.pairs import Pairs
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.jit.compiler import machine


class Fused(Lanes):
    """Lanes whose products may be added at once.

    Written as calls of `llvm.fma`, not as a flag that lets LLVM fuse what it likes: quick and fast code must
    have the same bits, as a run changes over between them when the clock says so.
    """

    __slots__ = ()

    def mul_add(self, a: str, b: str, c: str) -> str:
        """Return a·b + c."""
        if not machine().fuses:
            return self.add(self.mul(a, b), c)
        return Pairs(self).fma(a, b, c)

    def mul_sub(self, a: str, b: str, c: str) -> str:
        """Return c - a·b."""
        if not machine().fuses:
            return self.sub(c, self.mul(a, b))
        return Pairs(self).fma(self.neg(a), b, c)

    def over(self, a: str, divisor: int) -> str:
        """Return a / divisor for a small whole number, rounded once as a division is."""
        if not machine().fuses or divisor & (divisor - 1) == 0:  # LLVM multiplies by powers of two itself
            return a if divisor == 1 else self.div(a, self.const(float(divisor)))
        high = 1.0 / divisor
        low = float(Fraction(1, divisor) - Fraction(high))
        return self.times_pair(a, self.const(high), self.const(low))

    def times_pair(self, a: str, high: str, low: str) -> str:
        """Return a / divisor, rounded once, from 1 / divisor in twice the digits.

        a·z + a·z' with z + z' = 1/divisor in twice the digits: a quotient is never nearer to the middle
        between two doubles than 1/(2·divisor) of their distance, which is far more than the error
        (Brisebarre, Muller and Raina, IEEE Trans. Computers 53 (2004)).
        """
        return self.mul_add(a, high, self.mul(a, low))
