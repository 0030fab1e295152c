"""What is stored of a lowered segment: states, columns, what lowering read of the names and did to them."""

from __future__ import annotations

from array import array
from itertools import repeat
from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.digest import blake2b
from desire_tui.engine.lowered.deferred_segment import DEFERRED
from desire_tui.engine.lowered.segment import SampleColumn, SampleRequest, Segment, StateRange
from desire_tui.engine.lowered.statements import Where
from desire_tui.engine.quick_tuples import tuples
from desire_tui.engine.source import Span
from desire_tui.engine.values import Kind, Layout

if TYPE_CHECKING:
    from desire_tui.engine.source import Source

Place = tuple[int, int]
"""From … to in the text."""
Request = tuple[
    Literal["dispt", "dispxy", "DISPXY", "type"], tuple[tuple[str, int, Place], ...], int | None, Place
]
"""A `SampleRequest`, its columns' names, slots and places."""


class SegmentFacts(NamedTuple):
    """Plain data."""

    label: str | None
    rule: int | None
    before: bytes
    """The digest of the layout in which the segment was lowered."""
    constants: tuple[tuple[int, float], ...]
    """Numbers that were lowered in, by slot."""
    states: tuple[tuple[str, ...], tuple[int, ...], tuple[int, ...], tuple[int, ...]]
    """Names, slots, first and last offsets of their places."""
    requests: tuple[Request, ...]
    scalars: tuple[int, ...]
    changed: tuple[tuple[str, int, bool], ...]
    """Scalars that lowering made, or made states: name, slot, whether it is a state."""
    scalars_used: int
    """Slots of scalars that are taken afterwards."""


def segment_facts(segment: Segment, rule: int | None, before: Layout, after: Layout) -> SegmentFacts | None:
    """Return what restores a segment but for its statements; None: nothing does so exactly."""
    known = {quantity[0]: quantity for quantity in before.quantities}
    changed = tuple((q[0], q[1], q[4]) for q in after.quantities if known.get(q[0]) != q)
    states = segment.states
    facts = SegmentFacts(
        segment.label, rule, layout_digest(before), segment.constants,
        (
            tuple(state.name for state in states), tuple(state.slot for state in states),
            tuple(state.where.span[0] for state in states), tuple(state.where.span[1] for state in states),
        ),
        tuple(_request(request) for request in segment.requests if request.where is not None),
        segment.scalars, changed, after.scalars,
    )  # fmt: skip
    again = restored_segment(facts, segment.source)
    fields = [field for field in segment.__match_args__ if field not in DEFERRED]
    is_same = all(getattr(again, field) == getattr(segment, field) for field in fields)
    return facts if is_same and layout_after(facts, before) == after else None


def restored_segment(facts: SegmentFacts, source: Source) -> Segment:
    """Return a segment without its statements."""
    names, slots, starts, ends = facts.states
    places = tuples(Where, tuples(Span, starts, ends), repeat(None))
    return Segment(
        label=facts.label, source=source, body=(),
        states=tuple(map(StateRange, names, slots, range(len(names)), repeat(1), places)),
        requests=tuple(map(_restored_request, facts.requests)),
        scalars=facts.scalars, constants=facts.constants,
    )  # fmt: skip


def layout_digest(layout: Layout) -> bytes:
    """Return a digest of all that lowering can read of names: their places and shapes, what is defined."""
    names, slots, shapes, kinds, states, of_files = zip(*layout.quantities, strict=True)
    real = Kind.REAL
    others = [(n, s, k.name) for n, s, k in zip(names, shapes, kinds, strict=True) if s or k is not real]
    digest = blake2b(repr((len(names), layout.scalars, layout.arrays, others)).encode(), digest_size=16)
    for part in (
        "\n".join(names).encode(),
        array("q", slots),
        bytes(states),
        bytes(of_files),
        layout.defined,
    ):
        digest.update(part)
    return digest.digest()


def layout_after(facts: SegmentFacts, before: Layout) -> Layout:
    """Return the layout that lowering leaves behind."""
    names = {quantity[0]: quantity for quantity in before.quantities}
    names |= {name: (name, slot, (), Kind.REAL, is_state, False) for name, slot, is_state in facts.changed}
    defined = before.defined + bytes(facts.scalars_used - before.scalars)
    return Layout(tuple(names.values()), facts.scalars_used, before.arrays, defined)


def _request(request: SampleRequest) -> Request:
    assert request.where is not None
    columns = tuple((column.name, column.slot, _place(column.where)) for column in request.columns)
    return request.kind, columns, request.channel, _place(request.where)


def _restored_request(request: Request) -> SampleRequest:
    kind, columns, channel, place = request
    sampled = tuple(SampleColumn(name, slot, _where(at)) for name, slot, at in columns)
    return SampleRequest(kind, sampled, channel, _where(place))


def _place(where: Where) -> Place:
    return where.span.start, where.span.end


def _where(place: Place) -> Where:
    return Where(Span(*place))
