"""Where states stand among the values: scalars of neighbouring slots are one range."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.segment import StateRange

Range = tuple[int, int, int]
"""Consecutive states: the slot of the first, its number, how many."""


def state_ranges(states: Iterable[StateRange]) -> list[Range]:
    """Return the states' ranges in their order, neighbours joined."""
    found: list[Range] = []
    for each in states:
        if found and found[-1][0] + found[-1][2] == each.slot:
            found[-1] = (found[-1][0], found[-1][1], found[-1][2] + each.count)
        else:
            found.append((each.slot, each.first, each.count))
    return found
