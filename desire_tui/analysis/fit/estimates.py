"""What a fit says about its parameters: standard errors, correlations, intervals, what cannot be told.

Linear theory at the solution (Seber and Wild, "Nonlinear Regression", chapter 2): cov = s²·(JᵀJ)⁻¹; under a
robust loss the sandwich H⁻¹·Jᵀ·diag(ψ²)·J·H⁻¹ (Huber and Ronchetti, "Robust Statistics", chapter 7).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.libraries import needed
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_DEPENDENT = 1e-7
"""Singular values of scaled derivatives, in parts of the largest, of combinations that are undetermined."""
_SHARE = 0.1
LEVEL = 0.95


@dataclass(frozen=True)
class Estimates:
    """`covariance` of z; `factor` makes half an interval of a standard error; names that cannot be told."""

    covariance: Floats
    factor: float
    undetermined: tuple[str, ...]
    chi2: float
    freedom: int

    @property
    def errors(self) -> Floats:
        """Standard errors of z."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def correlations(self) -> Floats:
        """Correlations of the estimates."""
        errors = self.errors
        with np.errstate(invalid="ignore", divide="ignore"):
            found: Floats = self.covariance / np.outer(errors, errors)
        return found


_WEIGHTS: dict[str, Callable[[Floats], Floats]] = {
    "linear": np.ones_like,
    "soft_l1": lambda q: (1.0 + q) ** -0.5,
    "huber": lambda q: np.where(q <= 1.0, 1.0, np.maximum(q, 1.0) ** -0.5),
    "cauchy": lambda q: 1.0 / (1.0 + q),
    "arctan": lambda q: 1.0 / (1.0 + q * q),
}
"""ρ'(q) of scipy's losses, q = r²."""


def estimates(
    names: Sequence[str], residuals: Floats, jacobian: Floats, loss: str, *, sigma_known: bool
) -> Estimates:
    """Return what residuals and derivatives in standard deviations say; `sigma_known`: those were given."""
    count, unknowns = jacobian.shape
    freedom = max(count - unknowns, 1)
    weights = _WEIGHTS[loss](residuals**2)
    scales = np.linalg.norm(jacobian, axis=0)
    scaled = jacobian / np.where(scales == 0.0, 1.0, scales)
    _, singular, rows = np.linalg.svd(scaled * np.sqrt(weights)[:, None], full_matrices=False)
    weak = singular <= _DEPENDENT * singular[0]
    involved = np.any(np.abs(rows[weak]) > _SHARE, axis=0) if weak.any() else np.zeros(unknowns, dtype=bool)
    undetermined = tuple(name for name, one in zip(names, involved | (scales == 0.0), strict=True) if one)
    inverse = (rows[~weak].T / singular[~weak] ** 2) @ rows[~weak]
    if loss == "linear":
        chi2 = float(residuals @ residuals)
        middle = inverse * (1.0 if sigma_known else chi2 / freedom)
    else:
        chi2 = float(np.sum(weights * residuals**2))
        pull = scaled * (weights * residuals)[:, None]
        middle = inverse @ (pull.T @ pull) @ inverse * count / freedom
    bare = np.where(scales == 0.0, 1.0, scales)
    covariance = middle / np.outer(bare, bare)
    for place, name in enumerate(names):
        if name in undetermined:
            covariance[place, :] = covariance[:, place] = 0.0
            covariance[place, place] = np.inf
    stats = needed("scipy.stats", "a fit")
    factor = float(stats.t.ppf(0.5 + LEVEL / 2, freedom))
    return Estimates(covariance, factor, undetermined, chi2, freedom)
