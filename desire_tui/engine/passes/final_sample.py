"""The last sample after `term` fired between communication points (language.md 8.2).

The STEP pass has just been made with the same t and states. So only what it left out is caught up: pure
defined variables are computed, OUT code runs; unguarded persistent assignments, random draws, derivatives,
`sample` and `step` code are not repeated (but OUT code behind `step` runs).

A defined variable that uses what a later line of the same pass remembers anew (a relay, a counter) would come
out one pass too late: it keeps the value of the STEP pass (`kept_from_step_pass`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.lowered.effects import reads, role, timing, writes
from desire_tui.engine.lowered.statements import Guard, Terminate
from desire_tui.engine.lowered.walk import simple_actions, walk_actions, with_bodies
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.statements import Action

Actions = tuple["Action", ...]


def holds_term(actions: Iterable[Action]) -> bool:
    """Whether a run of these statements may end by `term`."""
    return any(isinstance(action, Terminate) for action in walk_actions(actions))


def kept_from_step_pass(step_pass: Actions) -> frozenset[int]:
    """Return the `id` of each statement whose variable must keep the value that the STEP pass gives it."""
    found: set[int] = set()
    if holds_term(step_pass):
        _collect(step_pass, SlotSet(), found)
    return frozenset(found)


def _collect(actions: Actions, changed: SlotSet, found: set[int]) -> None:
    """Go backward; `changed` is what statements further down remember."""
    for action in reversed(actions):
        if isinstance(action, Guard):
            _collect(action.orelse, changed, found)
            _collect(action.body, changed, found)
            if _reads_any(action, changed):
                found.update(map(id, simple_actions((action,))))
        elif role(action) == "definition":
            if _reads_any(action, changed):
                found.add(id(action))
        else:
            for slot, count in writes(action):
                changed.add(slot, count)


def _reads_any(action: Action, changed: SlotSet) -> bool:
    return any(changed.overlaps(slot, count) for slot, count in reads(action))


def catch_up(actions: Iterable[Action], computed: frozenset[int]) -> Actions:
    """Return what the STEP pass left out of a segment's body.

    `computed`: the ids of statements that it computed for the sample.
    """
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            match action.kind:
                case "out":
                    kept.extend(_at_point(action.body))
                case "step":  # OUT may stand behind it
                    kept.extend(catch_up(action.body, computed))
                case "if":
                    body, orelse = (
                        catch_up(action.body, computed),
                        catch_up(action.orelse, computed),
                    )
                    if body or orelse:
                        kept.append(with_bodies(action, body, orelse))
                case "sample":
                    pass
                case _:
                    assert_never(action.kind)
        elif timing(action) == "point" or (role(action) == "definition" and id(action) not in computed):
            kept.append(action)
    return tuple(kept)


def _at_point(actions: Iterable[Action]) -> Actions:
    """Return what OUT code does where no step begins."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            match action.kind:
                case "out":
                    kept.extend(_at_point(action.body))
                case "if":
                    body, orelse = _at_point(action.body), _at_point(action.orelse)
                    if body or orelse:
                        kept.append(with_bodies(action, body, orelse))
                case "step" | "sample":
                    pass
                case _:
                    assert_never(action.kind)
        elif timing(action) != "step" and role(action) != "derivative":
            kept.append(action)
    return tuple(kept)
