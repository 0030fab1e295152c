"""The first Lyapunov coefficient of a Hopf point: whether the cycles born there are stable.

Yu. A. Kuznetsov, Elements of Applied Bifurcation Theory, 3rd edition, formula (5.62); derivatives of second
and third order are differences of the exact Jacobian.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]
    Complex = NDArray[np.complex128]

_STEP = 2e-3


def critical_vector(matrix: Floats, omega: float) -> Complex:
    """Return the unit vector q with matrix q ≈ iω q."""
    values, vectors = np.linalg.eig(matrix)
    q = vectors[:, int(np.argmin(np.abs(values - 1j * omega)))]
    return np.asarray(q / np.linalg.norm(q))


def first_lyapunov(system: System, z: Floats, p: Mapping[str, float], omega: float) -> float:
    """Return l1: negative if stable cycles are born (supercritical). Its size depends on the scale of z."""
    matrix = system.jacobian(z, p)
    q = critical_vector(matrix, omega)
    left = critical_vector(matrix.T, omega)
    left = left / (left @ q)  # the left eigenvector of the same eigenvalue

    def at(step: float, direction: Floats) -> Floats:
        return system.jacobian(z + step * direction, p)

    def first(direction: Floats) -> Floats:
        return system.second(z, p, direction)

    def second(direction: Floats) -> Floats:
        h = _STEP
        near = at(h, direction) + at(-h, direction)
        wide = at(2 * h, direction) + at(-2 * h, direction)
        return np.asarray((16.0 * near - wide - 30.0 * matrix) / (12.0 * h * h))

    by_q = first(q.real) + 1j * first(q.imag)
    cubic = (second(q.real) + second(q.imag)) @ q
    mean = np.linalg.solve(matrix.astype(complex), by_q @ q.conj())
    double = np.linalg.solve(2j * omega * np.eye(len(z)) - matrix, by_q @ q)
    total = left @ cubic - 2.0 * left @ (by_q @ mean) + left @ (by_q.conj() @ double)
    return float(total.real / (2.0 * omega))
