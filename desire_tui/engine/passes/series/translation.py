"""From a derivative pass to the series that it is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn, assert_never

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.lowered.effects import count_draws, expressions, reads_replaced, role, writes
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
from desire_tui.engine.lowered.statements import (
    Deriv,
    DerivVec,
    Guard,
    Set,
    SetDot,
    SetMat,
    SetVec,
)
from desire_tui.engine.lowered.walk import simple_actions
from desire_tui.engine.passes.series import functions
from desire_tui.engine.passes.series.graph import Graph, NoSeriesError, widest
from desire_tui.engine.passes.series.grouping import grouped
from desire_tui.engine.passes.series.nodes import Constant, SeriesProgram, StatePiece
from desire_tui.engine.passes.series.reading import Slots
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, Assignment
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.passes.series.nodes import Operand, Series


_TWO = {
    "add": functions.add, "sub": functions.sub, "mul": functions.mul, "div": functions.div,
    "pow": functions.power, "atan2": functions.angle,
}  # fmt: skip
_HELD = frozenset(("swtch", "sgn", "deadc", "rect", "round", "trnc"))
"""What stays as it is until the next switch, where a step ends."""


def series_program(
    segment: Segment, switching: Switching | None, allocate: Callable[[int], int]
) -> SeriesProgram:
    """Translate a segment whose switches are frozen (`passes.switching`), whose kinks are choices (`pieces`).

    `allocate(count)` gives the first of `count` slots. NoSeriesError: a statement has no series.
    """
    program = _Translator(segment, allocate).program(switching)
    return grouped(program, allocate, segment.states[0].where)


class _Translator:
    def __init__(self, segment: Segment, allocate: Callable[[int], int]) -> None:
        self._segment = segment
        self._actions = derivative_slice(segment)
        self._where = segment.states[0].where
        self._graph = Graph(allocate, self._where)
        for action in simple_actions(self._actions):
            if role(action) == "effect":
                for slot, count in writes(action):
                    self._graph.remembered.add(slot, count)
        self._slots = Slots(self._graph)
        self._made: dict[tuple[object, ...], Operand] = {}
        self._known: dict[int, tuple[Value, Operand]] = {}
        self._derivatives: dict[int, tuple[Operand, int]] = {}
        """Of each state, the last that a statement gives: an operand and which element of it."""

    def program(self, switching: Switching | None) -> SeriesProgram:
        """Translate everything."""
        pieces = self._states()
        self._slots.put(T, self._graph.given("time", T, None), None)
        for piece, _ in pieces:
            self._slots.put(piece.slot, piece, piece.count)
        begin = self._slots.copy()
        self._run(self._actions)
        states: list[StatePiece] = []
        for piece, first in pieces:
            derivative = self._derivative(piece, first)
            if isinstance(derivative, Constant):
                derivative = self._graph.stored(derivative)
            states.append(StatePiece(piece, first, piece.size, derivative))
        self._slots = begin
        arguments = self._arguments(switching)
        graph = self._graph
        return SeriesProgram(tuple(graph.values_pass), tuple(graph.nodes), tuple(states), arguments)

    def _states(self) -> list[tuple[Series, int]]:
        """Make series of the states, arrays where a statement gives several derivatives; first numbers."""
        wide = SlotSet()
        for action in simple_actions(self._actions):
            if isinstance(action, DerivVec):
                wide.add(action.state, action.count)
        found: list[tuple[Series, int]] = []
        for given in self._segment.states:
            if wide.overlaps(given.first, given.count):
                found.append((self._graph.given("state", given.slot, given.count), given.first))
                continue
            found.extend(
                (self._graph.given("state", given.slot + at, None), given.first + at)
                for at in range(given.count)
            )
        return found

    def _derivative(self, piece: Series, first: int) -> Operand:
        """Return a state's derivative, of an array of states all of them."""
        lanes = [self._derivatives[first + i] for i in range(piece.size)]
        operand = lanes[0][0]
        if piece.count is None and operand.count is None:
            return operand
        whole = operand.count == piece.count
        if whole and all(found is operand and at == i for i, (found, at) in enumerate(lanes)):
            return operand
        made = self._graph.gather(tuple(lanes))
        return made if piece.count is not None else self._graph.element(made)

    def _arguments(self, switching: Switching | None) -> tuple[tuple[Operand, int], ...]:
        """Translate what decides about the modes, over the modes in force."""
        if switching is None or not switching.modes:
            return ()
        row = switching.slots.arguments
        kept = len(self._graph.nodes), len(self._graph.values_pass)
        try:
            self._run(switching.live_pass)
        except NoSeriesError:  # it is looked at in some places of a step
            del self._graph.nodes[kept[0] :], self._graph.values_pass[kept[1] :]
            return ()
        found: list[tuple[Operand, int]] = [self._slots.lane(row + i) for i in range(switching.count)]
        return tuple((self._graph.stored(o) if isinstance(o, Constant) else o, at) for o, at in found)

    # ------------------------------------------------------------------ statements

    def _run(self, actions: Iterable[Action]) -> None:
        for action in actions:
            cancellation_point()
            self._known.clear()  # an expression means something only within its statement
            self._where = self._graph.where = action.where
            self._statement(action)

    def _statement(self, action: Action) -> None:
        match action:
            case Deriv():
                self._derivatives[action.state] = self._of(action.value), 0
            case DerivVec():
                row = self._wide(self._of(action.value), action.count)
                for i in range(action.count):
                    self._derivatives[action.state + i] = row, i
            case Set() | SetVec() | SetMat() | SetDot():
                if count_draws(*expressions(action)):
                    self._refuse("noise")
                if reads_replaced(action):
                    self._refuse("in-place")
                self._assign(action)
            case Guard():
                if action.kind != "if" or action.condition is None:
                    self._refuse("remembers")
                self._branch(action, self._of(action.condition))
            case _:
                self._refuse("remembers")

    def _branch(self, guard: Guard, condition: Operand) -> None:
        before = self._slots
        sides = []
        for actions in (guard.body, guard.orelse):
            self._slots = before.copy()
            self._run(actions)
            sides.append(self._slots)
        self._slots = before
        self._where = self._graph.where = guard.where
        before.choose(condition, *sides)

    def _assign(self, action: Assignment) -> None:
        if isinstance(action, Set):
            self._slots.put(action.slot, self._of(action.value), None)
            return
        if isinstance(action, SetDot):
            self._slots.put(action.slot, self._dot(action), None)
            return
        if action.mode != "set" or action.mask_slot is not None:
            self._refuse("array")
        if isinstance(action, SetVec):
            count = action.count
        else:
            count = action.rows * action.cols
            if action.lower is not None or action.upper is not None:
                self._refuse("array")
        self._slots.put(action.slot, self._wide(self._of(action.value), count), count)

    def _wide(self, operand: Operand, count: int) -> Operand:
        """Return an array of an operand that may be one number."""
        if operand.count is not None:
            return operand
        if isinstance(operand, Constant):
            return self._graph.constant(("wide", id(operand), count), operand.value, count)
        graph = self._graph
        return graph.series("times", graph.value(operand), operand, graph.number(1.0), count=count)

    def _dot(self, action: SetDot) -> Operand:
        g = self._graph
        total: Operand | None = None
        length = 0
        for term in action.terms:
            length = term.left.count
            left = self._of(term.left)
            product = left if term.right is None else functions.mul(g, left, self._of(term.right))
            part = self._total(product, length)
            if total is None:
                total = part if term.sign > 0.0 else functions.neg(g, part)
            else:
                total = (functions.add if term.sign > 0.0 else functions.sub)(g, total, part)
        assert total is not None
        return functions.div(g, total, g.number(float(length))) if action.average else total

    def _total(self, product: Operand, length: int) -> Operand:
        """Return the sum of an array's elements."""
        g = self._graph
        if isinstance(product, Constant):
            product = g.stored(product)
        key = ("total", id(product))
        known = self._made.get(key)
        if known is None:
            slot = g.allocate(None)
            assert isinstance(product.value if isinstance(product, Constant) else g.value(product), Vec)
            known = self._made[key] = g.total(product, slot, length)
        return known

    # ------------------------------------------------------------------ expressions

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
