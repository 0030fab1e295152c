"""How small models see, with numbers in registers, whether a mode may have switched in a step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.passes.watch_passes import conditional, has_margin, is_bounded

if TYPE_CHECKING:
    from desire_tui.engine.lowered.switching import Mode, ModeSlots, Switching

Glance = Literal["sides", "differs", "margin"]
"""An argument and its mode are on two sides of 0; a number is not that of the mode; a margin is below 0."""
_Rows = list[tuple[Glance, int]]


class Looks(NamedTuple):
    """What is compared behind the passes `watch_stage` and `watch_end`: (how, slot, slot of the frozen mode).

    `scratch`: slots that nobody else wants to know; to keep them up to date in memory would cost much.
    `sides`: slots of t and states that have not left a box in which no mode switches as long as they are
    between bounds in memory (`integration.switching.clearance`); none: there is no such box.
    """

    at: dict[str, list[tuple[Glance, int, int]]]
    scratch: frozenset[int] = frozenset()
    sides: tuple[int, ...] = ()


def no_looks() -> Looks:
    """Return what a model without modes has."""
    return Looks({"watch_stage": [], "watch_end": []})


def looks(switching: Switching) -> Looks:
    """Return what a small model's loop compares."""
    slots, at = switching.slots, no_looks().at
    scratch: set[int] = set()
    unsure = conditional(switching.live_pass, switching.modes, slots)
    for mode in switching.modes:
        frozen = slots.frozen + mode.first
        for kind, rows in zip(at, _rows(mode, slots, always=mode not in unsure), strict=True):
            at[kind] += [(how, row + mode.first, frozen) for how, row in rows]
        unwanted = [slots.live, slots.stage, slots.first, slots.second]
        if is_bounded(mode):
            unwanted.append(slots.arguments)
        scratch |= {row + mode.first for row in unwanted}
    return Looks(at, frozenset(scratch), switching.moving)


def _rows(mode: Mode, slots: ModeSlots, *, always: bool) -> tuple[_Rows, _Rows]:
    """Return what to compare at the stage and at the end; `always`: no condition is above the mode."""
    if not is_bounded(mode):
        first: tuple[Glance, int] = ("differs", slots.first)
        if has_margin(mode) and always:
            first = ("margin", slots.stage)
        return [], [first, ("differs", slots.second)]
    if mode.operation == "swtch" and always:
        return [("sides", slots.arguments)], [("sides", slots.arguments)]
    return [("differs", slots.first)], [("differs", slots.second)]
