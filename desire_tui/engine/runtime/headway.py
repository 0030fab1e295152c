"""Whether a run gets anywhere: looked at whenever native code comes back, by steps and t, never by a clock.

A run that would go on for days is ended with what can be said of it; short ones are not looked at. There are
three signs. Two are seen over four spans of half a million steps or more: at the pace of the last span, which
is no better than that of the first, what is left of the run would take 10¹² steps; or steps become shorter
from span to span, so that t comes to an end of its own long before the run's (the spans as a geometric
series). The third: twice as many steps have taken t no farther, three times in a row (t grows as their
logarithm, as where something oscillates ever faster), and at that rate 10¹² would not do.
"""

from __future__ import annotations

from itertools import pairwise
from math import log2
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.integration.rules import rule_numbered

if TYPE_CHECKING:
    from numpy.typing import NDArray

SPAN_STEPS = 500_000
_SPANS = 4
STEPS_MOST = 1e12
"""Hours for the smallest of models, days and weeks for others."""
_REACH = 0.01
"""Part of what is left that steps which become shorter and shorter must reach."""
_DOUBLINGS = 3
_AS_FAR = 1.1
"""By so much farther than the one before a doubling of steps may come and be no better."""
_REJECTED = 0.3
"""Tries that fail, as a part of steps: where nothing jumps, they are few."""


@dataclass(frozen=True)
class Standstill:
    """A run that gets nowhere: the state that moved most, why, and how many steps it would take."""

    state: int
    why: str
    advice: str


class _Mark(NamedTuple):
    steps: int
    rejected: int
    t: float
    states: NDArray[np.float64]


class Headway:
    """What has been seen of one run under `rule`."""

    def __init__(self, rule: int) -> None:
        self._rule = rule
        self._marks: list[_Mark] = []
        self._doublings: list[tuple[int, float]] = []
        """Steps and t where steps were twice as many as the time before."""

    def is_due(self, steps: int) -> bool:
        """Whether so many steps have been made since the last look that `look` has something to see."""
        return steps - (self._marks[-1].steps if self._marks else 0) >= SPAN_STEPS

    def look(
        self, steps: int, rejected: int, t: float, left: float, states: NDArray[np.float64]
    ) -> Standstill | None:
        """Note where a run is, `left` from its end; return what is wrong if it gets nowhere."""
        self._marks = [*self._marks[-_SPANS:], _Mark(steps, rejected, t, states.copy())]
        if not self._doublings or steps >= 2 * self._doublings[-1][0]:
            self._doublings = [*self._doublings[-_DOUBLINGS:], (steps, t)]
            if self._grows_as_logarithm(left):
                return self._found("its steps become shorter and shorter", _SINGULAR)
        if len(self._marks) <= _SPANS:
            return None
        paces = [
            (after.t - before.t) / (after.steps - before.steps) for before, after in pairwise(self._marks)
        ]
        first, last = paces[0], paces[-1]
        span = self._marks[-1].t - self._marks[-2].t
        shrinks = all(after < before for before, after in pairwise(paces))
        if shrinks and span * last < _REACH * left * (paces[-2] - last):
            return self._found("its steps become shorter and shorter", _SINGULAR)
        if last < 2.0 * first and left > STEPS_MOST * last:
            return self._found(*self._slow(left, last))
        return None

    def _grows_as_logarithm(self, left: float) -> bool:
        if len(self._doublings) <= _DOUBLINGS:
            return False
        gains = [
            (after[1] - before[1]) / log2(after[0] / before[0]) for before, after in pairwise(self._doublings)
        ]
        if not all(after < _AS_FAR * before for before, after in pairwise(gains)):
            return False
        return left > gains[-1] * log2(STEPS_MOST / self._doublings[-1][0])

    def _slow(self, left: float, pace: float) -> tuple[str, str]:
        steps = left / pace if pace > 0.0 else np.inf
        why = f"what is left would take {steps:.1g} steps"
        kind = rule_numbered(self._rule).kind
        if kind == "fixed":
            return why, "make DT larger, or TMAX smaller"
        first, last = self._marks[0], self._marks[-1]
        if last.rejected - first.rejected > _REJECTED * (last.steps - first.steps):
            return why, _ROUGH
        if self._rule in {14, 15}:
            return why, _FAST
        return why, _STIFF

    def _found(self, why: str, advice: str) -> Standstill:
        before, after = self._marks[-2].states, self._marks[-1].states
        size = np.maximum(np.abs(before), np.abs(after))
        with np.errstate(all="ignore"):
            moved = np.nan_to_num(np.abs(after - before) / np.where(size > 0.0, size, 1.0))
        return Standstill(int(np.argmax(moved)) if moved.size else 0, why, advice)


_SINGULAR = "a pole, or an oscillation that becomes ever faster: end the run by `term` before it"
_ROUGH = "many tries fail: look for a jump, noise or chatter in a derivative"
_FAST = "something oscillates that fast: let the model have its mean, or make TMAX smaller"
_STIFF = "if what is that fast has settled, the model is stiff: use rule 14; else make TMAX smaller"
