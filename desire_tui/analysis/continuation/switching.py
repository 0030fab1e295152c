"""At a branch point: the tangent of the other curve, by the algebraic bifurcation equation.

H. B. Keller (1977); also E. J. Doedel, Lecture notes on numerical analysis of nonlinear equations (2007).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import central

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.equilibrium_curve import EquilibriumCurve

    Floats = NDArray[np.float64]

_STEP = 1e-3
_CURVED = 1e-7
_OTHER = 0.9999
_ITERATIONS = 20
_EXACT = 1e-9
_NEAR = 0.05


def exact_branch_point(curve: EquilibriumCurve, u: Floats) -> Floats | None:
    """Return the branch point next to u. None: there is none.

    Newton's method on g + β ψ = 0, ψ (∂g/∂z, ∂g/∂p) = 0, |ψ| = 1, which is regular there (G. Moore, The
    numerical treatment of non-trivial bifurcation points, 1980).
    """
    m = len(u) - 1
    psi = np.linalg.svd(curve.matrix(u))[0][:, -1]
    place, beta = u.copy(), 0.0
    for _ in range(_ITERATIONS):
        matrix = curve.matrix(place)
        if not np.all(np.isfinite(matrix)):
            return None
        right = -np.concatenate([curve.residual(place) + beta * psi, psi @ matrix, [0.5 * (psi @ psi - 1.0)]])
        system = np.zeros((2 * m + 2, 2 * m + 2))
        system[:m, : m + 1], system[:m, m + 1], system[:m, m + 2 :] = matrix, psi, beta * np.eye(m)
        for k, axis in enumerate(np.eye(m + 1)):
            system[m : 2 * m + 1, k] = psi @ _along(curve, place, axis)
        system[m : 2 * m + 1, m + 2 :], system[-1, m + 2 :] = matrix.T, psi
        try:
            step = np.linalg.solve(system, right)
        except np.linalg.LinAlgError:
            return None
        place, beta, psi = place + step[: m + 1], beta + step[m + 1], psi + step[m + 2 :]
        if np.abs(step).max() < _EXACT:
            is_near = np.abs(place - u).max() < _NEAR and abs(beta) < _EXACT
            return place if is_near else None
    return None


def _along(curve: EquilibriumCurve, u: Floats, direction: Floats) -> Floats:
    """Return the derivative of the curve's matrix along a direction."""
    return central(lambda h: curve.matrix(u + h * direction), _STEP)


def other_tangent(curve: EquilibriumCurve, u: Floats, tangent: Floats) -> Floats | None:
    """Return the unit tangent of the curve that crosses another one at u. None: none crosses."""
    left, _, right = np.linalg.svd(curve.matrix(u))
    psi, first, second = left[:, -1], right[-1], right[-2]
    by_first, by_second = _along(curve, u, first), _along(curve, u, second)
    a = float(psi @ by_first @ first)
    b = float(psi @ by_first @ second)
    c = float(psi @ by_second @ second)
    size = max(abs(a), abs(b), abs(c))
    candidates = []
    if size > _CURVED:
        # a x^2 + 2 b x y + c y^2 = 0 for the tangent x first + y second
        root = b * b - a * c
        if root <= 0.0:
            return None
        reach = np.sqrt(root)
        q = -(b + np.copysign(reach, b))
        candidates = [q * first + a * second, c * first + q * second]
    directions = [d / np.linalg.norm(d) for d in candidates if np.linalg.norm(d) > 0.0]
    others = [d for d in directions if abs(float(d @ tangent)) < _OTHER]
    if not others:
        return None
    return np.asarray(min(others, key=lambda d: abs(float(d @ tangent))))
