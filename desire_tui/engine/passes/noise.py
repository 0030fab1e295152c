"""Random numbers that derivatives read afresh at each stage of a step."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws, expressions, reads, timing, writes
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, Where


def noisy_derivative(segment: Segment) -> Where | None:
    """Return the place of a random number on which a derivative depends within a step; None: there is none.

    What is drawn behind `step`, OUT, SAMPLE, `event` or `every` stands still while a step is made.
    """
    if not any(count_draws(*expressions(action)) for action in walk_actions(segment.body)):
        return None
    noisy = SlotSet()
    found: Where | None = None
    for _ in range(2):  # a line may read what one below it has set in the pass before
        for action in _in_each_pass(segment.body):
            drawn = bool(count_draws(*expressions(action)))
            if drawn or any(noisy.overlaps(*piece) for piece in reads(action)):
                if drawn and found is None:
                    found = action.where
                if isinstance(action, Deriv | DerivVec):
                    return found
                for slot, count in writes(action):
                    noisy.add(slot, count)
    return None


def _in_each_pass(actions: Iterable[Action]) -> Iterator[Action]:
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "if":
                yield action
                yield from _in_each_pass(action.body)
                yield from _in_each_pass(action.orelse)
        elif timing(action) == "always":
            yield action
