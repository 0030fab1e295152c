"""Tables with two breakpoints at one place, looked up by states, as jumps that rules locate.

`func1(x; F)` jumps where two breakpoints coincide. Where x depends on states, rules that control their steps
must see it like any other jump (`passes.switching`). The table is then looked up at a place that keeps to one
side of the jump, which `comp(x - c, …)` chooses: a switch like all others.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1
from desire_tui.engine.lowered.switching import has_bounds
from desire_tui.engine.passes.copies import Copies
from desire_tui.engine.passes.dependence import Dependence, Dependences
from desire_tui.engine.passes.slices import derivative_slice

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment

TableJumps = tuple[tuple[int, tuple[int, ...]], ...]
"""For tables (their slots) the slots of breakpoints where they jump."""
_JUMPS_MOST = 16
"""A staircase of more is left to error control: each jump is a choice in each evaluation."""
_ULP, _LEAST = Const(2.3e-16), Const(1e-300)


def table_jumps(segment: Segment, data: NDArray[np.float64]) -> TableJumps:
    """Return where a segment's tables jump, as they are now; `data`: all values."""
    found: dict[int, tuple[int, ...]] = {}
    for points in segment.breakpoints:
        places = data[points.slot : points.slot + points.count]
        equal = places[1:] == places[:-1]
        if not equal.any() or equal.all():  # all: nobody has filled it
            continue
        first = np.flatnonzero(equal & np.concatenate([[True], ~equal[:-1]]))
        if len(first) <= _JUMPS_MOST:
            found[points.slot] = tuple(int(points.slot + place) for place in first)
    return tuple(sorted(found.items()))


def with_table_jumps(segment: Segment, jumps: TableJumps) -> Segment:
    """Return the segment with these jumps as switches where states look tables up."""
    return replace(segment, body=_Located(segment, dict(jumps)).of(segment.body))


class _Located(Copies):
    def __init__(self, segment: Segment, jumps: dict[int, tuple[int, ...]]) -> None:
        super().__init__()
        self._jumps = jumps
        self._dependences = Dependences(derivative_slice(segment), segment.states, has_bounds)

    def made(self, part: Any, copy: Any) -> Any:
        """Let a table be looked up on one side of each of its jumps."""
        if not isinstance(copy, Table1) or copy.slot not in self._jumps:
            return copy
        if self._dependences.of(part.x) is not Dependence.STATES:
            return copy
        x: Value = copy.x
        for slot in self._jumps[copy.slot]:
            x = _beside(x, copy.x, Load(slot))
        return Table1(x, copy.slot, copy.count)


def _beside(x: Value, where: Value, jump: Value) -> Value:
    """Return x, but for a jump no nearer than the next number on the side that `where` is on."""
    gap = Op("add", (Op("mul", (Op("abs", (jump,)), _ULP)), _LEAST))
    below = Op("min", (x, Op("sub", (jump, gap))))
    above = Op("max", (x, Op("add", (jump, gap))))
    return Op("comp", (Op("sub", (where, jump)), below, above))
