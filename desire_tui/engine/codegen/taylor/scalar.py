"""Recurrences of numbers' series.

Each turn waits for the one before: what can be computed from lower orders alone is (`Sums.known`, and that
over the order), so that as little as possible stands between an operand's newest coefficient and the result.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.taylor.sums import Factor, Sum
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.taylor.frame import Frame
    from desire_tui.engine.codegen.taylor.straight_sums import StraightSums
    from desire_tui.engine.codegen.taylor.sums import Sums

WITH_SUMS = frozenset(("mul", "div", "sqrt", "integral", "quotient", "power"))
"""Kinds whose coefficients are sums of products."""


class ScalarRecurrences:
    """Writes the turns of numbers' series."""

    def __init__(self, frame: Frame, sums: Sums | StraightSums) -> None:
        self._frame, self._sums = frame, sums
        self._lanes = frame.lanes
        self._slopes: dict[int, str] = {}
        self._rates: dict[int, str] = {}
        """Of powers, their derivative by the base at the step's start."""

    # ------------------------------------------------------------------ before the loop

    def announce(self, node: Series) -> bool:
        """Tell `sums` the sums of products that a series consists of; whether there is one."""
        sums = _factors(node) if node.kind in WITH_SUMS else ()
        for part, factors in enumerate(sums):
            self._sums.add(Sum(node.number, part), *factors)
        return len(sums) > 0

    def prepare(self, node: Series) -> None:
        """Compute before the loop what a series needs in it."""
        if node.kind in {"div", "quotient", "over"}:
            self._frame.load_reciprocal(node.operands[1])
        if node.kind == "power":
            base, exponent = node.operands
            self._frame.load_reciprocal(base)
            now = self._lanes.mul(self._frame.first(exponent), self._frame.first(node))
            self._rates[node.number] = self._lanes.mul(now, self._frame.reciprocal(base))
        if node.kind == "sqrt":
            self._frame.load_reciprocal(node, 0.5)

    # ------------------------------------------------------------------ in the loop

    def write(self, node: Series) -> None:
        """Write what computes a series' k-th coefficient."""
        write: Callable[[Series], str] = getattr(self, f"_{node.kind}")
        self._frame.now[node.number] = write(node)

    def begin_turn(self) -> None:
        """Forget what belongs to the order before, in straight-line code."""
        self._slopes.clear()

    def factors(self, wanted: list[Factor]) -> dict[tuple[str, int], str]:
        """Return the k-th coefficients of factors."""
        return {
            (f.what, f.series.number): self._frame.coefficient(f.series)
            if f.what == "value"
            else self._slope(f.series)
            for f in wanted
        }

    def _slope(self, series: Series) -> str:
        """Return k·a_k, for products with a derivative."""
        value = self._slopes.get(series.number)
        if value is None:
            value = self._frame.times_order(self._frame.coefficient(series))
            self._slopes[series.number] = value
        return value

    def _time(self, _node: Series) -> str:
        if self._frame.order is not None:
            return literal(float(self._frame.order == 1))
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

    def _plus_times(self, node: Series) -> str:
        rest, term, factor = node.operands
        frame = self._frame
        return self._lanes.mul_add(frame.coefficient(term), frame.first(factor), frame.coefficient(rest))

    def _over(self, node: Series) -> str:
        a, b = node.operands
        return self._lanes.mul(self._frame.coefficient(a), self._frame.reciprocal(b))

    def _mul(self, node: Series) -> str:
        a, b = node.operands
        lanes, frame = self._lanes, self._frame
        known = self._sums.known(node)
        if a is b:
            return lanes.mul_add(lanes.mul(literal(2.0), frame.first(a)), frame.coefficient(a), known)
        first, second = sorted((a, b), key=_number)  # what is known later is added last
        known = lanes.mul_add(frame.coefficient(first), frame.first(second), known)
        return lanes.mul_add(frame.first(first), frame.coefficient(second), known)

    def _div(self, node: Series) -> str:
        a, b = node.operands
        lanes, frame = self._lanes, self._frame
        known = lanes.mul_add(frame.first(node), frame.coefficient(b), self._sums.known(node))
        rest = lanes.neg(known) if isinstance(a, Constant) else lanes.sub(frame.coefficient(a), known)
        return lanes.mul(rest, frame.reciprocal(b))

    def _sqrt(self, node: Series) -> str:
        lanes, frame = self._lanes, self._frame
        rest = lanes.sub(frame.coefficient(node.operands[0]), self._sums.known(node))
        return lanes.mul(rest, frame.reciprocal(node, 0.5))

    def _integral(self, node: Series) -> str:
        factor, inner = node.operands
        assert isinstance(inner, Series)
        lanes, frame = self._lanes, self._frame
        if isinstance(factor, Constant):
            return lanes.mul(frame.first(factor), frame.coefficient(inner))
        return lanes.mul_add(
            frame.coefficient(inner), frame.first(factor), frame.over_order(self._sums.known(node))
        )

    def _quotient(self, node: Series) -> str:
        a, b = node.operands
        lanes, frame = self._lanes, self._frame
        rest = lanes.sub(frame.coefficient(a), frame.over_order(self._sums.known(node)))
        return lanes.mul(rest, frame.reciprocal(b))

    def _power(self, node: Series) -> str:
        """Return u_k from k·a_0·u_k = Σ (b·j·a_j·u_{k-j} - a_j·(k - j)·u_{k-j}), j from 1 to k."""
        base, exponent = node.operands
        lanes, frame = self._lanes, self._frame
        by_slopes, slopes = (self._sums.known(node, part) for part in (0, 1))
        known = lanes.mul(
            lanes.mul_add(frame.first(exponent), by_slopes, lanes.neg(slopes)), frame.reciprocal(base)
        )
        return lanes.mul_add(self._rates[node.number], frame.coefficient(base), frame.over_order(known))

    def _select(self, node: Series) -> str:
        condition, yes, no = node.operands
        flag = self._lanes.compare("ogt", self._frame.first(condition), literal(0.0))
        return self._lanes.choose(flag, self._frame.coefficient(yes), self._frame.coefficient(no))


def _factors(node: Series) -> tuple[tuple[Factor, Factor], ...]:
    """Return the factors of each sum of products that a series has."""
    series = [operand for operand in node.operands if isinstance(operand, Series)]
    match node.kind:
        case "mul":
            return ((Factor("value", series[0]), Factor("value", series[1])),)
        case "div":
            return ((Factor("value", node), Factor("value", series[-1])),)
        case "sqrt":
            return ((Factor("value", node), Factor("value", node)),)
        case "quotient":
            return ((Factor("slope", node), Factor("value", series[1])),)
        case "power":
            base = series[0]
            return (
                (Factor("slope", base), Factor("value", node)),
                (Factor("value", base), Factor("slope", node)),
            )
        case _:  # integral
            if len(series) == 1:
                return ()
            return ((Factor("slope", series[1]), Factor("value", series[0])),)


def _number(operand: Series | Constant) -> int:
    return operand.number if isinstance(operand, Series) else -1
