"""Where a segment's derivatives switch, for rules that control their steps.

A jump whose argument depends on states becomes a *mode*: the derivative pass reads a number that stays what
it is while a step lasts (the derivatives are smooth there), and a pass of its own computes what it would be
now. A jump or kink whose argument depends on t alone is a *clock*: it stays as it is, and steps end where
it switches. `term` is a mode that only has to be located. Kinks by states are left to error control.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.effects import expressions
from desire_tui.engine.lowered.expressions import Op, Table1
from desire_tui.engine.lowered.statements import Guard, Terminate
from desire_tui.engine.lowered.switching import JUMPS, KINKS, ModeSlots, Switching
from desire_tui.engine.lowered.walk import walk_actions, walk_values
from desire_tui.engine.passes.clearance import moving_slots
from desire_tui.engine.passes.switch_finder import SwitchFinder
from desire_tui.engine.passes.switch_rewriter import SwitchRewriter
from desire_tui.engine.passes.watch_passes import end_pass, stage_pass

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.segment import Segment

_SWITCHES = JUMPS | KINKS
_COMPOSED = ("ceil", "heav", "mod")
"""Functions that `lowering.operators` makes of jumps."""
_WORDS = (*sorted(JUMPS | KINKS), *_COMPOSED, "func1", "term", "if", "<", ">", "event")
"""A program whose text holds none of these switches nowhere: long ones need not be searched further."""


def switching(segment: Segment, allocate: Callable[[int], int]) -> tuple[Segment, Switching | None]:
    """Return the segment that is integrated between switchings, and what switches; None: nothing does.

    `allocate(count)` gives the first of `count` slots.
    """
    text = segment.source.text
    if not any(word in text for word in _WORDS) or not (segment.events or _may_switch(segment)):
        return segment, None
    finder = SwitchFinder(segment)
    room = finder.room()
    if room == 0 and not finder.clocks:
        return segment, None
    slots = ModeSlots.from_slot(allocate(ModeSlots.ROWS * max(room, 1)), room)
    rewriter = SwitchRewriter(finder, slots)
    body = rewriter.body(segment.body)
    modes, live = tuple(rewriter.modes), rewriter.live_pass()
    moving = moving_slots(segment, rewriter.jumps, finder.dependences.definitions)
    return replace(segment, body=body), Switching(
        modes, slots, live, stage_pass(live, modes, slots), end_pass(live, modes, slots),
        tuple(finder.clocks), finder.dependences.definitions, tuple(rewriter.jumps) if moving else (), moving,
    )  # fmt: skip


def _may_switch(segment: Segment) -> bool:
    """Whether there is any statement or operation that can: quicker than to find what does."""
    for action in walk_actions(segment.body):
        if isinstance(action, Guard | Terminate):
            return True
        for node in walk_values(*expressions(action)):
            if isinstance(node, Table1) or (isinstance(node, Op) and node.name in _SWITCHES):
                return True
    return False
