"""The array of a JACOBIAN segment: n by n, known when a run starts; the run fills it (language.md 9.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Sequence

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


def fill_array(values: Values, slot: int, order: int, smaller: int, numbers: Sequence[int]) -> None:
    """Put a Jacobian of fewer states where the script looks for it, rows and columns of the others 0.

    `smaller`: its slot; `numbers`: what the numbers of its states are among all `order` states.
    """
    left = len(numbers)
    if left == order:
        return
    whole = values.data[slot : slot + order**2].reshape(order, order)
    whole[:] = 0.0
    rows = list(numbers)
    for row, number in enumerate(rows):
        whole[number, rows] = values.data[smaller + row * left : smaller + (row + 1) * left]
