"""Values of array statements, a strip of elements at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir import random
from desire_tui.engine.codegen.ir.functions import minimum
from desire_tui.engine.codegen.scalar.expressions import IrExpressions
from desire_tui.engine.lowered.expressions import (
    Const,
    ElementOperand,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Vec,
)
from desire_tui.engine.lowered.walk import operands, walk_values
from desire_tui.engine.random_sequence import DRAWS, MASK, jump

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.codegen.ir.lanes import Lanes
    from desire_tui.engine.codegen.vector.strips import Strip
    from desire_tui.engine.lowered.expressions import Value


class LoopSetup:
    """What a statement's loop needs from before it: invariants in all lanes, bases, products, random state.

    `states` is a stack cell with the random state of each lane *before* its first draw; `per_element` numbers
    are taken for each element.
    """

    def __init__(self) -> None:
        self.splats: dict[int, str] = {}
        self.bases: dict[int, str] = {}
        self.states = ""
        self.per_element = 0


def is_invariant(node: Value) -> bool:
    """Whether a value is one number for all elements: no operand over elements, no draw."""
    return not any(
        isinstance(n, ElementOperand) or (isinstance(n, Op) and n.name in DRAWS) for n in walk_values(node)
    )


def is_separable(*values: Value | None) -> bool:
    """Whether threads may compute different elements: none draws, or searches what delays remember."""
    return not any(
        isinstance(node, Op) and (node.name in DRAWS or node.name == "delayed")
        for node in walk_values(*values)
    )


def invariants(node: Value) -> list[Value]:
    """Return the largest parts that are the same for all elements, numbers apart."""
    if isinstance(node, Const):
        return []
    if is_invariant(node):
        return [node]
    return [part for operand in operands(node) for part in invariants(operand)]


class StripExpressions(IrExpressions):
    """Evaluates one statement for one strip."""

    def __init__(self, strip: Strip, cells: Cells, prepared: LoopSetup) -> None:
        super().__init__(strip.lanes, cells)
        self.strip = strip
        self.prepared = prepared
        self._drawn = 0
        self._state = ""

    def value(self, node: Value) -> str:
        """Write what computes `node`."""
        return self.prepared.splats.get(id(node)) or super().value(node)

    def load(self, slot: int) -> str:
        """Scalars were read before the loop."""
        raise AssertionError(f"slot {slot} was not prepared")

    def operand(self, node: ElementOperand) -> str:
        """Read the strip's elements of an operand."""
        base = self.prepared.bases[id(node)]
        strip = self.strip
        match node:
            case Vec() | MatVec():
                return strip.fetch(base)
            case ShiftedVec():
                return strip.fetch_shifted(base, node.by, node.count)
            case PatternRow():
                return strip.fetch(base)
            case Outer():
                return self._outer(node, base)
            case _:
                assert_never(node)

    def _outer(self, node: Outer, v_base: str) -> str:
        text, lanes, strip = self.text, self.lanes, self.strip
        u_base = text.op(f"getelementptr double, ptr %v, i64 {node.u_slot}")
        at = text.op(f"getelementptr double, ptr {u_base}, i64 {strip.row}")
        u = lanes.splat(text.op(f"load double, ptr {at}"))
        v = strip.fetch(v_base, strip.column)
        match node.op:
            case "mul":
                return lanes.mul(u, v)
            case "min":
                return minimum(lanes, u, v)
            case _:
                assert_never(node.op)

    def next_state(self) -> str:
        """Move each element's part of the sequence on."""
        if not self._state:
            self._state = self.text.op(f"load {self.lanes.integers}, ptr {self.prepared.states}")
        self._drawn += 1
        return random.advance(self.lanes, self._state, self._drawn)

    def finish(self) -> None:
        """Move the random states to the next strip: backwards, elements draw from the last one down."""
        if self.prepared.per_element:
            assert self._drawn == self.prepared.per_element
            moved = random.advance(self.lanes, self._state, -self.strip.active * self.prepared.per_element)
            self.text.do(f"store {self.lanes.integers} {moved}, ptr {self.prepared.states}")


def lane_states(lanes: Lanes, start: str, count: int, per_element: int) -> str:
    """Write each lane's random state before it draws for element `lane` of `count`, from the sequence's."""
    jumps = [jump((count - 1 - lane) * per_element) for lane in range(lanes.width)]
    a = ", ".join(f"i64 {jumped[0]}" for jumped in jumps)
    c = ", ".join(f"i64 {jumped[1]}" for jumped in jumps)
    text = lanes.text
    one = text.op(f"insertelement {lanes.integers} poison, i64 {start}, i64 0")
    zeros = f"<{lanes.width} x i32> zeroinitializer"
    all_same = text.op(f"shufflevector {lanes.integers} {one}, {lanes.integers} poison, {zeros}")
    grown = text.op(f"mul {lanes.integers} {all_same}, <{a}>")
    moved = text.op(f"add {lanes.integers} {grown}, <{c}>")
    return text.op(f"and {lanes.integers} {moved}, {lanes.integer(MASK)}")
