"""Expressions of a derivative pass as series and constants."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn, assert_never

from desire_tui.engine.lowered.expressions import (
    Const,
    Load,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.passes.series import functions
from desire_tui.engine.passes.series.graph import Graph, NoSeriesError, widest
from desire_tui.engine.passes.series.nodes import Constant
from desire_tui.engine.passes.series.reading import Slots

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.passes.series.nodes import Operand


_TWO = {
    "add": functions.add, "sub": functions.sub, "mul": functions.mul, "div": functions.div,
    "pow": functions.power, "atan2": functions.angle,
}  # fmt: skip
_HELD = frozenset(("swtch", "sgn", "deadc", "rect", "round", "trnc", "floor"))
"""What stays as it is until the next switch, where a step ends."""


class Expressions:
    """Translates expressions; statements are `translation`'s."""

    def __init__(self, where: Where, allocate: Callable[[int], int]) -> None:
        self._where = where
        self._graph = Graph(allocate, where)
        self._slots = Slots(self._graph)
        self._made: dict[tuple[object, ...], Operand] = {}
        self._known: dict[int, tuple[Value, Operand]] = {}

    def _of(self, value: Value) -> Operand:
        """Translate an expression; one that occurs twice is treated once."""
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = (value, self._translate(value))
        return known[1]

    def _translate(self, value: Value) -> Operand:
        g = self._graph
        match value:
            case Const():
                return g.number(value.value)
            case Load():
                return self._slots.number(value.slot)
            case Op():
                return self._operation(value)
            case Vec():
                return self._slots.array(value.slot, value.count)
            case ShiftedVec():
                return self._shifted(value)
            case MatVec():
                return self._product(value)
            case Outer():
                return self._outer(value)
            case Table1() | Table2():
                return self._table(value)
            case PatternRow():
                return self._constant_array(value, value.slot, value.rows * value.cols, value.cols)
            case _:
                assert_never(value)

    def _operation(self, value: Op) -> Operand:
        if value.name in {"ran", "gauss"}:
            self._refuse("noise")
        if value.name == "delayed":
            self._refuse("delay")
        operands = [self._of(argument) for argument in value.args]
        key = (value.name, *map(id, operands))
        known = self._made.get(key)
        if known is None:
            known = self._made[key] = self._apply(value.name, operands)
        return known

    def _apply(self, name: str, operands: list[Operand]) -> Operand:
        g = self._graph
        if name == "ipow":
            exponent = operands[1]
            assert isinstance(exponent, Constant)
            assert isinstance(exponent.value, Const)
            return functions.whole_power(g, operands[0], int(exponent.value.value))
        if name == "comp":
            return functions.choose(g, *operands)
        if name in _HELD or all(isinstance(operand, Constant) for operand in operands):
            return g.computed(name, *(g.held(operand) for operand in operands))
        if name in _TWO:
            return _TWO[name](g, *operands)
        function, operand = functions.FUNCTIONS.get(name), operands[0]
        if function is None or isinstance(operand, Constant):
            self._refuse("function", name)
        return function(g, operand)

    def _shifted(self, value: ShiftedVec) -> Operand:
        g, given = self._graph, self._slots.array(value.slot, value.count)
        if isinstance(given, Constant):
            given = g.stored(given)
            if not isinstance(given.value, Vec):
                given = g.placed(given)
            key = ("shift", id(given), value.by)
            return g.constant(key, ShiftedVec(given.slot, value.count, value.by), value.count)
        moved = ShiftedVec(given.slot, value.count, value.by)
        return g.series("shift", moved, given, count=value.count, by=value.by)

    def _product(self, value: MatVec) -> Operand:
        g = self._graph
        inner, outer = (value.rows, value.cols) if value.transposed else (value.cols, value.rows)
        matrix = self._slots.array(value.slot, value.rows * value.cols)
        x = self._slots.array(value.x_slot, inner)
        if not isinstance(matrix, Constant):
            self._refuse("matrix")
        placed = g.placed(matrix)
        if isinstance(x, Constant):
            at = g.placed(x)
            key = ("product", id(placed), id(at), value.transposed)
            made = MatVec(placed.slot, value.rows, value.cols, value.transposed, at.slot)
            return g.constant(key, made, outer)
        made = MatVec(placed.slot, value.rows, value.cols, value.transposed, x.slot)
        layout = (placed.slot, value.rows, value.cols, value.transposed)
        return g.series("product", made, x, count=outer, matrix=layout)

    def _outer(self, value: Outer) -> Operand:
        g = self._graph
        u, v = self._slots.array(value.u_slot, value.u_count), self._slots.array(value.v_slot, value.v_count)
        if value.op != "mul":
            self._refuse("array")
        lanes = [(i, k) for i in range(value.u_count) for k in range(value.v_count)]
        left = g.gather(tuple(self._element(u, i) for i, _ in lanes))
        right = g.gather(tuple(self._element(v, k) for _, k in lanes))
        return functions.mul(g, left, right)

    def _element(self, operand: Operand, at: int) -> tuple[Operand, int]:
        return (self._graph.placed(operand) if isinstance(operand, Constant) else operand), at

    def _table(self, value: Table1 | Table2) -> Operand:
        """Return a table's value where nothing moves it; tables of one argument elsewhere are `pieces`."""
        g = self._graph
        inputs = (value.x,) if isinstance(value, Table1) else (value.x, value.y)
        operands = [self._of(x) for x in inputs]
        if not all(isinstance(operand, Constant) for operand in operands):
            self._refuse("table")
        values = [g.value(operand) for operand in operands]
        key: tuple[object, ...] = ("table", *map(id, operands))
        if isinstance(value, Table1):
            made: Value = Table1(values[0], value.slot, value.count)
            key += (value.slot, value.count)
        else:
            made = Table2(
                values[0], values[1], value.f_slot, value.rows, value.cols, value.x_slot, value.y_slot
            )
            key += (value.f_slot, value.x_slot, value.y_slot)
        return g.constant(key, made, widest(*operands))

    def _constant_array(self, value: PatternRow, slot: int, size: int, count: int) -> Operand:
        if not isinstance(self._slots.array(slot, size), Constant):
            self._refuse("matrix")
        return self._graph.constant(("row", slot, size), value, count)

    def _refuse(self, what: str, name: str = "") -> NoReturn:
        raise NoSeriesError(self._where, what if not name else f"{what}:{name}")
