"""Colours of runs that share a graph: a ramp from the first to the last.

How many runs there will be is often not known: the ramp is laid out for more, and anew when these have come
and when the program is over.
"""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.graph.colors import ramp_color

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.graph.curve import Curve

SPAN_LEAST = 4


def in_run_colors(curves: Sequence[Curve]) -> list[Curve]:
    """Return the curves of several runs, one after the other, in ramps from the first run to the last."""
    colors = RunColors()
    for _, group in groupby((c for c in curves if not c.measured), lambda curve: curve.record):
        colors.add(list(group))
    colors.widen(0)
    return colors.colored(curves, 0, own_colors=True)


class RunColors:
    """What is known of the runs of a graph. `span`: for so many runs the ramp is laid out now."""

    def __init__(self) -> None:
        self.runs = self.span = 0
        self._hues: dict[str, int] = {}
        self._has_own = False  # the program gives the runs colours
        self._runs_of: dict[str, int] = {}

    def add(self, curves: Sequence[Curve]) -> None:
        """Take note of a run's curves."""
        self.runs += 1
        for curve in curves:
            if curve.measured:
                continue
            if self._hues.setdefault(curve.name, curve.hue) != curve.hue:
                self._has_own = True
            self._runs_of[curve.name] = self._runs_of.get(curve.name, 0) + 1

    @property
    def is_wanted(self) -> bool:
        """Whether runs would have the same colours without a ramp."""
        return self.runs > 1 and not self._has_own

    def widen(self, ahead: int | None) -> bool:
        """Make room for the runs there are and those ahead, if known; returns whether the ramp changed."""
        if not self.is_wanted:
            return False
        span = self.span
        if ahead is not None:
            span = self.runs + ahead
        elif self.runs > span:
            span = max(SPAN_LEAST, 2 * span)
        changed, self.span = span != self.span, span
        return changed

    def colored(self, curves: Sequence[Curve], first: int, *, own_colors: bool) -> list[Curve]:
        """Return curves in the colours of their runs; the first belong to run number `first` (from 0).

        `own_colors`: the program says which hue a curve has.
        """
        if not self.is_wanted:
            return list(curves)
        alone = len(self._hues) == 1 and not own_colors
        place, before, found = first - 1, None, []
        for curve in curves:
            if curve.measured:
                found.append(curve)
                continue
            if curve.record is not before:
                place, before = place + 1, curve.record
            found.append(self._with_color(curve, place, alone=alone))
        return found

    def _with_color(self, curve: Curve, place: int, *, alone: bool) -> Curve:
        if self._runs_of[curve.name] == 1:
            return replace(curve, color=curve.hue)
        part = min(place / max(self.span - 1, 1), 1.0)
        return replace(curve, color=ramp_color(part, None if alone else curve.hue))
