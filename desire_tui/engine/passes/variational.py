"""The variational equations: a segment that integrates, beside its states, their derivatives by parameters.

For each direction (a parameter, or the start of a state) every number that depends on it gets a tangent,
states included, so that the tangents of states are further states: d/dt S = (∂f/∂x)·S + ∂f/∂p (Hairer,
Nørsett and Wanner, "Solving Ordinary Differential Equations I", I.14). The result is a segment like any
other: every rule integrates it, and under fixed steps S is the exact derivative of what the rule computes.
What happens at moments that depend on parameters themselves is the matter of `moment_tangents` and
`located_jumps`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.lowered.segment import SampleColumn, StateRange
from desire_tui.engine.passes.delay_tangents import DelayTangents
from desire_tui.engine.passes.differentiate import Differentiator, with_tangents
from desire_tui.engine.passes.located_jumps import located_jumps
from desire_tui.engine.passes.moment_tangents import MomentTangents
from desire_tui.engine.passes.tangents import Tangents
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

_CHUNK = 256
"""Numbers for which room is asked at a time."""


@dataclass(frozen=True)
class Variational:
    """A segment with the variational equations.

    `tangents` has a list for each direction: what has a tangent (first slot, first slot of the tangents, how
    many). They and the numbers of `memory` (slot, value) have to be set before each run. The segment samples
    what was asked for, and behind it tangents; `columns` has a list for each direction: where among the
    columns the tangent of each output stands, None for one that is always 0.
    """

    segment: Segment
    tangents: tuple[tuple[tuple[int, int, int], ...], ...]
    memory: tuple[tuple[int, float], ...]
    columns: tuple[tuple[int | None, ...], ...]


def variational(
    segment: Segment,
    directions: Sequence[tuple[str, Iterable[int]]],
    outputs: Sequence[SampleColumn],
    room: Callable[[int], int],
) -> Variational:
    """Return a segment with the variational equations of some directions; it samples `outputs`.

    A direction is its name and the slots that may have a derivative when the run begins. `room(count)` gives
    the first of `count` new slots. NotDifferentiable: the segment draws random numbers where it matters,
    learns, or jumps at each element of an array.
    """
    allocate = _Packed(room)
    seeds = [[(slot, 1) for slot in slots] for _, slots in directions]
    segment = located_jumps(segment, [_tangents(segment, own, allocate) for own in seeds], allocate)
    order = segment.order
    made = [_tangents(segment, own, allocate) for own in seeds]
    delays = DelayTangents(segment)
    differentiators = [Differentiator(t, (k + 1) * order, delays.tangent) for k, t in enumerate(made)]
    moments = MomentTangents(segment, made, differentiators, allocate)
    states = [
        StateRange(f"∂{s.name}/∂{name}", _known(t, s.slot), (k + 1) * order + s.first, s.count, s.where)
        for k, ((name, _), t) in enumerate(zip(directions, made, strict=True))
        for s in segment.states
    ]
    columns = list(outputs)
    places = []
    for (name, _), t in zip(directions, made, strict=True):
        slots = [t.slot(column.slot) for column in outputs]
        numbers = iter(range(len(columns), len(columns) + len(slots)))
        places.append(tuple(None if slot is None else next(numbers) for slot in slots))
        columns += [
            SampleColumn(f"∂{column.name}/∂{name}", slot, column.where)
            for column, slot in zip(outputs, slots, strict=True)
            if slot is not None
        ]
    whole = replace(
        segment,
        body=with_tangents(differentiators, segment.body),
        events=tuple(moments.event(event) for event in segment.events),
        states=(*segment.states, *states),
        requests=(), pictures=(), jacobian=None, stash=tuple(columns),
    )  # fmt: skip
    whole = replace(whole, delays=(*segment.delays, *delays.made))
    return Variational(whole, tuple(tuple(t.pieces()) for t in made), moments.memory, tuple(places))


def _tangents(segment: Segment, seeds: Iterable[tuple[int, int]], allocate: Callable[[int], int]) -> Tangents:
    """Give tangents to what depends on some numbers; to t too where moments depend on them."""
    actions: list[Action] = list(segment.body)
    for event in segment.events:
        actions += event.body
    given = [*seeds, (T, 1)] if segment.events else seeds
    return Tangents(segment.states, actions, allocate, given, in_place=True)


def _known(tangents: Tangents, slot: int) -> int:
    found = tangents.slot(slot)
    assert found is not None, "all states have tangents"
    return found


class _Packed:
    """Gives out slots side by side, so that tangents of neighbours are neighbours."""

    def __init__(self, room: Callable[[int], int]) -> None:
        self._room = room
        self._next, self._left = 0, 0

    def __call__(self, count: int) -> int:
        if count > self._left:
            size = max(count, _CHUNK)
            self._next, self._left = self._room(size), size
        slot = self._next
        self._next, self._left = slot + count, self._left - count
        return slot
