"""A linear system's poles, zeros and margins, its answers to sines and steps: by python-control."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.analysis.libraries import needed
from desire_tui.analysis.result import Table
from desire_tui.engine.graph.chart import Chart, Series

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from desire_tui.analysis.linear.state_space import StateSpace

    Floats = NDArray[np.float64]

WHAT = "linear analysis"
_RISING = 1e-9
"""A real part is 0 if it is so many times smaller than the pole."""


def system_of(matrices: StateSpace) -> Any:
    """Return a `control.StateSpace`."""
    return needed("control", WHAT).ss(
        matrices.a, matrices.b, matrices.c, matrices.d, remove_useless_states=False
    )


def pole_table(poles: NDArray[np.complex128]) -> Table:
    """Return poles with natural frequency, damping ratio and time constant, the slowest first."""
    ordered = poles[np.lexsort((poles.imag, -poles.real))]
    size = np.abs(ordered)
    with np.errstate(divide="ignore", invalid="ignore"):
        damping = np.where(size > 0, -ordered.real / size, 1.0) + 0.0  # no -0
        constant = np.where(np.abs(ordered.real) > _RISING * size, -1.0 / ordered.real, np.inf)
    return Table("poles", {
        "real": (ordered.real + 0.0).tolist(), "imaginary": ordered.imag.tolist(), "frequency": size.tolist(),
        "damping": damping.tolist(), "time constant": constant.tolist(),
    })  # fmt: skip


def stability(poles: NDArray[np.complex128]) -> str:
    """Say whether the system settles."""
    size = np.maximum(np.abs(poles), np.finfo(float).tiny)
    if np.any(poles.real > _RISING * size):
        return f"unstable: {int(np.sum(poles.real > _RISING * size))} of {len(poles)} poles on the right"
    if np.any(poles.real >= -_RISING * size):
        return "on the limit of stability: poles on the imaginary axis"
    return "stable: all poles on the left"


def margin_table(system: Any, matrices: StateSpace) -> Table:
    """Return gain and phase margins of each pair of input and output: of an open loop, closed by -1."""
    control = needed("control", WHAT)
    columns: dict[str, list[Any]] = {
        name: [] for name in ("from", "to", "gain margin, dB", "at", "phase margin, deg", "at ", "zeros")
    }
    for source, target, pair in pairs(system, matrices):
        gain, phase, _, at_phase, at_gain, _ = control.stability_margins(pair)
        with np.errstate(divide="ignore"):
            row = [source, target, float(20 * np.log10(gain)), float(at_phase), float(phase), float(at_gain),
                   _complex_text(pair.zeros())]  # fmt: skip
        for name, value in zip(columns, row, strict=True):
            columns[name].append(value)
    return Table("margins and zeros", columns)


def charts(system: Any, matrices: StateSpace) -> list[Chart]:
    """Return Bode's magnitude and phase, Nyquist's curve and the answer to a step."""
    control = needed("control", WHAT)
    magnitude, phase, nyquist, step = [], [], [], []
    for source, target, pair in pairs(system, matrices):
        name = f"{target} / {source}"
        answer = control.frequency_response(pair)
        omega, values = answer.omega, answer.frdata[0, 0]
        with np.errstate(divide="ignore"):
            magnitude.append(Series(name, omega, 20.0 * np.log10(np.abs(values))))
        phase.append(Series(name, omega, np.degrees(np.unwrap(np.angle(values)))))
        nyquist.append(Series(name, np.append(values.real, [np.nan, *values.real[::-1]]),
                              np.append(values.imag, [np.nan, *-values.imag[::-1]])))  # fmt: skip
        times = control.step_response(pair)
        step.append(Series(name, times.time, np.ravel(times.outputs)))
    point = Series("-1", np.array([-1.0]), np.array([0.0]), "points", color=12)
    return [
        Chart("Bode: magnitude", "angular frequency", "dB", magnitude, log_x=True),
        Chart("Bode: phase", "angular frequency", "degrees", phase, log_x=True),
        Chart("Nyquist", "real", "imaginary", [*nyquist, point], equal=True),
        Chart("Answer to a step", "t", "output", step),
    ]


def pairs(system: Any, matrices: StateSpace) -> Iterator[tuple[str, str, Any]]:
    """Yield input, output and the system between them."""
    for j, source in enumerate(matrices.inputs):
        for i, target in enumerate(matrices.outputs):
            yield source, target, system[i, j]


def _complex_text(values: NDArray[np.complex128]) -> str:
    return (
        ", ".join(f"{z.real:.5g}" if z.imag == 0 else f"{z.real:.5g}{z.imag:+.5g}i" for z in values) or "none"
    )
