"""The last sample after `term` fired between communication points (language.md 8.2).

The STEP pass has just been made with the same t and states. So only what it left out is caught up: pure
defined variables are computed, OUT code runs; unguarded persistent assignments, random draws, derivatives,
`sample` and `step` code are not repeated (but OUT code behind `step` runs).

A defined variable that uses what a later line of the same pass remembers anew (a relay, a counter) would come
out one pass too late: it is `early`, belongs to the STEP pass and is not computed again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import reads, writes
from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    GetHistory,
    Guard,
    Set,
    SetDot,
    SetMat,
    SetVec,
    StoreHistory,
    Terminate,
)
from desire_tui.engine.passes.dead_code import SlotSet, draws, with_bodies

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.statements import Action

Actions = tuple["Action", ...]


def holds_term(actions: Iterable[Action]) -> bool:
    """Whether a run of these statements may end by `term`."""
    return any(
        isinstance(a, Terminate) or (isinstance(a, Guard) and (holds_term(a.body) or holds_term(a.orelse)))
        for a in actions
    )


def computes(action: Action) -> bool:
    """Whether a statement only computes a defined variable from others."""
    return isinstance(action, Set | SetVec | SetMat | SetDot) and not action.persistent and not draws(action)


def early(step_pass: Actions) -> frozenset[int]:
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
                found.update(map(id, _leaves(action)))
        elif computes(action):
            if _reads_any(action, changed):
                found.add(id(action))
        else:
            for slot, count in writes(action):
                changed.add(slot, count)


def _reads_any(action: Action, changed: SlotSet) -> bool:
    return any(changed.touch(slot, count) for slot, count in reads(action))


def _leaves(guard: Guard) -> Iterable[Action]:
    for action in (*guard.body, *guard.orelse):
        if isinstance(action, Guard):
            yield from _leaves(action)
        else:
            yield action


def tail(actions: Iterable[Action], known: frozenset[int]) -> Actions:
    """Return what the STEP pass left out of a segment's body; `known` is what it computed for the sample."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "out":
                kept.extend(_at_point(action.body))
            elif action.kind == "step":  # OUT may stand behind it
                kept.extend(tail(action.body, known))
            elif action.kind == "if":
                body, orelse = tail(action.body, known), tail(action.orelse, known)
                if body or orelse:
                    kept.append(with_bodies(action, body, orelse))
        elif isinstance(action, StoreHistory | GetHistory):
            kept.append(action)
        elif isinstance(action, DelayLine):
            if not action.per_step:
                kept.append(action)
        elif computes(action) and id(action) not in known:
            kept.append(action)
    return tuple(kept)


def _at_point(actions: Iterable[Action]) -> Actions:
    """Return what OUT code does where no step begins."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            if action.kind == "out":
                kept.extend(_at_point(action.body))
            elif action.kind == "if":
                body, orelse = _at_point(action.body), _at_point(action.orelse)
                if body or orelse:
                    kept.append(with_bodies(action, body, orelse))
        elif isinstance(action, DelayLine):
            if not action.per_step:
                kept.append(action)
        elif not isinstance(action, Deriv | DerivVec | Terminate):
            kept.append(action)
    return tuple(kept)
