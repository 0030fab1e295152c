"""What has no Taylor series, in segments that are run under rule 17."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import rule_numbered
from desire_tui.engine.lowering.scope import UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Quantity

STATES_MOST = 5_000
"""Of larger segments a run tells: an editor asks at every key."""
_FIRST_SLOT = 1 << 48
"""Behind all that the check has given slots to."""


def without_series(
    segment: Segment, rule: int | None, quantities: Iterable[Quantity]
) -> tuple[Diagnostic, ...]:
    """Return error 540 where a segment has no series under the rule that its text tells.

    None where the size of an array is not known.
    """
    if rule is None or rule_numbered(rule).solver != "Taylor" or not 0 < segment.order <= STATES_MOST:
        return ()
    if any(UNKNOWN in quantity.shape for quantity in quantities):
        return ()
    from desire_tui.engine.passes.assigned_states import without_assigned_states
    from desire_tui.engine.passes.series.expanded import expanded

    free = _FIRST_SLOT

    def allocate(count: int) -> int:
        nonlocal free
        free += count
        return free - count

    try:
        expanded(without_assigned_states(segment, allocate)[0], allocate)
    except DesireError as refusal:
        return refusal.diagnostics
    return ()
