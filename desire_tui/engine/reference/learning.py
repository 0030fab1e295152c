"""Learning rules CLEARN, PLEARN and INTP (docs/neural.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.statements import LearningStep

    Array = NDArray[np.float64]


def learn(action: LearningStep, data: Array, rate: float, criterion: float | None) -> None:
    """Carry out one learning step. W is rows × cols, v has `rows` elements, x `cols`."""
    rows, cols = action.out_count, action.in_count
    out = data[action.out_slot : action.out_slot + rows]
    weights = data[action.weights_slot : action.weights_slot + rows * cols].reshape(rows, cols)
    x = data[action.in_slot : action.in_slot + cols]
    match action.kind:
        case "PLEARN":
            _sanger(out, weights, x, rate)
        case "INTP":
            out[:] = np.where(weights.dot(x) > rate, 1.0, 0.0)
        case "CLEARN":
            slot = action.count_slot
            wins = None if slot is None else data[slot : slot + rows]
            found = _compete(out, weights, x, rate, 0.0 if criterion is None else criterion, wins)
            if action.full_slot is not None:
                data[action.full_slot] = 0.0 if found else 1.0
        case _:
            assert_never(action.kind)


def _compete(out: Array, weights: Array, x: Array, rate: float, criterion: float, wins: Array | None) -> bool:
    """Winner takes all: the nearest row wins and moves towards x (Kohonen).

    `wins` counts each row's victories: distances are weighted by 1 + wins (frequency-sensitive learning,
    Ahalt et al. 1990). With `criterion` > 0 a winner further away than that gives way to the first free row,
    which becomes x (as in Carpenter and Grossberg's ART); a row of zeros is free. No free row: v is 0
    everywhere, and the result is False.
    """
    distances = ((x - weights) ** 2).sum(axis=1)
    free = ~weights.any(axis=1)
    out[:] = 0.0
    if criterion > 0.0:
        distances[free] = np.inf
    weighted = distances if wins is None else distances * (1.0 + wins)
    winner = int(np.argmin(weighted))
    if criterion > 0.0 and not distances[winner] <= criterion * criterion:
        if not free.any():
            return False
        winner = int(np.argmax(free))
        weights[winner] = x
    else:
        weights[winner] += rate * (x - weights[winner])
    out[winner] = 1.0
    if wins is not None:
        wins[winner] += 1.0
    return True


def _sanger(out: Array, weights: Array, x: Array, rate: float) -> None:
    """Principal components one by one: W[i] += rate·v[i]·(x - Σ over k ≤ i of v[k]·W[k]) (Sanger 1989)."""
    out[:] = weights.dot(x)
    rest = x.copy()
    for i, v in enumerate(out):
        rest -= v * weights[i]
        weights[i] += rate * v * rest
