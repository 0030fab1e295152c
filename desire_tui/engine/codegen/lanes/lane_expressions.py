"""Values of lowered segments for runs in lock step: once where all runs have the same, else as vectors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir import random
from desire_tui.engine.codegen.ir.functions import LIBRARY_OPERATIONS, apply, power
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.table_lookup import table1, table2
from desire_tui.engine.codegen.ir.work_memory import Fields
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.lanes.lane_cells import Number
from desire_tui.engine.codegen.lanes.replicas import Replicas
from desire_tui.engine.codegen.lanes.shared_values import SharedLanes
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1, Table2
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.runtime.moments.memory import SideBySide

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.lanes.lane_cells import LaneCells
    from desire_tui.engine.codegen.lanes.shared_values import SharedValues
    from desire_tui.engine.lowered.expressions import ElementOperand, Value


class LaneExpressions:
    """Evaluates one statement's values; an object met again is the same number (`engine.lowered`).

    `mask`: flags of the runs that draw random numbers; None: all do.
    """

    def __init__(
        self,
        runs: Replicas,
        cells: LaneCells,
        over_elements: frozenset[int] = frozenset(),
        shared: SharedValues | None = None,
    ) -> None:
        """`over_elements`: identities of operations of vectors' elements; see `passes.scalar_elements`."""
        self.text, self.runs, self._shared = runs.text, runs, shared
        self.one = Lanes(runs.text) if shared is None else SharedLanes(shared, runs.text)
        self.cells = cells
        self._over_elements = over_elements
        self._library = Replicas(runs.text, runs.width, machine().width)
        self.mask: str | None = None
        self.is_inside = False
        """At a later stage of a step."""
        self._known: dict[int, Number] = {}

    def forget(self) -> None:
        """Begin a new statement."""
        self._known.clear()

    def value(self, node: Value) -> Number:
        """Write what computes `node`, left to right."""
        if isinstance(node, Const):
            return Number(self.one.const(node.value), wide=False)
        known = self._known.get(id(node))
        if known is None:
            known = self._known[id(node)] = self._write(node)
        return known

    def _write(self, node: Load | Op | Table1 | Table2 | ElementOperand) -> Number:
        match node:
            case Load():
                return self.cells.load(node.slot)
            case Op():
                return self._operation(node)
            case Table1():
                lanes, names = self._alike(self.value(node.x))
                return self._looked_up(lanes, names, lambda: table1(lanes, node, *names))
            case Table2():
                lanes, names = self._alike(self.value(node.x), self.value(node.y))
                return self._looked_up(lanes, names, lambda: table2(lanes, node, *names))
            case _:
                raise TypeError(f"{type(node).__name__} in runs in lock step")

    def _looked_up(self, lanes: Lanes, arguments: list[str], look: Callable[[], str]) -> Number:
        """Return what a table gives."""
        if lanes.width > 1 or self._shared is None:
            return Number(look(), lanes.width > 1)
        return Number(self._shared.value(arguments, look), wide=False)

    def _operation(self, node: Op) -> Number:
        if node.name in DRAWS:
            return self._draw(node.name, self._library if id(node) in self._over_elements else self.runs)
        if node.name == "ipow":
            lanes, (x,) = self._alike(self.value(node.args[0]))
            exponent = node.args[1]
            assert isinstance(exponent, Const)
            return Number(power(lanes, x, int(exponent.value)), lanes.width > 1)
        if node.name == "delayed":
            return self._delayed(node)
        values = [self.value(arg) for arg in node.args]
        if id(node) in self._over_elements:
            return self._of_element(node.name, values)
        lanes, names = self._alike(*values)
        return Number(apply(lanes, node.name, names), lanes.width > 1)

    def _of_element(self, name: str, values: list[Number]) -> Number:
        """Write an operation of a vector's element: its functions are the vector library's."""
        if not any(value.wide for value in values):
            if name not in LIBRARY_OPERATIONS:
                return Number(apply(self.one, name, [value.name for value in values]), wide=False)
            made = apply(self._library, name, [self.cells.wide(value) for value in values])
            return Number(self.text.op(f"extractelement {self.runs.kind} {made}, i64 0"), wide=False)
        return Number(apply(self._library, name, [self.cells.wide(value) for value in values]), wide=True)

    def _delayed(self, node: Op) -> Number:
        """Look up a value at an earlier time; number, time and, if given, what was before the start."""
        number, time, *before = node.args
        assert isinstance(number, Const)
        text, side = self.text, Fields(self.text, SideBySide, "%side")
        found = [self.cells.wide(self.value(value)) for value in (time, *before)]
        for name, value in zip(("s", "past"), found, strict=False):
            text.do(f"store {self.runs.kind} {value}, ptr {side.load(name)}, align 8")
        text.declarations.add("declare void @moments.look_up_runs(ptr, i64, i64, i64)")
        given = f"i64 {int(number.value)}, i64 {len(before)}, i64 {int(self.is_inside)}"
        text.do(f"call void @moments.look_up_runs(ptr %side, {given})")
        return Number(text.op(f"load {self.runs.kind}, ptr {side.load('found')}, align 8"), wide=True)

    def _alike(self, *values: Number) -> tuple[Lanes, list[str]]:
        """Return all values as numbers or, if one of them is a vector, as vectors."""
        if any(value.wide for value in values):
            return self.runs, [self.cells.wide(value) for value in values]
        return self.one, [value.name for value in values]

    def _draw(self, name: str, lanes: Replicas) -> Number:
        first = self._next_state()
        if name == "ran":
            return Number(random.uniform(self.runs, first), wide=True)
        return Number(random.normal(lanes, first, self._next_state()), wide=True)

    def _next_state(self) -> str:
        kind = self.runs.integers
        before = self.text.op(f"load {kind}, ptr %l.random")
        after = random.advance(self.runs, before, 1)
        kept = after
        if self.mask is not None:
            kept = self.text.op(f"select {self.runs.flags} {self.mask}, {kind} {after}, {kind} {before}")
        self.text.do(f"store {kind} {kept}, ptr %l.random")
        return after
