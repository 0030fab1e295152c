"""Statements as Python closures; a pass is a list of them, called in order."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.lowered import (
    DelayLine,
    Deriv,
    DerivVec,
    Get,
    Guard,
    Learn,
    Set,
    SetDot,
    SetMat,
    SetVec,
    Store,
    Terminate,
    TrackHold,
)  # fmt: skip
from desire_tui.engine.reference.draws import Sequence
from desire_tui.engine.reference.expressions import Expressions
from desire_tui.engine.reference.learning import learn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered import Action, Value
    from desire_tui.engine.runtime.memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]
    Thunk = Callable[[], Any]
    Run = Callable[[], None]


class Statements:
    """Compiles statements. `memory` is the run's, `derivatives` the array that passes write to, `fired` the
    first
    `term` that fired in this pass (None: none).
    """  # noqa: D205

    def __init__(self, values: Values, order: int) -> None:
        self.values = values
        self.cells, self.data = values.cells, values.data
        self.derivatives: Array = np.zeros(order)
        self.sequence = Sequence(values.random)
        self.memory: RunMemory | None = None
        self.fired: int | None = None

    def compile(self, actions: Iterable[Action]) -> Run:
        """Return a pass as one function."""
        from desire_tui.engine.reference.source import PassText

        return PassText(self).function(actions)

    def value(self, value: Value, count: int | None = None) -> Thunk:
        """Return the closure of an expression over a number or `count` elements."""
        expressions = Expressions(self.values, self.sequence, count)
        thunk = expressions.compile(value)
        if expressions.is_plain:
            return thunk

        def prepared() -> Any:
            expressions.begin()
            return thunk()

        return prepared

    def statement(self, action: Action) -> Run:
        """Return the closure of one statement."""
        match action:
            case Set():
                return self._set(action.slot, self.value(action.value))
            case Deriv():
                return self._derivative(action.state, self.value(action.value))
            case DerivVec():
                first, last = action.state, action.state + action.count
                return self._derivatives(slice(first, last), self.value(action.value, action.count))
            case SetVec():
                return self._vector(action)
            case SetMat():
                return self._matrix(action)
            case SetDot():
                return self._dot(action)
            case Store() | Get() | DelayLine() | TrackHold():
                return self._history(action)
            case Terminate():
                return self._term(action.number, self.value(action.value))
            case Learn():
                rate = self.value(action.rate)
                criterion = None if action.criterion is None else self.value(action.criterion)
                return lambda: learn(action, self.data, rate(), None if criterion is None else criterion())
            case Guard():
                return self._guard(action)

    def _set(self, slot: int, value: Thunk) -> Run:
        cells = self.cells

        def run() -> None:
            cells[slot] = value()

        return run

    def _derivative(self, state: int, value: Thunk) -> Run:
        derivatives = self.derivatives

        def run() -> None:
            derivatives[state] = value()

        return run

    def _derivatives(self, states: slice, value: Thunk) -> Run:
        derivatives = self.derivatives

        def run() -> None:
            derivatives[states] = value()

        return run

    def _vector(self, action: SetVec) -> Run:
        target = self.data[action.slot : action.slot + action.count]
        mask = None
        if action.mask_slot is not None:
            mask = self.data[action.mask_slot : action.mask_slot + action.count]
        value = self.value(action.value, action.count)
        mode = action.mode

        def run() -> None:
            new = value()
            if mask is not None:
                new = np.where(mask != 0.0, 0.0, new)
            if mode == "add":
                new = target + new
            elif mode == "largest":
                new = np.broadcast_to(new, target.shape)
                winner = len(target) - 1 - int(np.argmax(new[::-1]))
                kept = new[winner]
                new = np.zeros(len(target))
                new[winner] = kept
            target[:] = new

        return run

    def _matrix(self, action: SetMat) -> Run:
        count = action.rows * action.cols
        target = self.data[action.slot : action.slot + count]
        mask = None if action.mask_slot is None else self.data[action.mask_slot : action.mask_slot + count]
        expressions = Expressions(self.values, self.sequence, count)
        value = expressions.compile(action.value)
        lower = None if action.lower is None else expressions.compile(action.lower)
        upper = None if action.upper is None else expressions.compile(action.upper)
        adds = action.mode == "add"

        def run() -> None:
            expressions.begin()
            new = target + value() if adds else np.broadcast_to(value(), target.shape)
            if lower is not None:
                least = lower()
                new = np.where(new < least, least, new)
            if upper is not None:
                most = upper()
                new = np.where(new > most, most, new)
            target[:] = new if mask is None else np.where(mask != 0.0, new, target)

        return run

    def _dot(self, action: SetDot) -> Run:
        terms = []
        for term in action.terms:
            left = self.value(term.left)
            right = None if term.right is None else self.value(term.right)
            terms.append((term.sign, left, right))
        length = float(action.terms[0].left.count) if action.average and action.terms else 1.0
        cells, slot = self.cells, action.slot

        def run() -> None:
            total = 0.0
            for sign, left, right in terms:
                total += sign * float(left().sum() if right is None else left().dot(right()))
            cells[slot] = total / length

        return run

    def _term(self, number: int, value: Thunk) -> Run:
        def run() -> None:
            if value() > 0.0 and self.fired is None:
                self.fired = number

        return run

    def _guard(self, guard: Guard) -> Run:
        body = self.compile(guard.body)
        if guard.kind == "sample":
            every = guard.every

            def sampled() -> None:
                memory = self.memory
                assert memory is not None
                if (memory.points_before + memory.point + 1) % every == 0 and self._is_fresh(memory):
                    body()

            return sampled
        raise TypeError(guard.kind)  # `if` is written by PassText; `out` and `step` are resolved in slices

    @staticmethod
    def _is_fresh(memory: RunMemory) -> bool:
        """Whether this is not the joint of a continued run, which had its turn in the run before.

        `get` and delays read at a joint what they read there before: after a `reset` the script has gone
        back, and the first interval must not go on with the last value of the run taken back.
        """
        return not (memory.joined and memory.point == 0)

    def _history(self, action: Store | Get | DelayLine | TrackHold) -> Run:
        cells = self.cells
        if isinstance(action, TrackHold):
            control, value = self.value(action.control), self.value(action.value)
            held, tracked = action.held_slot, action.tracked_slot

            def track() -> None:
                p, x = control(), value()
                if p > 0.0:
                    cells[held] = cells[tracked]
                    cells[tracked] = x

            return track
        if isinstance(action, DelayLine):
            return self._delay(action)
        array = action.array_slot
        count, counter, slot = action.count, action.counter, action.slot
        stores = isinstance(action, Store)

        def move() -> None:
            memory = self.memory
            assert memory is not None
            positions = _integers(memory.counters, counter + 1)
            fresh = self._is_fresh(memory)
            at = positions[counter] - (not fresh)
            if not 0 <= at < count:
                return
            if not stores:
                cells[slot] = cells[array + at]
            elif fresh:
                cells[array + at] = cells[slot]
            positions[counter] = at + 1

        return move

    def _delay(self, action: DelayLine) -> Run:
        source = self.value(action.source)
        cells, buffer, count = self.cells, action.buffer_slot, action.count
        slot, counter = action.slot, action.counter

        def delay() -> None:
            memory = self.memory
            assert memory is not None
            x = source()
            positions, lags = _integers(memory.counters, counter + 1), _integers(memory.lags, counter + 1)
            fresh, lag = self._is_fresh(memory), lags[counter]
            at = positions[counter] - (not fresh)
            if not fresh and (at < 0 or lag == count):
                return  # the joint's own record stands where the one looked for was
            cells[slot] = x if lag == 0 else cells[buffer + (at - lag) % count]
            if fresh:
                cells[buffer + at % count] = x
            positions[counter] = at + 1

        return delay


def _integers(address: int, count: int) -> Any:
    return (ctypes.c_int64 * count).from_address(address)
