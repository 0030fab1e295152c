"""Sums of states that no motion changes: moieties, energies that are linear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_EXACT = 1e-10
"""So small against the largest singular value is a sum that does not change at all."""
_WHOLE = 1e-7


def conserved(rates: Floats) -> Floats:
    """Return weights w, k by n, with w·dx/dt = 0 for dx/dt at many places, n by m with m > n.

    The rows are reduced, each with a 1 of its own, so that chemistry's moieties have whole weights.
    """
    n = len(rates)
    seen = rates[:, np.all(np.isfinite(rates), axis=0)]
    size = np.linalg.norm(seen, axis=1)
    still = size == 0.0
    scaled = seen / np.where(still, 1.0, size)[:, None]
    if scaled.shape[1] < n:
        return np.empty((0, n))
    left, values, _ = np.linalg.svd(scaled)
    kept = np.concatenate([values, np.zeros(n - len(values))])
    null = left[:, kept <= _EXACT * max(float(values.max(initial=0.0)), 1e-300)].T
    return _reduced(null / np.where(still, 1.0, size))


def _reduced(rows: Floats) -> Floats:
    """Return rows with the same span in reduced echelon form, by Gauss and Jordan."""
    matrix = rows.copy()
    done = 0
    for column in range(matrix.shape[1]):
        if done == len(matrix):
            break
        pivot = done + int(np.argmax(np.abs(matrix[done:, column])))
        if abs(matrix[pivot, column]) < _WHOLE * np.abs(matrix).max():
            continue
        matrix[[done, pivot]] = matrix[[pivot, done]]
        matrix[done] /= matrix[done, column]
        others = np.arange(len(matrix)) != done
        matrix[others] -= np.outer(matrix[others, column], matrix[done])
        done += 1
    near = np.round(matrix)
    return np.where(np.abs(matrix - near) < _WHOLE, near, matrix)


def law(weights: Floats, names: Sequence[str]) -> str:
    """Return a sum of states as it is written: `x + 2*y - z`."""
    parts = []
    for weight, name in zip(weights, names, strict=True):
        if weight:
            sign = " - " if weight < 0 else " + "
            size = abs(float(weight))
            parts.append(f"{sign}{name}" if size == 1.0 else f"{sign}{size:.6g}*{name}")
    text = "".join(parts)
    return f"-{text[3:]}" if text.startswith(" - ") else text[3:]
