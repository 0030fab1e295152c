"""The limit cycle that a run has come to: found by integration, made exact by collocation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.continuation.collocation import adapted_mesh, node_times
from desire_tui.analysis.continuation.curve import point_at
from desire_tui.analysis.continuation.cycle_curve import CycleCurve
from desire_tui.analysis.libraries import needed

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.equilibrium_curve import Range
    from desire_tui.analysis.equilibria.system import System

    Floats = NDArray[np.float64]

_INTERVALS = 40
_BACK = 0.05
"""The orbit has come back if it passes so near, against its size, the place where it began."""
_REPEATS, _CLOSED = 0.1, 1e-4
_ROUNDS = 3
_STILL = 1e-4
_REFINED = 8
_TOLERANCE = 1e-8
_ACCURATE = 1e-8
"""Of the cycle's polynomials: its period is exact to some units in the last place."""


class _NoCycleError(Exception):
    """The run does not come back to where it was; why is the text."""


def from_run(
    system: System, over: Range, part: float, x: Floats, duration: float, go_on: Callable[[], bool]
) -> tuple[CycleCurve, Point] | str:
    """Return the curve of cycles through the one that orbits come to from x, and that cycle.

    `part` is the parameter's place in its range; the orbit is followed three times for `duration`, about as
    long as the program's run. A text: why none is found.
    """
    p = {over.name: over.value(part)}
    z = system.place(x)
    try:
        for _ in range(_ROUNDS):
            orbit, size = _orbit(system, p, z, duration, go_on)
            z = orbit.y[:, -1]
        period, sample = _return(system, p, z, duration, size, go_on)
    except _NoCycleError as reason:
        return str(reason)
    mesh = np.linspace(0.0, 1.0, _INTERVALS + 1)
    for _ in range(2):
        nodes = sample(period * node_times(mesh)).T
        mesh = adapted_mesh(mesh, nodes, _INTERVALS)
    nodes = np.ascontiguousarray(sample(period * node_times(mesh)).T)
    curve = CycleCurve(system, over, mesh, nodes, accuracy=_ACCURATE)
    along = np.zeros(nodes.size + 2)
    along[-1] = 1.0
    u = np.append(nodes.ravel(), [np.log(period), part])
    for _ in range(_REFINED):  # the mesh that suits the cycle is found with it
        first = point_at(curve, u, along)
        if first is None:
            return "the orbit comes back, but collocation does not converge to a cycle"
        adapted = curve.adapted(first)
        if adapted is first:
            return curve, first
        u = adapted.u
        along = np.zeros(len(u))
        along[-1] = 1.0
    first = point_at(curve, u, along)
    return (curve, first) if first is not None else "collocation does not converge to a cycle"


def _orbit(
    system: System,
    p: dict[str, float],
    z: Floats,
    duration: float,
    go_on: Callable[[], bool],
    **options: Any,
) -> tuple[Any, float]:
    """Return an orbit, and how far it goes from side to side."""
    solve_ivp = needed("scipy.integrate", "the search for a cycle").solve_ivp

    def rate(_: float, place: Floats) -> Floats:
        if not go_on():
            raise _NoCycleError("stopped")
        return system.rate(place, p)

    orbit = solve_ivp(
        rate, (0.0, duration), z, method="LSODA", jac=lambda _, place: system.jacobian(place, p),
        rtol=_TOLERANCE, atol=_TOLERANCE, **options,
    )  # fmt: skip
    if not orbit.success or not np.all(np.isfinite(orbit.y[:, -1])):
        raise _NoCycleError("the orbit runs off to infinity")
    size = float(np.ptp(orbit.y, axis=1).max())
    return orbit, size


def _return(
    system: System, p: dict[str, float], z: Floats, duration: float, size: float, go_on: Callable[[], bool]
) -> tuple[float, Callable[[Floats], Floats]]:
    """Return the time after which an orbit comes back, and the orbit as a function of time."""
    direction = system.rate(z, p)
    speed = float(np.linalg.norm(direction))
    if size < _STILL or speed * duration < _STILL:
        raise _NoCycleError("the run comes to a steady state, not to a cycle")

    brentq = needed("scipy.optimize", "the search for a cycle").brentq
    orbit, _ = _orbit(system, p, z, duration, go_on, dense_output=True)

    def ahead(time: float) -> float:
        return float((orbit.sol(time) - z) @ direction)

    side = direction @ (orbit.y - z[:, None])
    nearest, period = _BACK * size, 0.0
    for k in np.flatnonzero((side[:-1] < 0.0) & (side[1:] >= 0.0)):
        time = float(brentq(ahead, orbit.t[k], orbit.t[k + 1], xtol=1e-14 * duration))
        distance = float(np.linalg.norm(orbit.sol(time) - z))
        if (
            distance < _REPEATS * nearest
        ):  # so much nearer than before: what came back then was no whole period
            nearest, period = distance, time
        if nearest < _CLOSED * size:
            break
    if period:
        return period, orbit.sol
    raise _NoCycleError("within the time of a run the orbit does not come back to where it was")
