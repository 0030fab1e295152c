"""Where searches for steady states begin: where the run begins, ends and passes, and all over a box."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_RECORDED_MOST = 200
_BEYOND_ALL = 1e8
_BEYOND = 0.5
"""So much wider on each side than the run's range is the box that is searched."""


class Travelled:
    """What the program's own run passes: where it begins and ends, and the range of each state."""

    def __init__(self, subject: Subject) -> None:
        model = subject.model
        names = tuple(model.states)
        recorded = names if len(names) <= _RECORDED_MOST else ()
        self.shown: tuple[str, ...] = ()
        """States that the program displays, or all, those first that it displays."""
        self.across: tuple[str, ...] = ()
        """Abscissa and first ordinate of the program's dispxy."""
        self.passed: list[Floats] = []
        """Samples of all states, if they are recorded and the run came to its end."""
        self.duration = 1.0
        self.problem = ""
        """Why there is no run; empty if there is one."""
        try:
            run = model.run(set=dict(subject.settings), record=recorded)
        except DesireError as error:
            self.problem = error.diagnostics[0].message
            self.start = self.end = np.array(list(model.states.values()))
            self.low = self.high = self.start
            return
        self.shown = tuple(curve.name for curve in run.curves if curve.name in model.states)
        if run.request == "dispxy":
            over = next((curve for curve in run.curves if curve.x is not None), None)
            self.across = () if over is None or over.x is None else (over.x, over.name)
        self.duration = run.tmax
        self.start = np.array([run.initial.get(name, model.states[name]) for name in names])
        is_known = np.all(np.isfinite(run.state)) and run.error is None
        self.end = run.state.copy() if is_known else self.start
        largest = _BEYOND_ALL * np.maximum(np.abs(self.start), 1.0)
        if run.error is not None or np.any(np.abs(run.state) > largest):
            # what the run passed on its way to infinity says nothing
            self.problem = "" if run.error is None else run.error.diagnostics[0].message
            self.problem = self.problem or "the states grew without bound"
            self.end = self.low = self.high = self.start
            return
        self.passed = [np.asarray(run[name]) for name in recorded]
        passed = self.passed or list(np.vstack([self.start, self.end]).T)
        self.low = np.array([np.nanmin(np.where(np.isfinite(c), c, np.nan)) for c in passed])
        self.high = np.array([np.nanmax(np.where(np.isfinite(c), c, np.nan)) for c in passed])

    @property
    def size(self) -> Floats:
        """How large each state gets."""
        return np.asarray(np.maximum(np.abs(self.low), np.abs(self.high)))

    def box(self) -> tuple[Floats, Floats]:
        """Return a box somewhat larger than the run's range."""
        wide = self.high - self.low
        room = np.where(wide > 0.0, _BEYOND * wide, 2.0 * np.maximum(np.abs(self.high), 1.0))
        return self.low - room, self.high + room


def spread(low: Floats, high: Floats, count: int) -> Floats:
    """Return places that fill a box evenly, count by n.

    The additive recurrence of M. Roberts (The unreasonable effectiveness of quasirandom sequences, 2018);
    Sobol's sequence is no better for some hundred starts, and its module takes half a second to import.
    """
    n = len(low)
    ratio = 2.0
    for _ in range(64):  # x^(n + 1) = x + 1
        ratio = (1.0 + ratio) ** (1.0 / (n + 1))
    steps = ratio ** -np.arange(1.0, n + 1)
    places = (0.5 + np.arange(1, count + 1)[:, None] * steps) % 1.0
    return np.asarray(low + places * (high - low))
