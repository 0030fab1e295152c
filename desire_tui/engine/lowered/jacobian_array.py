"""Whether the array of a JACOBIAN segment is n by n; known when a run starts (language.md 9.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.values import Values


def checked_array(segment: Segment, values: Values) -> int:
    """Return the slot of a JACOBIAN segment's array. DesireError 230: it is not n by n."""
    given, order = segment.jacobian, segment.order
    assert given is not None
    for quantity in values:
        if quantity.slot == given.slot and len(quantity.shape) == 2 and quantity.shape != (order, order):
            shape = " by ".join(map(str, quantity.shape))
            facts = {"name": quantity.name, "n": order, "shape": shape}
            raise DesireError(Diagnostic("jacobian-shape", None, facts, segment.source))
    return given.slot
