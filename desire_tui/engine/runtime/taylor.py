"""A segment made ready for rule 17: where it has no Taylor series, the message says which statement has none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.passes.series.pieces import with_pieces
from desire_tui.engine.passes.series.translation import NoSeriesError, series_program
from desire_tui.engine.passes.switching import switching
from desire_tui.engine.runtime.run_faults import at_statement

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.passes.series.nodes import SeriesProgram


def expanded(
    segment: Segment, allocate: Callable[[int], int]
) -> tuple[Segment, Switching | None, SeriesProgram]:
    """Return the segment between switchings, what switches, and the series. DesireError 4xx: it has none.

    `allocate(count)` gives the first of `count` slots.
    """
    pieces = with_pieces(segment)
    smooth, switches = switching(pieces, allocate)
    try:
        return smooth, switches, series_program(smooth, switches, allocate)
    except NoSeriesError as refusal:
        what, _, name = refusal.what.partition(":")
        facts: dict[str, object] = {"what": what, "name": name}
        raise DesireError(at_statement("no-series", facts, segment, refusal.where)) from None
