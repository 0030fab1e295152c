"""A segment's derivatives as a function of t and the states alone: what other people's solvers integrate."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.lowered.effects import count_draws, expressions, reads, writes
from desire_tui.engine.lowered.expressions import Const, Op
from desire_tui.engine.lowered.statements import Assignment, Deriv, DerivVec, EffectAction, Guard
from desire_tui.engine.lowered.walk import walk_actions, walk_values, with_bodies
from desire_tui.engine.passes.assigned_states import without_assigned_states
from desire_tui.engine.passes.slices import derivative_slice
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, Where


def state_equations(segment: Segment, allocate: Callable[[int], int]) -> Segment:
    """Return a segment whose derivative pass is such a function, with the states of the program.

    A state that every pass assigns (`u[1] = 25`) does not move: its derivative is 0.
    DesireError 491: there are no states, or derivatives depend on the past or on random numbers.
    """
    if not segment.order:
        raise DesireError(Diagnostic("equations-missing", None, {}, segment.source))
    smaller, numbers = without_assigned_states(segment, allocate)
    body = smaller.body
    if len(numbers) < segment.order:
        rest = sorted({*range(segment.order)} - {*numbers})
        where = segment.states[0].where
        body = (*_renumbered(body, numbers), *(Deriv(number, Const(0.0), where) for number in rest))
    equations = replace(segment, body=body, requests=(), pictures=(), stash=(), recover=(), events=())
    for what, where in _obstacles(derivative_slice(equations)):
        raise DesireError(Diagnostic("equations-impure", where.span, {"what": what}, segment.source))
    return equations


def _renumbered(actions: Iterable[Action], numbers: Sequence[int]) -> Iterator[Action]:
    for action in actions:
        if isinstance(action, Deriv):
            yield Deriv(numbers[action.state], action.value, action.where)
        elif isinstance(action, DerivVec):
            yield DerivVec(numbers[action.state], action.count, action.value, action.where)
        elif isinstance(action, Guard):
            body, orelse = (tuple(_renumbered(part, numbers)) for part in (action.body, action.orelse))
            yield with_bodies(action, body, orelse)
        else:
            yield action


def _obstacles(actions: Iterable[Action]) -> Iterator[tuple[str, Where]]:
    everything = list(walk_actions(actions))
    always = {id(action) for action in actions}
    before, anywhere = SlotSet(), SlotSet()
    for action in everything:
        _add(anywhere, reads(action))
    for action in everything:
        _add(before, reads(action))
        if any(isinstance(n, Op) and n.name == "delayed" for n in walk_values(*expressions(action))):
            yield "a delay", action.where
        elif isinstance(action, EffectAction):
            yield "what is remembered", action.where
        elif count_draws(*expressions(action)):
            yield "a random number", action.where
        elif isinstance(action, Assignment) and action.persistent:
            seen = before if id(action) in always else anywhere
            if any(seen.overlaps(*piece) for piece in writes(action)):
                yield "what was there before", action.where


def _add(slots: SlotSet, pieces: Iterable[tuple[int, int]]) -> None:
    for slot, count in pieces:
        slots.add(slot, count)
