"""A segment made ready for rule 17; where a statement has no Taylor series, the message names it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.passes.series.graph import NoSeriesError
from desire_tui.engine.passes.series.pieces import with_pieces
from desire_tui.engine.passes.series.translation import series_program
from desire_tui.engine.passes.switching import switching

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.switching import Switching
    from desire_tui.engine.passes.series.nodes import SeriesProgram

_WITHOUT: dict[str, tuple[str, str]] = {
    "noise": ("a random number", "rule 2"),
    "remembers": ("a variable that is read before it is set", "rules 1 to 5, or put the line behind `step`"),
    "in-place": ("an array that is computed from its own new elements", "rule 9"),
    "array": ("this operation on arrays", "rule 9"),
    "matrix": ("a matrix that changes in a step", "rule 9"),
    "delay": ("a delay", "rule 4"),
    "table": ("this table", "rule 9"),
    "function": ("`{name}`", "rule 9"),
}
"""What has no Taylor series, and what to use in place of rule 17, by `NoSeriesError.what`."""


def expanded(
    segment: Segment, allocate: Callable[[int], int]
) -> tuple[Segment, Switching | None, SeriesProgram]:
    """Return the segment between switchings, what switches, and the series. DesireError 540: one has none.

    `allocate(count)` gives the first of `count` slots.
    """
    pieces = with_pieces(segment)
    smooth, switches = switching(pieces, allocate)
    try:
        return smooth, switches, series_program(smooth, switches, allocate)
    except NoSeriesError as refusal:
        what, _, name = refusal.what.partition(":")
        noun, instead = _WITHOUT[what]
        facts: dict[str, object] = {"what": noun.format(name=name), "instead": instead}
        raise DesireError(at_statement("no-series", facts, segment, refusal.where)) from None
