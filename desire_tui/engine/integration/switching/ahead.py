"""The next place where a switch of t switches: found by bounds over intervals, so that none is missed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.integration.halving import RESOLUTION
from desire_tui.engine.integration.switching.bounds import at, over
from desire_tui.engine.integration.switching.operations import Operation

if TYPE_CHECKING:
    from desire_tui.engine.integration.switching.memory import Watch

_PATIENCE = 64
"""So many neighbouring numbers that rounding leaves undecided are looked at before the next ones are taken
wider: an argument that only touches its threshold (`sin(t)^2`) would take millions."""
_GLANCES = 500
"""Intervals looked at beyond what is asked for."""


def begin_ahead(w: Watch, t: float) -> None:
    """Forget what was found; take the inputs as they are."""
    w.clear_to = t
    w.found = 0
    for i in range(w.input_count):
        value: float = w.values[w.inputs[i]]
        w.low[w.input_registers[i]] = value
        w.high[w.input_registers[i]] = value


def inputs_changed(w: Watch) -> int:
    """Whether numbers that are constant between events are other ones than when the search began."""
    changed = 0
    for i in range(w.input_count):
        value: float = w.values[w.inputs[i]]
        known: float = w.low[w.input_registers[i]]
        changed += value != known and value == value  # noqa: PLR0124 - nan
    return changed


def look_ahead(w: Watch, t: float, wish: float) -> None:
    """Find the first switching behind t, or clear the way up to `wish` at least."""
    left = max(t, w.clear_to)
    width = (wish - left) if wish > left else 0.0
    undecided = 0
    least = RESOLUTION * max(abs(left), abs(wish))
    wide = least
    glances = 0
    while left < wish or (left < w.t_end and glances < _GLANCES):
        if left >= wish:
            glances += 1
        right = left + width
        if not right > left:
            right = next_number(left)
            width = right - left
        right = min(right, w.t_end)
        if right <= left:
            break
        if over(w, left, right):
            left = right
            width = 2.0 * width
            undecided = 0
            wide = least
            continue
        middle = left + 0.5 * (right - left)
        if middle > left and middle < right and right - left > wide:
            width = middle - left
            continue
        if differs(w, left, right):
            refine(w, left, right)
            w.clear_to = w.next
            return
        undecided += 1
        if undecided >= _PATIENCE:
            wide = max(2.0 * wide, 2.0 * (right - left))
            width = wide
        left = right
    w.clear_to = max(left, w.clear_to)


def differs(w: Watch, left: float, right: float) -> int:
    """Whether a switch stands differently at two times; the last one in the program is the culprit."""
    at(w, left, w.before)
    at(w, right, w.behind)
    found = 0
    w.is_jump = 0
    for k in range(w.instruction_count):
        if w.before[k] != w.behind[k]:
            found = 1
            if w.instructions[4 * k] < Operation.KINK:
                w.is_jump = 1
            w.culprit = k
    return found


def refine(w: Watch, left: float, right: float) -> None:
    """Halve until the two are neighbouring numbers, or as near as these are to each other elsewhere."""
    last = left
    following = right
    least = RESOLUTION * max(abs(left), abs(right))
    while following - last > least:
        middle = last + 0.5 * (following - last)
        if not (middle > last and middle < following):
            break
        if differs(w, last, middle):
            following = middle
        else:
            last = middle
    differs(w, last, following)
    w.found = 1
    w.last = last
    w.next = following


def next_number(t: float) -> float:
    """Return the next larger number."""
    size = abs(t) * 1.1102230246251565e-16 + 5e-324
    found = t + size
    if found > t:
        return found
    return t + 2.0 * size
