"""The matrices A, B, C, D of a program near a place: dx/dt = A x + B u, y = C x + D u."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.analysis.equilibria.flow import central
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_STEP = 1e-5
"""In parts of a quantity's size: rounding is then 1e-11 of a derivative, and what bends over a hundredth of
the size is followed as exactly by differences of the fourth order."""
_INSTANT = 1e-9
"""In parts of a run: a run so short samples quantities as they are at its start."""


@dataclass(frozen=True)
class Place:
    """Where a program is linearised."""

    t: float
    x: Floats
    said: str


@dataclass(frozen=True)
class StateSpace:
    """`a` (n, n), `b` (n, inputs), `c` (outputs, n), `d` (outputs, inputs)."""

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    a: Floats
    b: Floats
    c: Floats
    d: Floats


def state_space(subject: Subject, inputs: Sequence[str], outputs: Sequence[str], place: Place) -> StateSpace:
    """Return the matrices; A is the compiled Jacobian, the others are differences exact to about 1e-11.

    DesireError, TypeError: a name is not there.
    """
    model, settings = subject.model, dict(subject.settings)
    values = {**model.parameters, **settings}
    names = tuple(model.states)
    b = np.zeros((len(names), len(inputs)))
    for k, name in enumerate(inputs):
        slopes = partial(_slopes, subject, place, name, values[name])
        b[:, k] = central(slopes, _STEP * (abs(values[name]) or 1.0))
    c, d = np.zeros((len(outputs), len(names))), np.zeros((len(outputs), len(inputs)))
    computed = [k for k, name in enumerate(outputs) if name not in names]
    for k, name in enumerate(outputs):
        if name in names:
            c[k, names.index(name)] = 1.0
    if computed:
        reading = _Reading(subject, [outputs[k] for k in computed], place)
        for i in range(len(names)):
            c[computed, i] = central(partial(reading.with_state, i), _STEP * (abs(place.x[i]) or 1.0))
        for i, name in enumerate(inputs):
            read = partial(reading.with_input, name, values[name])
            d[computed, i] = central(read, _STEP * (abs(values[name]) or 1.0))
    return StateSpace(
        names, tuple(inputs), tuple(outputs), model.jacobian(place.t, place.x, **settings), b, c, d
    )


def _slopes(subject: Subject, place: Place, name: str, value: float, step: float) -> Floats:
    """Return dx/dt with a parameter moved by a step."""
    return subject.model.rhs(place.t, place.x, **{**subject.settings, name: value + step})


class _Reading:
    """Values of quantities that are no states, at a place: the first sample of a run that begins there."""

    def __init__(self, subject: Subject, names: Sequence[str], place: Place) -> None:
        self._subject, self._names, self._place = subject, tuple(names), place

    def with_state(self, number: int, step: float) -> Floats:
        """Return them with a state moved by a step."""
        x = self._place.x.copy()
        x[number] += step
        return self._read(x, {})

    def with_input(self, name: str, value: float, step: float) -> Floats:
        """Return them with a parameter moved by a step."""
        return self._read(self._place.x, {name: value + step})

    def _read(self, x: Floats, changed: dict[str, float]) -> Floats:
        t = self._place.t
        span = _INSTANT * max(abs(t), 1.0)
        run = self._subject.model.run(
            set={**self._subject.settings, **changed, "NN": 2.0, "DT": span},
            initial=x,
            t=(t, t + span),
            record=self._names,
        )
        if not len(run.t):
            assert run.error is not None
            raise run.error
        return np.array([run[name][0] for name in self._names])
