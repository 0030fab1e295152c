"""Tangents of `delay(x, tau)`: the tangent of x, as long ago."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.lowered.segment import DelayedValue
from desire_tui.engine.passes.tangents import NotDifferentiable

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.passes.differentiate import Differentiator


class DelayTangents:
    """Further delays of a segment, `made`, that remember tangents."""

    def __init__(self, segment: Segment) -> None:
        self._segment = segment
        self.made: list[DelayedValue] = []

    def tangent(self, differentiator: Differentiator, value: Op) -> Value | None:
        """Return the tangent of an operation `delayed`, None for 0.

        NotDifferentiable: the delay itself depends on a parameter, or blocks of events may read it.
        """
        number, time, *before = value.args
        assert isinstance(number, Const)
        delayed = self._segment.delays[int(number.value)]
        if self._segment.events or differentiator.of(delayed.tau) is not None:
            raise NotDifferentiable(value)
        source = differentiator.of(delayed.source)
        start = [differentiator.of(h) or Const(0.0) for h in before]
        if source is None and not any(differentiator.of(h) for h in before):
            return None
        self.made.append(DelayedValue(source or Const(0.0), delayed.tau, delayed.where))
        place = len(self._segment.delays) + len(self.made) - 1
        return Op("delayed", (Const(float(place)), time, *start))
