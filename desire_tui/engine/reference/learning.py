"""Learning rules CLEARN, PLEARN and INTP (docs/neural.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.statements import LearningStep

    Array = NDArray[np.float64]

_PUSHED_AWAY = 0.05


def learn(action: LearningStep, data: Array, rate: float, criterion: float | None) -> None:
    """Carry out one learning step. W is rows × cols, the output has `rows` elements, x `cols`."""
    rows, cols = action.out_count, action.in_count
    out = data[action.out_slot : action.out_slot + rows]
    weights = data[action.weights_slot : action.weights_slot + rows * cols].reshape(rows, cols)
    x = data[action.in_slot : action.in_slot + cols]
    match action.kind:
        case "PLEARN":
            _learn_components(out, weights, x, rate)
        case "INTP":
            out[:] = np.where(_distances(weights, x) <= rate, 1.0, 0.0)
        case "CLEARN":
            h = None if action.h_slot is None else data[action.h_slot : action.h_slot + rows]
            winner: int | None = None
            needs_h = criterion is not None and criterion >= 0.0 and h is None
            if not needs_h:
                winner = _winner(weights, x, h, 0.0 if criterion is None else criterion, rate)
            out[:] = 0.0
            if winner is not None:
                out[winner] = 1.0
                gap = x - weights[winner]
                weights[winner] = x if action.fast else weights[winner] + abs(rate) * gap
            if action.full_slot is not None:
                data[action.full_slot] = 2.0 if needs_h else 1.0 if winner is None else 0.0
        case _:
            assert_never(action.kind)


def _winner(weights: Array, x: Array, h: Array | None, criterion: float, rate: float) -> int | None:
    """Return the row that wins (None: no row is left); commit it, and push the second best away."""
    distances = _distances(weights, x)
    if criterion == 0.0 and h is not None:
        distances *= h
    order = _from_the_nearest(distances)
    if criterion == 0.0 and rate < 0.0 and len(order) > 1:
        second = order[1]
        weights[second] += _PUSHED_AWAY * rate * (x - weights[second])
    if not criterion > 0.0 or h is None:
        return order[0]
    while order:
        winner = order[0]
        if distances[winner] <= criterion:
            h[winner] = 1.0
            return winner
        if h[winner] == 0.0:
            return winner
        order = _from_the_nearest(distances, order)
    return None


def _from_the_nearest(distances: Array, before: list[int] | None = None) -> list[int]:
    """Return the rows that compete, the nearest first, of several the last; without the winner `before`.

    A distance that is no number is less than none: it wins only where it stands last.
    """
    rows = range(len(distances)) if before is None else sorted(before[1:])
    left = sorted(rows, reverse=True)
    found: list[int] = []
    for _ in range(2):
        best = -1
        for row in left:
            if best < 0 or distances[row] < distances[best]:
                best = row
        if best >= 0:
            found.append(best)
            left.remove(best)
    return found + left


def _distances(weights: Array, x: Array) -> Array:
    """Return the squared distance of x from each row, summed up in order: ties are ties on both back ends."""
    return np.cumsum((weights - x) ** 2, axis=1)[:, -1].copy()


def _learn_components(out: Array, weights: Array, x: Array, rate: float) -> None:
    """Principal components one by one; each row sees those before it already changed (Sanger 1989)."""
    out[:] = weights.dot(x)
    rest = np.zeros_like(x)
    for i, y in enumerate(out):
        weights[i] += rate * y * (x - (rest + weights[i] * y))
        rest += weights[i] * y
