"""Which statements a pass with given flags must execute (language.md 8.2).

A pass is described by COMM (at a communication point) and STEP (at a step's start). What nobody can see is
left out: a defined variable that no derivative, no persistent variable and no statement of this pass needs.
Persistent assignments and random draws are never left out, so every back end changes the same numbers in
the same passes. `Guard` remains for `if` and `sample` only; `out` and `step` are resolved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.analysis.intervals import Intervals
from desire_tui.engine.lowered import (
    Const,
    DelayLine,
    Deriv,
    DerivVec,
    Get,
    Guard,
    Learn,
    Load,
    MatVec,
    Op,
    Outer,
    RowOf,
    Set,
    SetDot,
    SetMat,
    SetVec,
    Shifted,
    Store,
    Table1,
    Table2,
    Terminate,
    TrackHold,
    Vec,
)  # fmt: skip
from desire_tui.engine.values import IROW, SCALAR_SLOTS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered import Action, Segment, Value

_RANDOM = frozenset({"ran", "gauss"})
Actions = tuple["Action", ...]


def full_pass(segment: Segment) -> Actions:
    """COMM and STEP: everything, in order."""
    return _resolve(segment.body, comm=True, step=True)


def step_slice(segment: Segment) -> Actions:
    """STEP without COMM: the start of a step inside a communication interval."""
    return needed(_resolve(segment.body, comm=False, step=True))


def derivative_slice(segment: Segment) -> Actions:
    """Neither flag: the later stages of a step."""
    return needed(_resolve(segment.body, comm=False, step=False))


def tail_pass(segment: Segment) -> Actions:
    """COMM without STEP, after `term` fired between communication points.

    The STEP pass has just been made with the same t and states. So only what it left out is caught up: pure
    defined variables are computed, OUT code runs; unguarded persistent assignments, random draws,
    derivatives, `sample` and `step` code are not repeated.
    """
    return _tail(segment.body)


def jacobian_pass(segment: Segment, stride: int) -> Actions:
    """Return the JACOBIAN segment and what it uses; J[i, k] goes to `slot` + i·stride + k."""
    given = segment.jacobian
    assert given is not None
    pure = _pure(_resolve(segment.body, comm=False, step=False))
    where = segment.states[0].where
    wanted = tuple(Deriv(number, entry.value, where) for number, entry in enumerate(given.entries))
    helpers = needed(pure + given.body + wanted)[: -len(wanted) or None]
    return helpers + tuple(
        Set(given.slot + entry.row * stride + entry.column, entry.value, where) for entry in given.entries
    )


def acts_at_steps(segment: Segment) -> bool:
    """Whether a pass at a step's start inside an interval does anything but compute derivatives."""
    return not is_pure(_resolve(segment.body, comm=False, step=True))


def is_pure(actions: Actions) -> bool:
    """Whether statements only compute: nothing is remembered, drawn or ended."""
    return all(
        is_pure(a.body) and is_pure(a.orelse)
        if isinstance(a, Guard)
        else isinstance(a, Deriv | DerivVec)
        or (isinstance(a, Set | SetVec | SetMat | SetDot) and not a.persistent and not draws(a))
        for a in actions
    )


def _pure(actions: Actions) -> Actions:
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            kept.append(_with_bodies(action, _pure(action.body), _pure(action.orelse)))
        elif not isinstance(action, Deriv | DerivVec) and is_pure((action,)):
            kept.append(action)
    return tuple(kept)


def _resolve(actions: Iterable[Action], *, comm: bool, step: bool) -> Actions:
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "out":
                if comm:
                    kept.extend(_resolve(action.body, comm=comm, step=step))
            elif action.kind == "step":
                if step:
                    kept.extend(_resolve(action.body, comm=comm, step=step))
            elif action.kind == "if" or comm:
                body = _resolve(action.body, comm=comm, step=step)
                orelse = _resolve(action.orelse, comm=comm, step=step)
                if body or orelse:
                    kept.append(_with_bodies(action, body, orelse))
        elif isinstance(action, Terminate):
            if step:
                kept.append(action)
        elif isinstance(action, DelayLine):
            if step if action.per_step else comm:
                kept.append(action)
        elif not isinstance(action, Store | Get) or comm:
            kept.append(action)
    return tuple(kept)


def _tail(actions: Iterable[Action]) -> Actions:
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "out":
                kept.extend(_without_derivatives(_resolve(action.body, comm=True, step=False)))
            elif action.kind == "if":
                body, orelse = _tail(action.body), _tail(action.orelse)
                if body or orelse:
                    kept.append(_with_bodies(action, body, orelse))
        elif isinstance(action, Store | Get):
            kept.append(action)
        elif isinstance(action, DelayLine):
            if not action.per_step:
                kept.append(action)
        elif (
            isinstance(action, Set | SetVec | SetMat | SetDot) and not action.persistent and not draws(action)
        ):
            kept.append(action)
    return tuple(kept)


def _without_derivatives(actions: Iterable[Action]) -> Actions:
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "if":
                body, orelse = _without_derivatives(action.body), _without_derivatives(action.orelse)
                kept.append(_with_bodies(action, body, orelse))
        elif not isinstance(action, Deriv | DerivVec):
            kept.append(action)
    return tuple(kept)


def _with_bodies(guard: Guard, body: Actions, orelse: Actions) -> Guard:
    return Guard(guard.kind, body, guard.where, guard.condition, orelse, guard.every)


# --------------------------------------------------------------------------------------------- what is needed


class _Reads:
    """Numbers that kept statements read: scalars by slot, arrays and their elements as intervals."""

    def __init__(self) -> None:
        self.slots: set[int] = set()
        self.ranges = Intervals()
        self._shared: dict[int, Op] = {}

    def add_slot(self, slot: int) -> None:
        if slot < SCALAR_SLOTS:
            self.slots.add(slot)
        else:
            self.ranges.add(slot, 1)

    def add_range(self, slot: int, count: int) -> None:
        self.ranges.add(slot, count)

    def has(self, slot: int) -> bool:
        return slot in self.slots or self.ranges.touches(slot, 1)

    def touches(self, slot: int, count: int) -> bool:
        if self.ranges.touches(slot, count):
            return True
        return slot < SCALAR_SLOTS and any(slot <= s < slot + count for s in self.slots)

    def value(self, value: Value | None) -> None:
        """Add what an expression reads."""
        if value is None or isinstance(value, Const):
            return
        if isinstance(value, Load):
            self.add_slot(value.slot)
        elif isinstance(value, Op):
            # an argument of a FUNCTION is one object in many places: looked at once
            if id(value) not in self._shared:
                self._shared[id(value)] = value
                for argument in value.args:
                    self.value(argument)
        elif isinstance(value, Vec | Shifted):
            self.add_range(value.slot, value.count)
        elif isinstance(value, MatVec):
            self.add_range(value.slot, value.rows * value.cols)
            self.add_range(value.x_slot, value.rows if value.transposed else value.cols)
        elif isinstance(value, RowOf):
            self.add_range(value.slot, value.rows * value.cols)
            self.slots.add(IROW)
        elif isinstance(value, Outer):
            self.add_range(value.u_slot, value.u_count)
            self.add_range(value.v_slot, value.v_count)
        elif isinstance(value, Table1):
            self.value(value.x)
            self.add_range(value.slot, 2 * value.count)
        elif isinstance(value, Table2):
            self.value(value.x)
            self.value(value.y)
            self.add_range(value.f_slot, value.rows * value.cols)
            self.add_range(value.x_slot, value.rows)
            self.add_range(value.y_slot, value.cols)

    def action(self, action: Action) -> None:
        """Add what a kept statement reads (a guard: its condition)."""
        if isinstance(action, Set | Deriv | DerivVec | Terminate):
            self.value(action.value)
        elif isinstance(action, SetVec | SetMat):
            self.value(action.value)
            count = action.count if isinstance(action, SetVec) else action.rows * action.cols
            if action.mode == "add" or action.mask_slot is not None:
                self.add_range(action.slot, count)
            if action.mask_slot is not None:
                self.add_range(action.mask_slot, count)
            if isinstance(action, SetMat):
                self.value(action.lower)
                self.value(action.upper)
        elif isinstance(action, SetDot):
            for term in action.terms:
                self.value(term.left)
                self.value(term.right)
        elif isinstance(action, Store):
            self.add_slot(action.slot)
        elif isinstance(action, Get):
            self.add_range(action.array_slot, action.count)
        elif isinstance(action, DelayLine):
            self.value(action.source)
            self.add_range(action.buffer_slot, action.count)
        elif isinstance(action, TrackHold):
            self.value(action.control)
            self.value(action.value)
            self.add_slot(action.held_slot)
            self.add_slot(action.tracked_slot)
        elif isinstance(action, Learn):
            self.value(action.rate)
            self.value(action.criterion)
            self.add_range(action.weights_slot, action.out_count * action.in_count)
            self.add_range(action.in_slot, action.in_count)
            self.add_range(action.out_slot, action.out_count)
        else:
            self.value(action.condition)


def needed(actions: Actions) -> Actions:
    """Leave out what no derivative, no persistent variable and no other kept statement uses."""
    return _backward(actions, _Reads())


def _backward(actions: Actions, reads: _Reads) -> Actions:
    kept: list[Action] = []
    for action in reversed(actions):
        if isinstance(action, Guard):
            orelse = _backward(action.orelse, reads)
            body = _backward(action.body, reads)
            if not (body or orelse):
                continue
            kept.append(_with_bodies(action, body, orelse))
        elif _is_needed(action, reads):
            kept.append(action)
        else:
            continue
        reads.action(kept[-1])
    return tuple(reversed(kept))


def _is_needed(action: Action, reads: _Reads) -> bool:
    if not isinstance(action, Set | SetVec | SetMat | SetDot):
        return True
    if action.persistent or draws(action):
        return True
    if isinstance(action, Set | SetDot):
        return reads.has(action.slot)
    count = action.count if isinstance(action, SetVec) else action.rows * action.cols
    return reads.touches(action.slot, count)


def draws(action: Action) -> bool:
    """Whether a statement draws random numbers."""
    if isinstance(action, Set | SetVec | Deriv | DerivVec | Terminate):
        return _draws(action.value)
    if isinstance(action, SetMat):
        return _draws(action.value) or _draws(action.lower) or _draws(action.upper)
    return False


def _draws(value: Value | None) -> bool:
    """Whether an expression holds `ran` or `gauss`; shared parts are looked at once."""
    seen: set[int] = set()
    rest: list[Value | None] = [value]
    while rest:
        part = rest.pop()
        if isinstance(part, Op):
            if part.name in _RANDOM:
                return True
            if id(part) not in seen:
                seen.add(id(part))
                rest.extend(part.args)
        elif isinstance(part, Table1):
            rest.append(part.x)
        elif isinstance(part, Table2):
            rest.extend((part.x, part.y))
    return False
