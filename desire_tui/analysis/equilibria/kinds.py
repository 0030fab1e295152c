"""What a steady state is, by its eigenvalues: node, focus, saddle, centre."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Complex = NDArray[np.complex128]

_SHOWN_MOST = 8
_NOTHING = 1e-7
"""So small against the largest eigenvalue is 0: double eigenvalues are no more exact."""


def eigenvalues(matrix: NDArray[np.float64]) -> Complex:
    """Return the eigenvalues of a real matrix, the one that grows fastest first."""
    found = np.linalg.eigvals(matrix).astype(np.complex128)
    return found[np.lexsort((-found.imag, -found.real))]


def kind(values: Complex, scale: float = 0.0) -> str:
    """Return the name: stable or unstable node or focus, saddle, saddle focus, centre, degenerate.

    Degenerate is one with an eigenvalue 0, where the linear part does not tell what happens. Of more than two
    states, node or focus is decided by the eigenvalues nearest to the imaginary axis: they rule in the end.
    `scale`: how large eigenvalues are nearby.
    """
    if not len(values):
        return "fixed"
    nothing = _NOTHING * max(float(np.abs(values).max()), scale)
    real, turning = values.real, np.abs(values.imag) > nothing
    if np.any(np.abs(values) <= nothing):
        return "degenerate"
    neutral = np.abs(real) <= nothing
    if np.any(neutral):
        others = real[~neutral]
        if not len(others):
            return "centre"
        return "centre, the rest stable" if np.all(others < 0.0) else "centre, the rest unstable"
    if np.all(real < 0.0) or np.all(real > 0.0):
        first = int(np.argmin(np.abs(real)))
        name = "focus" if turning[first] else "node"
        return f"{'stable' if real[0] < 0.0 else 'unstable'} {name}"
    return "saddle focus" if np.any(turning) else "saddle"


def is_stable(values: Complex) -> bool:
    """Whether all small disturbances die out."""
    return bool(np.all(values.real < -_NOTHING * np.abs(values).max(initial=0.0)))


def unstable_count(values: Complex) -> int:
    """Return in how many directions small disturbances grow."""
    return int(np.count_nonzero(values.real > 0.0))


def shown(values: Complex) -> str:
    """Return eigenvalues as text, a conjugate pair as one: `-0.1 ± 2.3i, -5`; the first ones of many."""
    parts: list[str] = []
    nothing = 1e-11 * float(np.abs(values).max(initial=0.0))
    for value in values:
        if len(parts) == _SHOWN_MOST:
            parts.append("…")
            break
        real = value.real if abs(value.real) > nothing else 0.0
        if abs(value.imag) <= nothing:
            parts.append(f"{real:.5g}")
        elif value.imag > 0.0:
            parts.append(f"{real:.5g} ± {value.imag:.5g}i")
    return ", ".join(parts)
