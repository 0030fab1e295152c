"""Values of lowered segments as instructions, scalar or as vectors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir import random
from desire_tui.engine.codegen.ir.functions import apply, power
from desire_tui.engine.codegen.ir.table_lookup import table1, table2
from desire_tui.engine.codegen.ir.work_memory import memory_fields
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.random_sequence import DRAWS

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.codegen.ir.lanes import Lanes
    from desire_tui.engine.lowered.expressions import ElementOperand, Value


class IrExpressions:
    """Evaluates one statement's values; an object met again is the same number (`engine.lowered`)."""

    def __init__(self, lanes: Lanes, cells: Cells) -> None:
        self.lanes = lanes
        self.text = lanes.text
        self.cells = cells
        self._known: dict[int, str] = {}

    def value(self, node: Value) -> str:
        """Write what computes `node`, left to right; return its name."""
        kind = type(node)
        if kind is Const:
            return self.lanes.const(node.value)  # type: ignore[union-attr]  # mypy does not follow `kind`
        known = self._known.get(id(node))
        if known is None:
            known = self._known[id(node)] = self._write(node)
        return known

    def forget(self) -> None:
        """Begin a new statement."""
        self._known.clear()

    def _write(self, node: Value) -> str:
        if isinstance(node, Const):
            return self.lanes.const(node.value)
        if isinstance(node, Op):
            if node.name in DRAWS:
                return self.draw(node.name)
            if node.name == "delayed":
                return self._delayed(node)
            if node.name == "ipow":
                exponent = node.args[1]
                assert isinstance(exponent, Const)
                return power(self.lanes, self.value(node.args[0]), int(exponent.value))
            return apply(self.lanes, node.name, [self.value(a) for a in node.args])
        if isinstance(node, Load):
            return self.load(node.slot)
        if isinstance(node, Table1):
            return table1(self.lanes, node, self.value(node.x))
        if isinstance(node, Table2):
            return table2(self.lanes, node, self.value(node.x), self.value(node.y))
        return self.operand(node)

    def _delayed(self, node: Op) -> str:
        """Look up a value at an earlier time; number, time and, if given, what was before the start."""
        number, time, *before = node.args
        assert isinstance(number, Const)
        memory = memory_fields(self.text)
        s, *first = [self.value(part) for part in (time, *before)]
        call = f"call double {memory.load('look_up')}(ptr {memory.load('histories')}, i64 {int(number.value)}"
        given = first[0] if first else self.lanes.const(0.0)
        return self.text.op(f"{call}, double {s}, i64 {len(first)}, double {given})")

    def load(self, slot: int) -> str:
        """Read a scalar."""
        return self.cells.load(slot)

    def operand(self, node: ElementOperand) -> str:
        """Read the elements of a vector operand."""
        raise TypeError(f"{type(node).__name__} in a scalar expression")

    def draw(self, name: str) -> str:
        """Take a number from `ran` or `gauss`, for each element."""
        first = self.next_state()
        if name == "ran":
            return random.uniform(self.lanes, first)
        return random.normal(self.lanes, first, self.next_state())

    def next_state(self) -> str:
        """Move the random sequence on by one draw; return its state(s)."""
        raise NotImplementedError


class ScalarExpressions(IrExpressions):
    """Scalar values; random numbers come one by one from the state at `%random`."""

    def __init__(self, lanes: Lanes, cells: Cells, random: str) -> None:
        super().__init__(lanes, cells)
        self._random = random

    def next_state(self) -> str:
        """Move the sequence on."""
        before = self.text.op(f"load i64, ptr {self._random}")
        after = random.advance(self.lanes, before, 1)
        self.text.do(f"store i64 {after}, ptr {self._random}")
        return after
