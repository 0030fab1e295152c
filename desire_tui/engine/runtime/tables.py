"""Tables of a segment's table functions are looked at before each run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.breakpoints import falling_facts
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values


def check_tables(segment: Segment, values: Values) -> None:
    """DesireError 44: the breakpoints of a table fall, which the search for a place in it cannot bear."""
    for points in segment.breakpoints:
        facts = falling_facts(points.name, values.data[points.slot : points.slot + points.count])
        if facts is not None:
            raise DesireError(Diagnostic("table-falling", points.where.span, facts, segment.source))
