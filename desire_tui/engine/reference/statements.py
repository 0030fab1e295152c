"""Statements as Python closures; a pass is a list of them, called in order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

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
from desire_tui.engine.reference.evaluation_context import EvaluationContext
from desire_tui.engine.reference.histories import history, sampled
from desire_tui.engine.reference.learning import learn
from desire_tui.engine.reference.python_source import PassText

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.values import Values

    Thunk = Callable[[], Any]
    Run = Callable[[], None]


class StatementClosures(EvaluationContext):
    """Compiles statements."""

    def __init__(self, values: Values, order: int) -> None:
        super().__init__(values, order)
        self._written: dict[tuple[int, ...], tuple[tuple[Action, ...], PassText]] = {}
        """By the statements' identities, which stay taken as long as they are here: passes share them."""

    def compile(self, actions: Iterable[Action]) -> Run:
        """Return a pass as one function that writes derivatives to the present `derivatives`."""
        statements = tuple(actions)
        key = tuple(map(id, statements))
        if key not in self._written:
            text = PassText(self, self.statement)
            text.write(statements)
            self._written[key] = statements, text
        return self._written[key][1].function()

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
                return self._term(action, self.value(action.value))
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

    def _term(self, action: Terminate, value: Thunk) -> Run:
        cells, number, level = self.cells, action.number, action.level

        def run() -> None:
            now = value()
            before = 0.0 if level is None else cells[level]
            if now > before and self.fired is None:
                self.fired = number
            if level is not None:
                cells[level] = now if now > 0.0 <= before else 0.0

        return run

    def _guard(self, guard: Guard) -> Run:
        body = self.compile(guard.body)
        if guard.kind == "sample":
            return sampled(self, guard.every, body)
        raise TypeError(guard.kind)  # `if` is written by PassText; `out` and `step` are resolved in slices
