"""Coefficients 0 of short arrays: computed as vectors where they follow from other arrays', else read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.codegen.taylor.shuffles import Lane, collected
from desire_tui.engine.lowered.expressions import Const
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.taylor.frame import Frame

_ROOTS = frozenset((-2.5, -1.5, -0.5, 0.5, 1.5, 2.5))
"""Powers that are a root times a few factors, as in `passes.series.functions`."""


def vectors(size: int) -> range:
    """Return the numbers of the vectors that an array takes."""
    return range(-(-size // machine().width))


class ShortStarts:
    """Vectors of coefficients 0 and of constants, by series and the vector's number in it.

    Operations are those of `SeriesProgram.values_pass`, so that they have its bits.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._lanes = frame, Fused(frame.text, machine().width)
        self.rows: dict[int, list[str]] = {}
        self._constants: dict[int, list[str]] = {}
        self._reciprocals: dict[int, list[str]] = {}

    def load(self, node: Series) -> list[str]:
        """Compute or read an array's coefficients 0."""
        found = self.rows[node.number] = self._computed(node) or self._read(node)
        return found

    def load_constant(self, constant: Constant) -> None:
        """Read an array that stays what it is."""
        if constant.count is not None and id(constant) not in self._constants:
            self._constants[id(constant)] = self._neighbours(constant.slot, constant.count)

    def divide_by(self, divisor: Series | Constant, size: int) -> None:
        """Compute one over coefficients 0."""
        if id(divisor) not in self._reciprocals:
            one, lanes = self._lanes.const(1.0), self._lanes
            self._reciprocals[id(divisor)] = [lanes.div(one, self.get(divisor, i)) for i in vectors(size)]

    def get(self, operand: Series | Constant, i: int) -> str:
        """Return an operand's coefficients 0."""
        if operand.count is None:
            return self._lanes.splat(self._frame.first(operand))
        if isinstance(operand, Constant):
            return self._constants[id(operand)][i]
        return self.rows[operand.number][i]

    def reciprocal(self, divisor: Series | Constant, i: int) -> str:
        """Return what `divide_by` has computed."""
        return self._reciprocals[id(divisor)][i]

    # ------------------------------------------------------------------ read

    def _read(self, node: Series) -> list[str]:
        if not node.slots:
            return self._neighbours(node.slot, node.size)
        frame = self._frame
        frame.loaded += [(slot, 1) for slot in node.slots]
        numbers = [frame.text.op(f"load double, ptr {frame.slot(slot)}") for slot in node.slots]
        return collected(self._lanes, [Lane(number, None) for number in numbers])

    def _neighbours(self, slot: int, size: int) -> list[str]:
        """Read an array; lanes behind its end are 1."""
        text, lanes, width = self._frame.text, self._lanes, self._lanes.width
        self._frame.loaded.append((slot, size))
        found = []
        for first in range(0, size, width):
            at = self._frame.slot(slot + first)
            if first + width <= size:
                found.append(text.op(f"load {lanes.kind}, ptr {at}, align 8"))
                continue
            mask = ", ".join(f"i1 {str(first + lane < size).lower()}" for lane in range(width))
            name, flags = f"llvm.masked.load.{lanes.suffix}.p0", f"<{width} x i1>"
            text.declarations.add(f"declare {lanes.kind} @{name}(ptr, {flags}, {lanes.kind})")
            given = f"ptr align 8 {at}, {flags} <{mask}>, {lanes.kind} {lanes.const(1.0)}"
            found.append(text.op(f"call {lanes.kind} @{name}({given})"))
        return found

    # ------------------------------------------------------------------ computed

    def _computed(self, node: Series) -> list[str] | None:
        """Compute coefficients 0 that follow from the operands'; None: they have to be read."""
        if node.kind == "gather":
            return None if any(isinstance(o, Constant) for o in node.operands) else self._gathered(node)
        compute: Callable[..., str] | None = getattr(self, f"_{node.kind}", None)
        if node.kind == "power":
            exponent = _told(node.operands[1])
            if exponent not in _ROOTS:
                return None
            return [self._root(self.get(node.operands[0], i), exponent) for i in vectors(node.size)]
        if compute is None:
            return None
        return [compute(*(self.get(operand, i) for operand in node.operands)) for i in vectors(node.size)]

    def _gathered(self, node: Series) -> list[str]:
        width = self._lanes.width
        lanes = [
            Lane(self._frame.first(operand), None)
            if operand.count is None
            else Lane(self.rows[operand.number][at // width], at % width)
            for operand, at in node.lanes
            if isinstance(operand, Series)
        ]
        return collected(self._lanes, lanes)

    def _add(self, a: str, b: str) -> str:
        return self._lanes.add(a, b)

    def _sub(self, a: str, b: str) -> str:
        return self._lanes.sub(a, b)

    def _neg(self, a: str) -> str:
        return self._lanes.neg(a)

    def _times(self, a: str, b: str) -> str:
        return self._lanes.mul(a, b)

    def _plus_times(self, rest: str, term: str, factor: str) -> str:
        return self._lanes.add(rest, self._lanes.mul(term, factor))

    def _over(self, a: str, b: str) -> str:
        return self._lanes.div(a, b)

    def _mul(self, a: str, b: str) -> str:
        return self._lanes.mul(a, b)

    def _div(self, a: str, b: str) -> str:
        return self._lanes.div(a, b)

    def _sqrt(self, a: str) -> str:
        return self._lanes.intrinsic("sqrt", a)

    def _root(self, base: str, exponent: float) -> str:
        lanes = self._lanes
        found = lanes.intrinsic("sqrt", base)
        for _ in range(int(abs(exponent))):
            found = lanes.mul(base, found)
        return found if exponent > 0.0 else lanes.div(lanes.const(1.0), found)


def _told(constant: Series | Constant) -> float | None:
    """Return a number that the program's text tells."""
    value = constant.value if isinstance(constant, Constant) else None
    return value.value if isinstance(value, Const) else None
