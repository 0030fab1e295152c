"""dx/dt of a program as a function of states and parameters, time left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_PLACES = 12
_LATER = 0.7390851
"""Added to t, times 1, 2 …: only a forcing of just this period would be overlooked."""
_STEP = 2e-3
"""Of differences by a parameter, as a part of its scale: the fourth power of it is left as an error."""


class Flow:
    """dx/dt = f(x; p) of a program's n states at the program's own parameters or at others.

    DesireError 491: f depends on the past or on chance; 521: on t.
    """

    def __init__(self, subject: Subject) -> None:
        model = subject.model
        self.settings = dict(subject.settings)
        self.rhs, self.matrix = model.equations(**self.settings)
        self.names = self.rhs.states
        self.parameters = {**model.parameters, **{k: float(v) for k, v in self.settings.items()}}
        """Values of all quantities that may be varied."""
        self.start = self.rhs.start
        """The states that a run begins with."""
        self.notes: list[str] = []
        """What is left out of account."""
        if self.rhs.has_events:
            self.notes.append("events are left out: what is told is true of the derivatives between them")
        self._refuse_time(subject)

    def __len__(self) -> int:
        return len(self.names)

    def rate(self, x: Floats, p: Mapping[str, float]) -> Floats:
        """Return dx/dt at a place (n) or at many (n by m), with these parameters besides the program's own.

        It may hold inf and nan.
        """
        return self.rhs(0.0, np.ascontiguousarray(x), **p)

    def jacobian(self, x: Floats, p: Mapping[str, float]) -> Floats:
        """Return ∂f/∂x, n by n, exact where f can be differentiated; for m places, n by m, m by n by n."""
        return self.matrix(0.0, np.ascontiguousarray(x), **p)

    def by_parameter(self, x: Floats, p: Mapping[str, float], name: str, scale: float) -> Floats:
        """Return ∂f/∂p, n numbers, or n by m for m places, by central differences of the fourth order.

        `scale`: over such a range the parameter is of interest.
        """
        h = _STEP * scale
        return central(lambda step: self.rate(x, {**p, name: p[name] + step}), h)

    def _refuse_time(self, subject: Subject) -> None:
        places = around(self.start, np.random.default_rng(1), _PLACES)
        first = self.rate(places, {})
        later = self.rhs(_LATER * np.arange(1, _PLACES + 1), places)
        is_known = np.isfinite(first) & np.isfinite(later)
        moved = ~np.isclose(first, later, rtol=1e-12, atol=0.0) & is_known
        if np.any(moved):
            names = ", ".join(np.asarray(self.names)[np.any(moved, axis=1)][:4])
            what = f"the derivative of {names} depends on t: there is no steady state"
            remedy = "make the forcing an oscillator of two states: d/dt u = u + w*v - u*(u*u + v*v) …"
            raise DesireError(
                Diagnostic("analysis-failed", None, {"what": what, "remedy": remedy}, subject.source)
            )


def central(f: Callable[[float], Floats], h: float) -> Floats:
    """Return the derivative at 0 of a function of a number, by differences of the fourth order."""
    slope: Floats = (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h)
    return slope


def around(x: Floats, random: np.random.Generator, count: int) -> Floats:
    """Return random places about as far from 0 as a place is, n by `count`, all numbers greater than 0."""
    size = np.where(x == 0.0, 1.0, np.abs(x))
    return size[:, None] * (0.2 + 1.6 * random.random((len(x), count)))
