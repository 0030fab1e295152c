"""The quantity that is made least, for many candidates at once: their runs are made by the study engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.studies.chunk import run_chunk
from desire_tui.studies.keep import kept

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.analysis.subject import Subject
    from desire_tui.analysis.unknowns import Scale, Unknown

    Floats = NDArray[np.float64]


class Objective:
    """J as a function of scaled unknowns; `sign` -1 looks for the greatest value.

    DesireError 510: J is no single number of a run.
    """

    def __init__(self, subject: Subject, text: str, unknowns: Sequence[Unknown], sign: float) -> None:
        self.text, self.sign = text, sign
        self.names = tuple(one.name for one in unknowns)
        self._source = subject.source
        keep = _single(text)
        self._task = subject.task(keep, self.names)
        self.scale: Scale
        self.evaluations = 0
        self.best = np.inf
        self.best_z: Floats = np.empty(0)
        self.history: list[tuple[int, float]] = []
        """Number of runs and the best value then, at each gain."""

    def check(self, values: Floats) -> None:
        """DesireError: there is no J where the search begins: what keeps its run from being made."""
        made = run_chunk(self._task, 0, values[None, :])
        if not np.isfinite(made.numbers[0, 0]):
            said = made.failures.lines()
            reason = said[0] if said else f"{self.text} is {made.numbers[0, 0]:g}"
            at = ", ".join(f"{name} = {value:g}" for name, value in zip(self.names, values, strict=True))
            facts = {"what": f"there is no {self.text} where the search begins, at {at}: {reason}",
                     "remedy": "begin elsewhere: k = 2 in [1, 5]"}  # fmt: skip
            raise DesireError(Diagnostic("analysis-failed", None, facts, self._source))

    def many(self, z: Floats) -> Floats:
        """Return sign * J for rows of scaled unknowns; infinity where a run fails."""
        rows = self.scale.values(z)
        numbers = self.sign * run_chunk(self._task, 0, rows).numbers[:, 0]
        found = np.where(np.isfinite(numbers), numbers, np.inf)
        self.evaluations += len(rows)
        least = int(np.argmin(found))
        if found[least] < self.best:
            self.best, self.best_z = float(found[least]), z[least].copy()
            self.history.append((self.evaluations, self.sign * self.best))
        return found

    def __call__(self, z: Floats) -> float:
        """Return sign * J at one place."""
        return float(self.many(np.asarray(z)[None, :])[0])


def _single(text: str) -> str:
    """Return what a study has to keep: a name alone stands for its last value. DesireError 510."""
    try:
        items = kept(text).items
    except DesireError:
        items = kept(f"{text}[end]").items
        text = f"{text}[end]"
    if len(items) != 1 or items[0].size != 1:
        facts = {"what": f"'{text}' is not one number of a run", "remedy": "minimise integral(e^2) over k"}
        raise DesireError(Diagnostic("analysis-form", None, facts))
    return text
