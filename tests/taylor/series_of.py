"""Taylor coefficients of small programs, by either back end and by Cauchy's integral."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.integration.taylor.memory import ORDER_MOST
from desire_tui.engine.integration.taylor.solver import TaylorSolver
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.reference.backend import ReferenceBackend
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import T, Values
from tests.codegen.conftest import improve, memory_for

if TYPE_CHECKING:
    from collections.abc import Callable

WAYS = ("reference", "quick", "fast")


def coefficients(
    text: str,
    way: str,
    given: dict[str, float | np.ndarray],
    states: tuple[str, ...] = (),
    error_max: float = 0.0,
) -> dict[str, np.ndarray]:
    """Return the coefficients of all states in the first step from t = 0, by name.

    Shape (order + 1,), of an array (order + 1, elements). `given` sets numbers and makes arrays; those named in
    `states` are state arrays.
    """
    values = Values()
    for name, number in given.items():
        if isinstance(number, np.ndarray):
            values.view(values.array(name, number.shape, is_state=name in states))[:] = number
        else:
            values.assign(values.scalar(name).slot, number)
    values.assign(T, 0.0)
    segment = lower(parse(Source(text)), None, values)
    model = (ReferenceBackend() if way == "reference" else NativeBackend()).model(segment, 17, values)
    if way == "fast":
        improve(model._series)
        improve(model._functions)
    memory, _ = memory_for(values, segment, t_max=1e-3, dt=1e-3, nn=2, error_max=error_max)
    model.advance(memory)
    solver = model.system.solver
    assert isinstance(solver, TaylorSolver)
    flat = np.empty((ORDER_MOST + 1, segment.order))
    pieces = np.ctypeslib.as_array(solver.taylor.pieces, (4 * solver.taylor.piece_count,)).reshape(-1, 4)
    for first, count, place, apart in pieces:
        for k in range(ORDER_MOST + 1):
            flat[k, first : first + count] = solver.coefficients[place + k * apart :][:count]
    found = {}
    for quantity in values:
        for given_states in segment.states:
            if given_states.slot == quantity.slot and given_states.count == quantity.size:
                rows = flat[:, given_states.first : given_states.first + given_states.count]
                found[quantity.name] = rows if quantity.shape else rows[:, 0]
    return found


def by_cauchy(f: Callable[[complex], complex], t: float, radius: float, points: int = 256) -> np.ndarray:
    """Return f's Taylor coefficients at t, times radius^k: the mean of f·e^(-ikφ) over a circle around t."""
    angles = 2 * np.pi * np.arange(points) / points
    values = np.array([f(t + radius * cmath.exp(1j * angle)) for angle in angles])
    return (np.fft.fft(values) / points).real[: ORDER_MOST + 1]
