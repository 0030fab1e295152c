"""The function's frame: what every part of the loop over the order may refer to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.taylor.fused import Fused
from desire_tui.engine.lowered.expressions import Const
from desire_tui.engine.passes.series.nodes import Constant, Series

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText
    from desire_tui.engine.codegen.taylor.layout import Layout


class Frame:
    """Names of values in the text.

    `%v` are the values, `%c` the coefficients, `%p` the order; inside the loop `%k` is the order in turn,
    `%kf` the same as a double, `%ki` one over it, `%ke` what that is rounded by. In straight-line code
    `order` is the order in turn, and none of these is there. `now` holds the k-th coefficients of numbers'
    series.
    """

    def __init__(self, text: IrText, layout: Layout, base: str = "%c") -> None:
        self.text, self.layout, self._base = text, layout, base
        self.order: int | None = None
        self.lanes = Fused(text)
        self.now: dict[int, str] = {}
        self.loaded: list[tuple[int, int]] = []
        """Values that are read: from which slot on, how many."""
        self._first: dict[int, str] = {}
        self._constants: dict[int, str] = {}
        self._reciprocals: dict[tuple[int, float], str] = {}

    # ------------------------------------------------------------------ before the loop

    def load_constant(self, constant: Constant) -> None:
        """Read a number that stays what it is."""
        if id(constant) in self._constants or constant.count is not None:
            return
        if isinstance(constant.value, Const):
            self._constants[id(constant)] = literal(constant.value.value)
        else:
            self.loaded.append((constant.slot, 1))
            self._constants[id(constant)] = self.text.op(f"load double, ptr {self.slot(constant.slot)}")

    def load_first(self, node: Series) -> None:
        """Read coefficient 0 of a number's series."""
        self.loaded.append((node.slot, 1))
        self._first[node.number] = self.text.op(f"load double, ptr {self.slot(node.slot)}")

    def take_first(self, node: Series, value: str) -> None:
        """Set coefficient 0 of a number's series."""
        self._first[node.number] = value

    def load_reciprocal(self, operand: Series | Constant, part: float = 1.0) -> None:
        """Compute one over a number's coefficient 0, or a part of that."""
        key = id(operand), part
        if key not in self._reciprocals:
            self._reciprocals[key] = self.text.op(f"fdiv double {literal(part)}, {self.first(operand)}")

    # ------------------------------------------------------------------ the order in turn

    def load_order(self) -> None:
        """Write what the loop needs of the order in turn."""
        text, lanes = self.text, self.lanes
        text.do("%kf = sitofp i64 %k to double")
        if machine().fuses:
            one = literal(1.0)
            text.do(f"%ki = fdiv double {one}, %kf")
            text.do(f"%ke = fmul double %ki, {lanes.mul_sub('%kf', '%ki', one)}")

    @property
    def index(self) -> str:
        """Return the order in turn as an index."""
        return "%k" if self.order is None else str(self.order)

    def times_order(self, value: str) -> str:
        """Return a number times the order in turn."""
        if self.order == 1:
            return value
        return self.lanes.mul("%kf" if self.order is None else literal(float(self.order)), value)

    def over_order(self, value: str) -> str:
        """Return a number over the order in turn, rounded once.

        A product with 1/k would be off to the same side in every step, so that energies drift.
        """
        if self.order is None:
            return self.all_over_order(self.lanes, value)
        return self.lanes.over(value, self.order)

    def all_over_order(self, lanes: Fused, values: str) -> str:
        """Return numbers over the order in turn, inside the loop."""
        if machine().fuses:
            return lanes.times_pair(values, lanes.splat("%ki"), lanes.splat("%ke"))
        return lanes.div(values, lanes.splat("%kf"))

    # ------------------------------------------------------------------ anywhere

    def first(self, operand: Series | Constant) -> str:
        """Return a number's coefficient 0."""
        return self._constants[id(operand)] if isinstance(operand, Constant) else self._first[operand.number]

    def reciprocal(self, operand: Series | Constant, part: float = 1.0) -> str:
        """Return one over a number's coefficient 0, or a part of that."""
        return self._reciprocals[id(operand), part]

    def coefficient(self, operand: Series | Constant) -> str:
        """Return a number's k-th coefficient."""
        return literal(0.0) if isinstance(operand, Constant) else self.now[operand.number]

    def slot(self, slot: int) -> str:
        """Return a value's address."""
        return self.text.op(f"getelementptr double, ptr %v, i64 {slot}")

    def at(self, place: int, index: str = "") -> str:
        """Return the address of `place` (+ `index`) among the coefficients."""
        base = self.text.op(f"getelementptr double, ptr {self._base}, i64 {place}")
        return self.text.op(f"getelementptr double, ptr {base}, i64 {index}") if index else base

    def get(self, place: int, index: str = "") -> str:
        """Read one of the coefficients."""
        return self.text.op(f"load double, ptr {self.at(place, index)}")

    def put(self, place: int, value: str, index: str = "") -> None:
        """Write one of the coefficients."""
        self.text.do(f"store double {value}, ptr {self.at(place, index)}")

    def row(self, node: Series, order: str = "%k") -> str:
        """Return the address of an array's coefficients of an order."""
        offset = self.text.op(f"mul i64 {order}, {self.layout.apart(node)}")
        return self.at(self.layout.place(node), offset)
