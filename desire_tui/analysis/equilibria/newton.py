"""Newton's method with damping, for places where a system stands still.

P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3: a step counts as progress if the next
simplified Newton correction is shorter, which no scaling of the equations changes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

Outcome = Literal["found", "infinity", "singular", "stuck"]
"""`infinity`: the iterates leave all bounds; `singular`: they end where the Jacobian says nothing."""

_MOST = 80
_EXACT = 1e-11
_NEAR = 1e-6
"""Where the Jacobian is singular, Newton's method comes no nearer than this."""
_FAR = 1e7
_HUGE = 1e12
_LEAST_DAMPING = 1e-6
_NOTHING = 1e-9
"""Rates so small against those elsewhere are rounding."""
_FADED = 1e-6
"""Rates that have become so small while the steps have not lead to rest at infinity only."""


@dataclass(frozen=True)
class Solution:
    """Where it ended: in coordinates of the system, with the number of iterations."""

    z: Floats
    outcome: Outcome
    iterations: int


def newton(system: System, start: Floats, p: Mapping[str, float]) -> Solution:
    """Find a steady state from a start; both in the system's coordinates."""
    z = start.copy()
    g = first = system.rate(z, p)
    damping = 1.0
    step = np.full(len(z), np.inf)
    for iteration in range(_MOST):
        if not np.all(np.isfinite(g)):
            return Solution(z, "stuck", iteration)
        matrix = system.jacobian(z, p)
        if not np.all(np.isfinite(matrix)):
            return Solution(z, "stuck", iteration)
        step = _solved(matrix, -g)
        length = float(np.linalg.norm(step))
        if length <= _EXACT * (1.0 + float(np.linalg.norm(z))):
            return Solution(z + step, _at_rest(system, matrix, g, step), iteration)
        damping = min(1.0, 4.0 * damping)
        while True:
            tried = z + damping * step
            value = system.rate(tried, p)
            if np.all(np.isfinite(value)):
                after = float(np.linalg.norm(_solved(matrix, -value)))
                if after <= (1.0 - damping / 4.0) * length:
                    break
            damping /= 2.0
            if damping < _LEAST_DAMPING:
                return Solution(z, _why(z, step, first, g), iteration)
        z, g = tried, value
        if float(np.abs(z).max()) > _FAR:
            return Solution(z, "infinity", iteration)
    return Solution(z, _why(z, step, first, g), _MOST)


def _at_rest(system: System, matrix: Floats, g: Floats, step: Floats) -> Outcome:
    """Tell a place at rest from one whose singular Jacobian has no step that would lead to rest."""
    left = float(np.linalg.norm(matrix @ step + g))
    moves = float(np.linalg.norm(g)) > _NOTHING * system.pace
    return "singular" if moves and left > 0.5 * float(np.linalg.norm(g)) else "found"


def _why(z: Floats, step: Floats, first: Floats, g: Floats) -> Outcome:
    if float(np.linalg.norm(step)) <= _NEAR * (1.0 + float(np.linalg.norm(z))):
        return "found"
    if float(np.linalg.norm(g)) < _FADED * float(np.linalg.norm(first)):
        return "infinity"
    return "singular" if float(np.abs(step).max()) > 1e3 * (1.0 + float(np.abs(z).max())) else "stuck"


def _solved(matrix: Floats, right: Floats) -> Floats:
    """Solve; the shortest solution where the matrix is singular."""
    try:
        found = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
        if np.all(np.isfinite(found)) and np.abs(found).max(initial=0.0) < _HUGE:
            return found
    except np.linalg.LinAlgError:
        pass
    return np.asarray(np.linalg.lstsq(matrix, right)[0], dtype=np.float64)
