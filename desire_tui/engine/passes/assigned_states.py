"""States that a segment assigns in every pass (boundary values: `u[n] = 25`) taken out of the integration.

Such a state has no derivative of its own. A solver that took it for a state would find it changed after each
of its steps, and begin anew. Without it the number is a defined variable like any other: every pass computes
it from t, parameters and states before it is read.
"""

from __future__ import annotations

from copy import copy
from itertools import groupby
from typing import TYPE_CHECKING, get_args

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.effects import count_draws, expressions, reads, writes
from desire_tui.engine.lowered.expressions import Load, Vec
from desire_tui.engine.lowered.segment import JacobianEntry, StateRange
from desire_tui.engine.lowered.statements import Assignment, Deriv, DerivVec, SetMat, SetVec
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.passes.slot_set import SlotSet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.lowered.segment import Jacobian, Segment
    from desire_tui.engine.lowered.statements import Action

_ASSIGNMENTS = frozenset(get_args(Assignment))


def stepped_segment(
    segment: Segment, allocate: Callable[[int], int], *, variable: bool
) -> tuple[Segment, Sequence[int]]:
    """Return what an explicit rule integrates, and the numbers that its states have in the whole segment.

    `variable`: the rule controls its steps: an assigned state would have a test difference there. Fixed steps
    may move it with the others: it is assigned again before anything reads it, unless a line further up does.
    """
    if variable or any(early for _, early in _assignments(segment)):
        return without_assigned_states(segment, allocate)
    return segment, range(segment.order)


def checked_state(checked: int, numbers: Sequence[int]) -> int:
    """Return CHECKN as a number among the states that are left; behind all of them for one that is not."""
    if not checked:
        return 0
    return numbers.index(checked - 1) + 1 if checked - 1 in numbers else len(numbers) + 1


def without_assigned_states(
    segment: Segment, allocate: Callable[[int], int]
) -> tuple[Segment, Sequence[int]]:
    """Return the segment with fewer states, and the numbers that those left had.

    `allocate(count)` gives the first of `count` slots. A segment without such states, or of nothing else,
    comes back as it is. States that a difference equation moves (`x = 0.5*x`), or that are assigned only at
    some passes, stay.
    """
    everything = range(segment.order)
    found = _assignments(segment)
    slots = SlotSet()
    for made, _ in found:
        for slot, count in writes(made):
            slots.add(slot, count)
    kept = [
        (states, at)
        for states in segment.states
        for at in range(states.count)
        if not slots.overlaps(states.slot + at, 1)
    ]
    if not kept or len(kept) == segment.order:
        return segment, everything
    numbers = {states.first + at: new for new, (states, at) in enumerate(kept)}
    assigned = {id(made): is_early for made, is_early in found}
    body: list[Action] = [_definition(made) for made, is_early in found if is_early]
    for action in segment.body:
        if id(action) in assigned:
            if not assigned[id(action)]:
                body.append(_definition(action))
        elif isinstance(action, Deriv | DerivVec):
            body.extend(_derivatives(action, numbers, allocate))
        else:
            body.append(action)
    jacobian = segment.jacobian and _jacobian(segment.jacobian, numbers, allocate)
    smaller = replace(segment, body=tuple(body), states=tuple(_ranges(kept)), jacobian=jacobian)
    return smaller, list(numbers)


def _assignments(segment: Segment) -> list[tuple[Assignment, bool]]:
    """Return the assignments that every pass makes to states, each with whether it has to be made earlier."""
    if _ASSIGNMENTS.isdisjoint({type(action) for action in segment.body}):
        return []
    states = SlotSet()
    for given in segment.states:
        states.add(given.slot, given.count)
    written: tuple[SlotSet, SlotSet] | None = None
    before, seen = SlotSet(), 0
    found: list[tuple[Assignment, bool]] = []
    moved = SlotSet()  # what is assigned earlier, in this order: later ones may read it there
    for place, action in enumerate(segment.body):
        if not isinstance(action, Assignment) or not any(states.overlaps(*piece) for piece in writes(action)):
            continue
        if (isinstance(action, SetVec) and action.mode == "add") or isinstance(action, SetMat):
            continue
        own = SlotSet()
        for slot, count in writes(action):
            own.add(slot, count)
        if count_draws(*expressions(action)) or any(own.overlaps(*piece) for piece in reads(action)):
            continue
        written = written or _written(segment)
        anywhere, repeatedly = written
        if any(repeatedly.overlaps(*piece) for piece in writes(action)):
            continue
        for reader in walk_actions(segment.body[seen:place]):
            for slot, count in reads(reader):
                before.add(slot, count)
        seen = place
        early = any(before.overlaps(*piece) for piece in writes(action))
        if early and not all(_is_known(piece, anywhere, moved) for piece in reads(action)):
            continue
        found.append((action, early))
        if early:
            for slot, count in writes(action):
                moved.add(slot, count)
    return found


def _is_known(piece: tuple[int, int], written: SlotSet, moved: SlotSet) -> bool:
    """Whether numbers that are read are known in front of the segment's first statement."""
    slot, count = piece
    if not written.overlaps(slot, count):
        return True
    return all(moved.overlaps(at, 1) or not written.overlaps(at, 1) for at in range(slot, slot + count))


def _written(segment: Segment) -> tuple[SlotSet, SlotSet]:
    """Return what is written, and what is written by more than one statement.

    Of two statements that overlap the later one stands in the second set as a whole: either overlaps it.
    """
    anywhere, repeatedly = SlotSet(), SlotSet()
    for action in walk_actions(segment.body):
        pieces = [*writes(action)]
        for slot, count in pieces:
            if anywhere.overlaps(slot, count):
                repeatedly.add(slot, count)
        for slot, count in pieces:
            anywhere.add(slot, count)
    return anywhere, repeatedly


def _definition(action: Action) -> Action:
    """Return an assignment that need not be made in passes which do not use it."""
    assert isinstance(action, Assignment)
    made = copy(action)
    made.persistent = False  # type: ignore[misc]  # nodes are frozen for the type checker only
    return made


def _derivatives(
    action: Deriv | DerivVec, numbers: dict[int, int], allocate: Callable[[int], int]
) -> Iterable[Action]:
    """Give the states that are left their derivatives; a vector's are computed whole, then copied."""
    if isinstance(action, Deriv):
        if action.state in numbers:
            yield Deriv(numbers[action.state], action.value, action.where)
        return
    left = [i for i in range(action.count) if action.state + i in numbers]
    if len(left) == action.count:
        yield DerivVec(numbers[action.state], action.count, action.value, action.where)
        return
    if not left:
        return
    whole = action.value
    if not isinstance(whole, Vec):
        whole = Vec(allocate(action.count), action.count)
        yield SetVec(whole.slot, action.count, action.value, action.where)
    for first, last in _stretches(left):
        number, count = numbers[action.state + first], last - first
        if count == 1:
            yield Deriv(number, Load(whole.slot + first), action.where)
        else:
            yield DerivVec(number, count, Vec(whole.slot + first, count), action.where)


def _stretches(numbers: Sequence[int]) -> Iterable[tuple[int, int]]:
    """Yield consecutive numbers as first and behind the last."""
    first = numbers[0]
    for one, following in zip(numbers, [*numbers[1:], None], strict=True):
        if following != one + 1:
            yield first, one + 1
            first = following or 0


def _ranges(kept: Sequence[tuple[StateRange, int]]) -> Iterable[StateRange]:
    number = 0
    for _, group in groupby(kept, key=lambda pair: pair[0].first):
        some = list(group)
        whole = some[0][0]
        for first, last in _stretches([at for _, at in some]):
            yield StateRange(whole.name, whole.slot + first, number, last - first, whole.where)
            number += last - first


def _jacobian(given: Jacobian, numbers: dict[int, int], allocate: Callable[[int], int]) -> Jacobian:
    """Return the lines for the states that are left, in a matrix of their own."""
    entries = tuple(
        JacobianEntry(numbers[entry.row], numbers[entry.column], entry.value, entry.where)
        for entry in given.entries
        if entry.row in numbers and entry.column in numbers
    )
    return type(given)(allocate(len(numbers) ** 2), given.body, entries)
