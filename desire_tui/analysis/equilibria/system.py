"""A flow in coordinates that suit Newton's method: scaled, and without the sums that no motion changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.conservation import conserved, law
from desire_tui.analysis.equilibria.flow import around, central

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.equilibria.flow import Flow

    Floats = NDArray[np.float64]


class System:
    """dz/dt = g(z; p) with x = base + basis z.

    The columns of `basis` (n by m) span what the conserved sums leave free, in scaled states: for each state
    `size` is about how large it gets, a power of 2. Eigenvalues of ∂g/∂z are those of ∂f/∂x but for a 0 for
    each sum.
    """

    def __init__(
        self, flow: Flow, base: Floats, size: Floats | None = None, values: Sequence[Mapping[str, float]] = ()
    ) -> None:
        """`values` are further parameters with which sums have to be conserved, to be left out."""
        self.flow = flow
        n = len(flow)
        largest = np.abs(base) if size is None else np.abs(size)
        known = np.where(np.isfinite(largest) & (largest > 0.0), largest, 1.0)
        self.size = np.exp2(np.round(np.log2(known)))
        places = around(known, np.random.default_rng(2), 2 * n + 8)
        rates = flow.rate(places, {})
        self.laws = conserved(np.hstack([rates, *(flow.rate(places, p) for p in values)]))
        """Weights of conserved sums of states, k by n."""
        if len(self.laws):
            _, _, right = np.linalg.svd(self.laws * self.size)
            free = right[len(self.laws) :].T
            self.base = base.copy()
        else:
            free = np.eye(n)
            self.base = np.zeros(n)
        self.basis = self.size[:, None] * free
        self.cobasis = free.T / self.size
        """m by n: z = cobasis (x - base)."""
        speeds = np.linalg.norm(self.cobasis @ rates, axis=0)
        self.pace = float(np.median(speeds[np.isfinite(speeds)])) if np.any(np.isfinite(speeds)) else 1.0
        """How fast z changes, typically."""

    def __len__(self) -> int:
        return len(self.cobasis)

    @property
    def law_texts(self) -> list[str]:
        """Conserved sums as they are written, with their values."""
        names = self.flow.names
        return [f"{law(row, names)} = {row @ self.base:.6g}" for row in self.laws]

    def states(self, z: Floats) -> Floats:
        """Return x at z, for one place (m) or many (m by count)."""
        moved: Floats = self.basis @ z
        return moved + (self.base if z.ndim == 1 else self.base[:, None])

    def place(self, x: Floats) -> Floats:
        """Return z at x; what the conserved sums forbid is left out."""
        moved = x - (self.base if x.ndim == 1 else self.base[:, None])
        z: Floats = self.cobasis @ moved
        return z

    def rate(self, z: Floats, p: Mapping[str, float]) -> Floats:
        """Return dz/dt at one place or at many."""
        g: Floats = self.cobasis @ self.flow.rate(self.states(z), p)
        return g

    def jacobian(self, z: Floats, p: Mapping[str, float]) -> Floats:
        """Return ∂g/∂z, m by m."""
        matrix: Floats = self.cobasis @ self.flow.jacobian(self.states(z), p) @ self.basis
        return matrix

    def jacobians(self, places: Floats, p: Mapping[str, float]) -> Floats:
        """Return ∂g/∂z at many places, count by m by m, from count by m."""
        return np.asarray(self.cobasis @ self.flow.jacobian(self.states(places.T), p) @ self.basis)

    def by_parameter(self, z: Floats, p: Mapping[str, float], name: str, scale: float) -> Floats:
        """Return ∂g/∂p, as `Flow.by_parameter` does."""
        slope: Floats = self.cobasis @ self.flow.by_parameter(self.states(z), p, name, scale)
        return slope

    def second(self, z: Floats, p: Mapping[str, float], direction: Floats) -> Floats:
        """Return the derivative of ∂g/∂z along a direction, m by m, by differences of the fourth order."""
        return central(lambda step: self.jacobian(z + step * direction, p), _curve_step(z, direction))


def _curve_step(z: Floats, direction: Floats) -> float:
    size = float(np.linalg.norm(direction))
    return 1e-3 * (1.0 + float(np.linalg.norm(z)) * 1e-2) / max(size, 1e-300)
