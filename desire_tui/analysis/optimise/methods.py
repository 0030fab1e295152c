"""Ways to look for the least value: by the gradient, by a simplex, by populations.

Each takes an objective and where to begin, in scaled unknowns, and leaves the best place in the objective.
Gradients are central differences whose runs are made together (2 n + 1 candidates at once).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.libraries import needed

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.optimise.objective import Objective

    Floats = NDArray[np.float64]

WHAT = "an optimum"
STEP = 1e-4
"""Of differences, in scaled unknowns: J is exact to about 1e-9, so that a gradient is to about 1e-5 * J."""
_SIMPLEX = 0.02
_FLAT = 1e-6


class StoppedError(Exception):
    """The user ended the search."""


def gradient(objective: Objective, z: Floats) -> tuple[float, Floats]:
    """Return J and its derivatives; at a bound by a difference to one side."""
    low, high = objective.scale.low, objective.scale.high
    up, down = np.minimum(z + STEP, high), np.maximum(z - STEP, low)
    rows = np.tile(z, (2 * len(z) + 1, 1))
    places = np.arange(len(z))
    rows[1 + places, places], rows[1 + len(z) + places, places] = up, down
    found = objective.many(rows)
    with np.errstate(invalid="ignore"):
        slopes = (found[1 : 1 + len(z)] - found[1 + len(z) :]) / (up - down)
    return float(found[0]), np.where(np.isfinite(slopes), slopes, 0.0)


def local(objective: Objective, z: Floats, go_on: Callable[[], bool], runs: int) -> None:
    """Go down by the gradient (L-BFGS-B); where that comes to a halt early, by a simplex (Nelder & Mead)."""
    optimize = needed("scipy.optimize", WHAT)
    limits = list(zip(objective.scale.low, objective.scale.high, strict=True))

    def counted(place: Floats) -> tuple[float, Floats]:
        _check(go_on, objective, runs)
        value, slopes = gradient(objective, place)
        return (value if np.isfinite(value) else 1e300), slopes

    def counted_value(place: Floats) -> float:
        _check(go_on, objective, runs)
        return objective(place)

    try:
        optimize.minimize(counted, z, jac=True, method="L-BFGS-B", bounds=limits,
                          options={"ftol": 1e-15, "gtol": 1e-9, "maxls": 30})  # fmt: skip
        if is_settled(objective):
            return
        begin = objective.best_z if len(objective.best_z) else z
        optimize.minimize(
            counted_value, begin, method="Nelder-Mead", bounds=limits,
            options={"initial_simplex": _simplex(objective, begin), "xatol": 1e-8,
                                    "fatol": 1e-14, "adaptive": len(z) > 4},
        )  # fmt: skip
    except StoppedError:
        return


def is_settled(objective: Objective) -> bool:
    """Whether J falls nowhere from the best place: its slopes are 0, or lead beyond a bound."""
    if not len(objective.best_z):
        return False
    z, low, high = objective.best_z, objective.scale.low, objective.scale.high
    value, slopes = gradient(objective, z)
    inside = ~((slopes > 0) & (z <= low) | (slopes < 0) & (z >= high))
    return bool(np.all(np.abs(slopes[inside]) <= _FLAT * max(1.0, abs(value))))


def population(objective: Objective, go_on: Callable[[], bool], runs: int, seed: int) -> None:
    """Search between bounds by differential evolution (Storn & Price 1997), a generation at once."""
    optimize = needed("scipy.optimize", WHAT)
    n = len(objective.scale.low)
    size = max(15, 40 // n)

    def generation(candidates: Floats) -> Floats:
        return objective.many(candidates.T)

    def after_each(intermediate_result: Any) -> bool:
        """Be called by this name of its argument alone; True ends the search."""
        del intermediate_result
        return not go_on()

    optimize.differential_evolution(
        generation, list(zip(objective.scale.low, objective.scale.high, strict=True)), vectorized=True,
        updating="deferred", polish=False, popsize=size, rng=seed, tol=1e-8, init="sobol",
        maxiter=max(1, runs // (size * n)), callback=after_each,
    )  # fmt: skip


def covariance(objective: Objective, z: Floats, go_on: Callable[[], bool], runs: int, seed: int) -> None:
    """Search by adapting a normal distribution (CMA-ES, Hansen 2016), a generation at once."""
    scale = objective.scale
    if len(z) == 1:  # CMA-ES needs two unknowns
        if np.isfinite(scale.low + scale.high).all():
            population(objective, go_on, runs, seed)
        return
    cma = needed("cma", WHAT)
    options: dict[str, Any] = {
        "bounds": [_ends(scale.low), _ends(scale.high)], "seed": seed + 1, "verbose": -9, "maxfevals": runs,
        "tolfun": 1e-13, "tolx": 1e-10,
    }  # fmt: skip
    search = cma.CMAEvolutionStrategy(z, 0.25, options)
    while not search.stop() and go_on():
        candidates = search.ask()
        search.tell(candidates, objective.many(np.array(candidates)).tolist())


def _ends(values: Floats) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]


def _check(go_on: Callable[[], bool], objective: Objective, runs: int) -> None:
    if objective.evaluations >= runs or not go_on():
        raise StoppedError


def _simplex(objective: Objective, z: Floats) -> Floats:
    """Return corners about a place, inside the bounds."""
    corners = np.tile(z, (len(z) + 1, 1))
    for k in range(len(z)):
        step = _SIMPLEX if z[k] + _SIMPLEX <= objective.scale.high[k] else -_SIMPLEX
        corners[k + 1, k] += step
    return corners
