"""From a derivative pass to the series that it is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.lowered.effects import count_draws, expressions, reads_replaced, role, writes
from desire_tui.engine.lowered.expressions import (
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
from desire_tui.engine.passes.series.conditions import condition_pass, conditions_of_time, is_smooth
from desire_tui.engine.passes.series.expressions import Expressions
from desire_tui.engine.passes.series.graph import NoSeriesError
from desire_tui.engine.passes.series.grouping import grouped
from desire_tui.engine.passes.series.nodes import (
    NEVER_INSIDE,
    SAMPLED,
    Constant,
    SeriesProgram,
    StatePiece,
)
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.slot_set import SlotSet
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, Assignment
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.passes.series.nodes import Operand, Series
    from desire_tui.engine.passes.series.reading import Slots


def series_program(
    segment: Segment, switching: Switching | None, allocate: Callable[[int], int]
) -> SeriesProgram:
    """Translate a segment whose switches are frozen (`passes.switching`), whose kinks are choices (`pieces`).

    `allocate(count)` gives the first of `count` slots. NoSeriesError: a statement has no series.
    """
    program = _Translator(segment, allocate).program(switching)
    return grouped(program, allocate, segment.states[0].where)


class _Translator(Expressions):
    def __init__(self, segment: Segment, allocate: Callable[[int], int]) -> None:
        super().__init__(segment.states[0].where, allocate)
        self._segment = segment
        self._actions = derivative_slice(segment)
        for action in simple_actions(self._actions):
            if role(action) == "effect":
                for slot, count in writes(action):
                    self._graph.remembered.add(slot, count)
        self._derivatives: dict[int, tuple[Operand, int]] = {}
        """Of each state, the last that a statement gives: an operand and which element of it."""
        self._has_refused = False
        """Whether something that steps can do without has no series."""

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
        self._slots = begin.copy()
        arguments = list(self._arguments(switching))
        mode_count = len(arguments)
        conditions = tuple(self._conditions(switching, begin, arguments))
        graph = self._graph
        if self._has_refused:
            roots = [operand for piece in states for operand in (piece.series, piece.derivative)]
            graph.keep_used(roots + [operand for operand, _ in arguments])
        parts = tuple(graph.values_pass), tuple(graph.nodes), tuple(states), tuple(arguments)
        return SeriesProgram(*parts, mode_count, conditions)

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
        try:
            self._run(switching.live_pass)
        except NoSeriesError:  # it is looked at in some places of a step
            self._has_refused = True
            return ()
        found: list[tuple[Operand, int]] = [self._slots.lane(row + i) for i in range(switching.count)]
        return tuple((self._graph.stored(o) if isinstance(o, Constant) else o, at) for o, at in found)

    def _conditions(
        self, switching: Switching | None, begin: Slots, arguments: list[tuple[Operand, int]]
    ) -> Iterator[int]:
        """Translate the events' conditions, and add them to the arguments; yield each one's number there."""
        timed = conditions_of_time(switching)
        for number, event in enumerate(self._segment.events):
            if event.condition is None or id(event.condition) in timed:
                yield NEVER_INSIDE
                continue
            pass_ = condition_pass(self._segment, number)
            self._slots = begin.copy()
            try:
                if not is_smooth(pass_, self._actions):
                    self._refuse("function")
                self._run(pass_[:-1])
                self._known.clear()
                self._where = self._graph.where = event.where
                found = self._of(event.condition)
            except NoSeriesError:
                self._has_refused = True
                yield SAMPLED
                continue
            arguments.append((self._graph.stored(found) if isinstance(found, Constant) else found, 0))
            yield len(arguments) - 1

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
