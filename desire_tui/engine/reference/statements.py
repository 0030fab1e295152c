"""Statements as Python closures; a pass is a list of them, called in order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    GetHistory,
    Guard,
    LearningStep,
    Set,
    SetDot,
    SetMat,
    SetVec,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.engine.reference.array_statements import dot, matrix, vector
from desire_tui.engine.reference.expressions import ExpressionClosures
from desire_tui.engine.reference.histories import history, sampled
from desire_tui.engine.reference.learning import learn
from desire_tui.engine.reference.random import Sequence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.runtime.run_memory import RunMemory
    from desire_tui.engine.values import Values

    Array = NDArray[np.float64]
    Thunk = Callable[[], Any]
    Run = Callable[[], None]


class StatementClosures:
    """Compiles statements.

    `memory` is the run's, `derivatives` the array that passes write to, `fired` the first `term` that fired
    in this pass (None: none).
    """

    def __init__(self, values: Values, order: int) -> None:
        self.values = values
        self.cells, self.data = values.cells, values.data
        self.derivatives: Array = np.zeros(order)
        self.sequence = Sequence(values.random)
        self.memory: RunMemory | None = None
        self.fired: int | None = None

    def compile(self, actions: Iterable[Action]) -> Run:
        """Return a pass as one function."""
        from desire_tui.engine.reference.python_source import PassText

        return PassText(self).function(actions)

    def value(self, value: Value, count: int | None = None) -> Thunk:
        """Return the closure of an expression over a number or `count` elements."""
        expressions = ExpressionClosures(self.values, self.sequence, count)
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
                return vector(self, action)
            case SetMat():
                return matrix(self, action)
            case SetDot():
                return dot(self, action)
            case StoreHistory() | GetHistory() | DelayLine() | UpdateTrackHold():
                return history(self, action)
            case Terminate():
                return self._term(action.number, self.value(action.value))
            case LearningStep():
                rate = self.value(action.rate)
                criterion = None if action.criterion is None else self.value(action.criterion)
                return lambda: learn(action, self.data, rate(), None if criterion is None else criterion())
            case Guard():
                return self._guard(action)
            case _:
                assert_never(action)

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

    def _term(self, number: int, value: Thunk) -> Run:
        def run() -> None:
            if value() > 0.0 and self.fired is None:
                self.fired = number

        return run

    def _guard(self, guard: Guard) -> Run:
        body = self.compile(guard.body)
        if guard.kind == "sample":
            return sampled(self, guard.every, body)
        raise TypeError(guard.kind)  # `if` is written by PassText; `out` and `step` are resolved in slices
