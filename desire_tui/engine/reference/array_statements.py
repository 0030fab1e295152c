"""Assignments to whole arrays, and sums over them, as Python closures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from desire_tui.engine.lowered.effects import reads_replaced
from desire_tui.engine.lowered.statements import SetVec
from desire_tui.engine.reference.expressions import ExpressionClosures

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.statements import SetDot, SetMat
    from desire_tui.engine.reference.evaluation_context import EvaluationContext

    Array = NDArray[np.float64]
    Run = Callable[[], None]


def vector(context: EvaluationContext, action: SetVec) -> Run:
    """Return the closure of `Vector` or `Vectr delta`."""
    if reads_replaced(action):
        return _in_place(context, action, action.count)
    target = context.data[action.slot : action.slot + action.count]
    mask = None
    if action.mask_slot is not None:
        mask = context.data[action.mask_slot : action.mask_slot + action.count]
    value = context.value(action.value, action.count)
    mode = action.mode

    def run() -> None:
        new = value()
        if mask is not None:
            new = np.where(mask != 0.0, 0.0, new)
        match mode:
            case "set":
                target[:] = new
            case "add":
                target[:] = target + new
            case "largest":
                _keep_largest(target, np.broadcast_to(new, target.shape))
            case _:
                assert_never(mode)

    return run


def matrix(context: EvaluationContext, action: SetMat) -> Run:
    """Return the closure of `MATRIX` or `DELTA`."""
    count = action.rows * action.cols
    if reads_replaced(action):
        return _in_place(context, action, count)
    target = context.data[action.slot : action.slot + count]
    mask = None if action.mask_slot is None else context.data[action.mask_slot : action.mask_slot + count]
    expressions = ExpressionClosures(context.values, context.sequence, count)
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


def _keep_largest(target: Array, new: Array) -> None:
    winner = len(target) - 1 - int(np.argmax(new[::-1]))
    largest = new[winner]
    target[:] = 0.0
    target[winner] = largest


def _in_place(context: EvaluationContext, action: SetVec | SetMat, count: int) -> Run:
    """Return the closure of a statement that reads elements it has assigned: one by one, the last first."""
    target = context.data[action.slot : action.slot + count]
    mask = None if action.mask_slot is None else context.data[action.mask_slot : action.mask_slot + count]
    expressions = ExpressionClosures(context.values, context.sequence, count)
    value = expressions.compile(action.value)
    bounds = (None, None) if isinstance(action, SetVec) else (action.lower, action.upper)
    lower, upper = (None if bound is None else expressions.compile(bound) for bound in bounds)

    def element(i: int, of: Callable[[], Any]) -> float:
        return float(np.broadcast_to(of(), target.shape)[i])

    def run() -> None:
        expressions.begin()
        for i in reversed(range(count)):
            expressions.forget()
            new = element(i, value)
            masked = mask is not None and mask[i] != 0.0
            if isinstance(action, SetVec) and masked:
                new = 0.0
            if action.mode == "add":
                new += target[i]
            if lower is not None:
                least = element(i, lower)
                new = max(new, least)
            if upper is not None:
                most = element(i, upper)
                new = min(new, most)
            if mask is None or masked or isinstance(action, SetVec):
                target[i] = new
        if action.mode == "largest":
            _keep_largest(target, target.copy())

    return run


def dot(context: EvaluationContext, action: SetDot) -> Run:
    """Return the closure of `DOT` or `AVG`."""
    terms = []
    for term in action.terms:
        left = context.value(term.left)
        right = None if term.right is None else context.value(term.right)
        terms.append((term.sign, left, right))
    length = float(action.terms[0].left.count) if action.average and action.terms else 1.0
    cells, slot = context.cells, action.slot

    def run() -> None:
        total = 0.0
        for sign, left, right in terms:
            total += sign * float(left().sum() if right is None else left().dot(right()))
        cells[slot] = total / length

    return run
