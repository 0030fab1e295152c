"""Forward differentiation of a segment: statements that compute J·v for a direction v of the states.

Every number that depends on the states gets a tangent beside it, every assignment one more that computes the
tangent: first the tangent, from the old operands, then the number itself. The derivative statements give
the tangents of the derivatives, so a back end compiles the result like any derivative pass and calls it
once for each column (or group of columns, `integration.pattern`) of the Jacobian. Griewank and Walther,
"Evaluating Derivatives", chapter 3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.lowered.effects import reads_replaced, role, writes
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
    DotTerm,
    EffectAction,
    Guard,
    Set,
    SetDot,
    SetMat,
    SetVec,
)
from desire_tui.engine.lowered.walk import walk_actions, with_bodies
from desire_tui.engine.passes.dead_code import without_dead_code
from desire_tui.engine.passes.derivative_rules import DERIVATIVE_RULES, ZERO, op, plus
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.tangents import NotDifferentiable, Tangents

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment, StateRange
    from desire_tui.engine.lowered.statements import Action, Assignment, SimpleAction

_NUDGE = Const(1e-6)
"""Relative distance over which a table is differenced: exact inside an interval, where it is linear."""


@dataclass(frozen=True)
class TangentPass:
    """The tangent pass: `body`'s derivatives are J·v, v the `order` numbers from slot `directions` on."""

    body: tuple[Action, ...]
    directions: int


def differentiate(segment: Segment, allocate: Callable[[int], int]) -> TangentPass:
    """Differentiate a segment's derivative pass; `allocate(count)` gives the first of `count` zero slots.

    NotDifferentiable: the pass draws random numbers, remembers, or uses a statement that has no derivative.
    """
    actions = derivative_slice(segment)
    tangents = Tangents(segment.states, actions, allocate)
    body = [_copied(slot, tangents.directions + s.first, s) for slot, s in tangents.copies]
    for action in walk_actions(actions):
        if action.kind != "if" if isinstance(action, Guard) else role(action) == "effect":
            raise NotDifferentiable(action)
    body += with_tangents([Differentiator(tangents)], actions, derivatives=False)
    return TangentPass(without_dead_code(tuple(body)), tangents.directions)


def _copied(slot: int, source: int, states: StateRange) -> Action:
    """Return the statement that copies a part of the direction."""
    if states.count == 1:
        return Set(slot, Load(source), states.where)
    return SetVec(slot, states.count, Vec(source, states.count), states.where)


def with_tangents(
    differentiators: Sequence[Differentiator], actions: Iterable[Action], *, derivatives: bool = True
) -> tuple[Action, ...]:
    """Return statements, each behind those which compute its tangents.

    Without `derivatives` those themselves are left out, and only their tangents are there.
    """
    made: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            body, orelse = (
                with_tangents(differentiators, part, derivatives=derivatives)
                for part in (action.body, action.orelse)
            )
            made.append(with_bodies(action, body, orelse))
            continue
        for differentiator in differentiators:
            made += differentiator.tangent(action)
        if derivatives or role(action) != "derivative":
            made.append(action)
    return tuple(made)


class Differentiator:
    """Writes tangents where `tangents` has room for them.

    The derivatives' tangents are those of the states from number `first_state` on. `delayed` writes the
    tangent of an operation `delayed`, which has none without it.
    """

    def __init__(
        self,
        tangents: Tangents,
        first_state: int = 0,
        delayed: Callable[[Differentiator, Op], Value | None] | None = None,
    ) -> None:
        self._tangents = tangents
        self._first = first_state
        self._delayed = delayed
        self._known: dict[int, tuple[Value, Value | None]] = {}

    # ------------------------------------------------------------------ statements

    def tangent(self, action: SimpleAction) -> Iterator[Action]:
        """Yield the statement that computes a statement's tangent, to be executed before it; none for 0.

        NotDifferentiable: it has no derivative.
        """
        self._known.clear()  # an expression means something only within its statement
        match action:
            case Deriv():
                yield Deriv(self._first + action.state, self.of(action.value) or ZERO, action.where)
            case DerivVec():
                yield DerivVec(
                    self._first + action.state, action.count, self.of(action.value) or ZERO, action.where
                )
            case Set() | SetVec() | SetMat() | SetDot():
                if reads_replaced(action):
                    raise NotDifferentiable(action)
                yield from self._assignment(action)
            case _:
                if isinstance(action, EffectAction):
                    if any(self._tangents.slot(slot) is not None for slot, _ in writes(action)):
                        raise NotDifferentiable(action)
                    return
                assert_never(action)

    def _assignment(self, action: Assignment) -> Iterable[Action]:
        """Tangent of an assignment, if its target depends on the states at all."""
        slot = self._tangents.slot(action.slot)
        if slot is None:
            return
        if isinstance(action, SetDot):
            terms = tuple(self._dot_terms(action))
            if terms:
                yield SetDot(slot, terms, action.average, action.where, action.persistent)
            else:
                yield Set(slot, ZERO, action.where, action.persistent)
            return
        value = self.of(action.value) or ZERO
        if isinstance(action, Set):
            yield Set(slot, value, action.where, action.persistent)
        elif isinstance(action, SetVec):
            if action.mode == "largest":
                raise NotDifferentiable(action)
            yield SetVec(
                slot, action.count, value, action.where, action.mode, action.mask_slot, action.persistent
            )
        elif action.lower is not None or action.upper is not None:
            raise NotDifferentiable(action)
        else:
            yield SetMat(
                slot, action.rows, action.cols, value, action.where, action.mode,
                mask_slot=action.mask_slot, persistent=action.persistent,
            )  # fmt: skip

    def _dot_terms(self, action: SetDot) -> Iterable[DotTerm]:
        vector = self._tangents.vector
        for term in action.terms:
            left = vector(term.left)
            if left is not None:
                yield DotTerm(term.sign, left, term.right)
            right = term.right
            if isinstance(right, Vec):
                moved = vector(right)
                if moved is not None:
                    yield DotTerm(term.sign, term.left, moved)
            elif isinstance(right, MatVec):
                for product in self._products(right):
                    yield DotTerm(term.sign, term.left, product)

    # ------------------------------------------------------------------ expressions

    def of(self, value: Value) -> Value | None:
        """Return the tangent of an expression, None for 0. One that occurs twice is treated once."""
        known = self._known.get(id(value))
        if known is None:
            known = self._known[id(value)] = (value, self._of(value))
        return known[1]

    def _of(self, value: Value) -> Value | None:
        if isinstance(value, Const):
            return None
        if isinstance(value, Op):
            return self._operation(value)
        if isinstance(value, Load):
            slot = self._tangents.slot(value.slot)
            return None if slot is None else Load(slot)
        if isinstance(value, Vec):
            return self._tangents.vector(value)
        if isinstance(value, ShiftedVec):
            slot = self._tangents.slot(value.slot)
            return None if slot is None else ShiftedVec(slot, value.count, value.by)
        if isinstance(value, MatVec):
            total: Value | None = None
            for product in self._products(value):
                total = plus(total, product)
            return total
        if isinstance(value, PatternRow):
            slot = self._tangents.slot(value.slot)
            return None if slot is None else PatternRow(slot, value.rows, value.cols)
        if isinstance(value, Outer):
            return self._outer(value)
        return self._table(value)

    def _operation(self, value: Op) -> Value | None:
        if value.name == "delayed" and self._delayed is not None:
            return self._delayed(self, value)
        rule = DERIVATIVE_RULES.get(value.name)
        if rule is None:
            raise NotDifferentiable(value)
        tangents = [self.of(argument) for argument in value.args]
        if not any(tangents):
            return None
        return rule(value.args, tangents)

    def _products(self, value: MatVec) -> Iterable[MatVec]:
        matrix, x = self._tangents.slot(value.slot), self._tangents.slot(value.x_slot)
        if matrix is not None:
            yield MatVec(matrix, value.rows, value.cols, value.transposed, value.x_slot)
        if x is not None:
            yield MatVec(value.slot, value.rows, value.cols, value.transposed, x)

    def _outer(self, value: Outer) -> Value | None:
        u, v = self._tangents.slot(value.u_slot), self._tangents.slot(value.v_slot)
        if u is None and v is None:
            return None
        if value.op != "mul":
            raise NotDifferentiable(value)
        left = None if u is None else Outer("mul", u, value.u_count, value.v_slot, value.v_count)
        right = None if v is None else Outer("mul", value.u_slot, value.u_count, v, value.v_count)
        return plus(left, right)

    def _table(self, value: Table1 | Table2) -> Value | None:
        self._tangents.refuse_table(value)
        if isinstance(value, Table1):
            return _table_derivative(value.x, self.of(value.x), lambda x: Table1(x, value.slot, value.count))

        def f(x: Value, y: Value) -> Value:
            return Table2(x, y, value.f_slot, value.rows, value.cols, value.x_slot, value.y_slot)

        by_x = _table_derivative(value.x, self.of(value.x), lambda x: f(x, value.y))
        return plus(by_x, _table_derivative(value.y, self.of(value.y), lambda y: f(value.x, y)))


def _table_derivative(x: Value, tangent: Value | None, f: Callable[[Value], Value]) -> Value | None:
    """Central difference of a table, times the argument's tangent."""
    if tangent is None:
        return None
    h = op("mul", _NUDGE, op("add", op("abs", x), Const(1.0)))
    up, down = op("add", x, h), op("sub", x, h)
    return op("mul", op("div", op("sub", f(up), f(down)), op("sub", up, down)), tangent)
